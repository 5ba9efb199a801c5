/// \file The interface between the servo and a device. Every driver implements it.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::device {

/// One reading. A driver reports it in the device frame: right-handed, x to the right, y up, z
/// towards the person, origin in the middle of the workspace. A PlacedDevice converts it to the
/// plane frame: x and y along the texture from its top-left corner, z out of the plane towards the
/// hand. Drivers without a device frame (simulated, mouse, replay) report in the plane frame.
struct DeviceSample {
  Vec3 position_mm;
  Vec3 velocity_mm_s;
  /// Counts the device's readings; a repeated number means no newer reading.
  std::uint64_t sequence = 0;
  std::uint32_t buttons = 0;  ///< bit i is button i, set while it is down
  bool ready = true;          ///< homed and calibrated: the position is valid and force may be sent
  /// The motors' own limit reduced the newest force.
  bool limited = false;
  /// The exerted force as reported with this reading, N; nothing: not reported.
  std::optional<Vec3> delivered_n = std::nullopt;
};

/// The result of device calls inside the servo, where nothing may throw.
enum class DeviceStatus { ok, stopped, fault };

/// The cause of DeviceStatus::fault.
enum class DeviceFault {
  none,
  link_lost,     ///< unplugged, or no answer
  bad_data,      ///< its answers are invalid
  warm_motors,   ///< the vendor's library or the device reports that its motors are too warm
  limit_passed,  ///< the vendor's library stopped at a limit of force, velocity or impulse
  driver,        ///< any other failure of the vendor's library or the operating system
};

/// What a person must do before force may be sent.
enum class DeviceReadiness {
  ready,
  needs_homing,       ///< move the handle through its whole range until every axis is homed
  needs_inkwell,      ///< put the stylus into its inkwell
  needs_reset,        ///< put the arm at its reset position, then call HapticDevice::calibrate
  needs_calibration,  ///< run the vendor's own calibration
  needs_force_on,     ///< press the device's own button that switches force on
};

enum class WorkspaceShape {
  box,        ///< the box between the two corners
  ellipsoid,  ///< the ellipsoid inscribed in the box
};

/// Extent of the positions that a device can reach, in the device frame.
struct Workspace {
  Vec3 min_mm;
  Vec3 max_mm;
  WorkspaceShape shape = WorkspaceShape::box;
};

/// A lab's calibration on each axis of the device frame: true newtons per driver's newton, and true
/// millimetres per driver's millimetre. The felt force is `force` times the commanded force.
struct DeviceScale {
  Vec3 force = {1.0, 1.0, 1.0};
  Vec3 length = {1.0, 1.0, 1.0};

  friend bool operator==(const DeviceScale&, const DeviceScale&) = default;
};

/// The description of a device in a session's record.
struct DeviceInfo {
  std::string name{};        ///< driver name, for instance "simulated"
  std::string serial{};      ///< empty if the device has none
  double max_force_n = 0.0;  ///< peak
  bool simulated = false;
  double continuous_force_n = 0.0;  ///< sustainable without time limit; 0: unknown
  double max_rate_hz = 1000.0;      ///< of servo ticks; a higher rate has no benefit
  std::string model{};              ///< as reported by the device or its library; may be empty
  std::string firmware{};           ///< version, as reported; may be empty
  /// Nothing: the device uses the plane frame and reaches every plane completely.
  std::optional<Workspace> workspace = std::nullopt;
  /// The texture is shown on a screen instead of felt: not blind, so only for pilot sessions and
  /// demonstrations.
  bool visual = false;
  /// The largest wall stiffness that the device renders stably, as stated by the maker; 0: unknown.
  double max_stiffness_n_per_mm = 0.0;
  /// The largest damping that the device renders stably, N s/mm, as stated by the maker; 0:
  /// unknown.
  double max_damping_n_s_per_mm = 0.0;
  /// The maximum norm of HapticDevice::support_force_n; larger forces are reduced to it.
  double max_support_n = 0.0;
  /// Positions come from encoders on a hand-held arm, so they always change slightly while a person
  /// presses (SafetyLimits::frozen_s). False for computed or recorded motion, and for the mouse,
  /// which a hand may hold still.
  bool has_encoders = false;
  DeviceScale scale{};    ///< applied by `open_device`; not set by drivers
  std::string library{};  ///< version of the maker's library, as reported; may be empty
};

/// A force-feedback device. The constructor opens it and throws DeviceError on failure; the
/// destructor sends zero force and closes it.
///
/// `read` and `write` belong to the servo thread and never block, allocate, lock, log or do I/O: a
/// driver with a link runs it on a separate thread and exchanges data with the servo through a
/// DeviceLink. All other functions may be called from any thread.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  [[nodiscard]] virtual DeviceInfo info() const = 0;

  /// Reads the newest state.
  /// \return stopped when the hand is done, fault when the device is lost
  [[nodiscard]] virtual DeviceStatus read(DeviceSample& sample) noexcept = 0;

  /// Sets the force on the hand for this tick.
  /// \param force_n  N, checked and limited by the servo
  [[nodiscard]] virtual DeviceStatus write(Vec3 force_n) noexcept = 0;

  /// The force that compensates the weight of handle and arm, N, in the frame of the samples. The
  /// servo calls it after `read`, on its thread; the safety chain limits it to
  /// DeviceInfo::max_support_n and adds it to the rendered force. A driver must not add force to
  /// the argument of `write`. If a maker's library adds it, the driver checks that weight before
  /// force is switched on, and `halt` and `fault` switch the motors off.
  [[nodiscard]] virtual Vec3 support_force_n(const DeviceSample& /*sample*/) noexcept { return {}; }

  /// Sets zero force at once and until `rearm`, regardless of `write`, and without the support that
  /// a maker's library adds. Safe in a signal handler.
  virtual void halt() noexcept = 0;
  /// Enables forces again after `halt`; a person must decide this.
  virtual void rearm() noexcept = 0;

  [[nodiscard]] virtual DeviceFault fault() const noexcept { return DeviceFault::none; }
  [[nodiscard]] virtual DeviceReadiness readiness() const noexcept {
    return DeviceReadiness::ready;
  }
  /// A person confirms that the arm is at its reset position (DeviceReadiness::needs_reset): its
  /// current position becomes the reference. No effect in any other state.
  virtual void calibrate() noexcept {}
};

}  // namespace touchtrial::device
