/// \file What the servo knows of a device. Every driver implements this.
#pragma once

#include "core/vec.hpp"

#include <chrono>
#include <string>

namespace touchtrial {

/// One reading, in the plane frame: x and y along the texture from its top-left corner, z out of
/// the plane towards the hand.
struct DeviceSample {
  Vec3 position_mm;
  Vec3 velocity_mm_s;
};

/// The outcome of talking to a device inside the servo, where nothing may throw.
enum class DeviceStatus { ok, stopped, fault };

/// What a session records of its device.
struct DeviceInfo {
  std::string name;    ///< driver name, for instance "simulated"
  std::string serial;  ///< empty if the device has none
  double max_force_n = 0.0;
  bool simulated = false;
};

/// A force-feedback device. `read` and `write` belong to the servo thread alone; `info` may be
/// called from any thread.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  [[nodiscard]] virtual DeviceInfo info() const = 0;

  /// The state at this tick. \return stopped when the hand is done, fault when the link is lost
  [[nodiscard]] virtual DeviceStatus read(DeviceSample& sample) noexcept = 0;

  /// The force on the hand for this tick, N; the servo has checked and limited it.
  [[nodiscard]] virtual DeviceStatus write(Vec3 force_n) noexcept = 0;
};

}  // namespace touchtrial
