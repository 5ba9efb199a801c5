/// \file Corrects a driver's newtons and millimetres by scales that a lab has measured. Source:
///   docs/devices/README.md, "Force and length".
#pragma once

#include "device/haptic_device.hpp"

#include <memory>
#include <string>
#include <utility>

namespace touchtrial::device {

/// \name The range of scales
///@{
inline constexpr double kMinScale = 0.2;
inline constexpr double kMaxScale = 5.0;
///@}

/// \return the workspace in true millimetres
/// \param length  DeviceScale::length
[[nodiscard]] Workspace scaled(const Workspace& workspace, Vec3 length) noexcept;

/// \param info  in the driver's newtons and millimetres
/// \return the same in true newtons and millimetres. Limits of force, stiffness and damping hold in
///   every direction, both in the driver's units and in true units.
[[nodiscard]] DeviceInfo scaled(DeviceInfo info, const DeviceScale& scale);

/// \return "force_scale 1, 1.02, 1 and length_scale 1, 1, 1"
[[nodiscard]] std::string scale_text(const DeviceScale& scale);

/// Corrects a driver's readings and forces, so that everything above it, including the safety
/// chain's limits, uses true newtons and millimetres. Thread rules as for HapticDevice.
class ScaledDevice final : public HapticDevice {
 public:
  /// \param scale  every number in [kMinScale, kMaxScale]
  ScaledDevice(std::unique_ptr<HapticDevice> device, const DeviceScale& scale) noexcept
      : device_(std::move(device)), scale_(scale) {}

  [[nodiscard]] DeviceInfo info() const override { return scaled(device_->info(), scale_); }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// A driver's support is a weight, so it is in true newtons already.
  [[nodiscard]] Vec3 support_force_n(const DeviceSample& sample) noexcept override;
  void halt() noexcept override { device_->halt(); }
  void rearm() noexcept override { device_->rearm(); }
  [[nodiscard]] DeviceFault fault() const noexcept override { return device_->fault(); }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override { return device_->readiness(); }
  void calibrate() noexcept override { device_->calibrate(); }

 private:
  std::unique_ptr<HapticDevice> device_;
  DeviceScale scale_;
};

}  // namespace touchtrial::device
