/// \file The virtual plane's placement in a device's workspace, and an adapter that converts a
///   device to the plane frame.
#pragma once

#include "device/haptic_device.hpp"

namespace touchtrial::device {

/// The orientation of the plane.
enum class PlaneOrientation {
  horizontal,  ///< x to the right, y towards the person, z up: a table
  vertical,    ///< x to the right, y down, z towards the person: a wall
};

/// The plane's place in the device frame.
struct PlanePlacement {
  PlaneOrientation orientation = PlaneOrientation::horizontal;
  Vec3 origin_mm;  ///< the plane's top-left corner, device frame
};

/// \name Rotate velocities and forces
///@{
[[nodiscard]] constexpr Vec3 to_plane_direction(Vec3 device,
                                                PlaneOrientation orientation) noexcept {
  if (orientation == PlaneOrientation::horizontal) return {device.x, device.z, device.y};
  return {device.x, -device.y, device.z};
}
[[nodiscard]] constexpr Vec3 to_device_direction(Vec3 plane,
                                                 PlaneOrientation orientation) noexcept {
  // Either orientation is its own inverse.
  return to_plane_direction(plane, orientation);
}
///@}

/// Adapts a device to the plane frame, which the servo uses. Lengths and magnitudes of forces are
/// unchanged. Thread rules as for HapticDevice.
class PlacedDevice final : public HapticDevice {
 public:
  /// \param device  must outlive this
  PlacedDevice(HapticDevice& device, const PlanePlacement& placement) noexcept
      : device_(device), placement_(placement) {}

  [[nodiscard]] DeviceInfo info() const override { return device_.info(); }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override {
    const DeviceStatus status = device_.read(sample);
    sample.position_mm =
        to_plane_direction(sample.position_mm - placement_.origin_mm, placement_.orientation);
    sample.velocity_mm_s = to_plane_direction(sample.velocity_mm_s, placement_.orientation);
    if (sample.delivered_n) {
      sample.delivered_n = to_plane_direction(*sample.delivered_n, placement_.orientation);
    }
    return status;
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override {
    return device_.write(to_device_direction(force_n, placement_.orientation));
  }
  [[nodiscard]] Vec3 support_force_n(const DeviceSample& sample) noexcept override {
    DeviceSample device_sample = sample;
    device_sample.position_mm =
        placement_.origin_mm + to_device_direction(sample.position_mm, placement_.orientation);
    device_sample.velocity_mm_s = to_device_direction(sample.velocity_mm_s, placement_.orientation);
    return to_plane_direction(device_.support_force_n(device_sample), placement_.orientation);
  }
  void halt() noexcept override { device_.halt(); }
  void rearm() noexcept override { device_.rearm(); }
  [[nodiscard]] DeviceFault fault() const noexcept override { return device_.fault(); }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override { return device_.readiness(); }
  void calibrate() noexcept override { device_.calibrate(); }

 private:
  HapticDevice& device_;
  PlanePlacement placement_;
};

}  // namespace touchtrial::device
