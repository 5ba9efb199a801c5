/// \file Where the virtual plane lies in a device's workspace.
#pragma once

#include "device/haptic_device.hpp"

namespace touchtrial::device {

/// How the plane stands before the person.
enum class PlaneOrientation {
  horizontal,  ///< x to the right, y towards the person, z up: a table
  vertical,    ///< x to the right, y down, z towards the person: a wall
};

/// The plane's place in the device frame.
struct PlanePlacement {
  PlaneOrientation orientation = PlaneOrientation::horizontal;
  Vec3 origin_mm;  ///< the plane's top-left corner, device frame
};

[[nodiscard]] Vec3 to_plane_position_mm(Vec3 device_mm, const PlanePlacement& placement) noexcept;
/// Velocities and forces: directions alone.
[[nodiscard]] Vec3 to_plane_direction(Vec3 device, PlaneOrientation orientation) noexcept;
[[nodiscard]] Vec3 to_device_direction(Vec3 plane, PlaneOrientation orientation) noexcept;

/// A device as the servo wants it: the same device in the plane frame. Lengths and forces keep
/// their size. Threads as HapticDevice.
class PlacedDevice final : public HapticDevice {
 public:
  /// \param device  must outlive this
  PlacedDevice(HapticDevice& device, const PlanePlacement& placement) noexcept
      : device_(device), placement_(placement) {}

  [[nodiscard]] DeviceInfo info() const override { return device_.info(); }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override { device_.halt(); }
  void rearm() noexcept override { device_.rearm(); }
  [[nodiscard]] DeviceFault fault() const noexcept override { return device_.fault(); }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override { return device_.readiness(); }

 private:
  HapticDevice& device_;
  PlanePlacement placement_;
};

}  // namespace touchtrial::device
