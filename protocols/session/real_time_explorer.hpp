/// \file Explorations in real time, on any device.
#pragma once

#include "device/platform/realtime.hpp"
#include "device/safety/watchdog.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_control.hpp"
#include "protocols/session/exploration.hpp"

#include <functional>
#include <memory>

namespace touchtrial::session {

struct RealTimeOptions {
  device::SchedulingRequest scheduling{};
  double flight_s = 3.0;  ///< length of the flight record, > 0
  /// The watchdog's time; must outlive the explorer.
  device::WatchdogTime* watchdog_time = &device::system_watchdog_time();
  /// Creates the clock of each exploration; empty: a PacedClock. For tests.
  std::function<std::unique_ptr<device::ServoClock>()> clock{};
};

/// Runs the servo on its own thread with real-time scheduling, if available. A ring passes the
/// samples to a second thread, which writes the trace. The session's thread polls the participant.
/// A watchdog monitors the servo; signals and crashes halt the device (StopOnSignals). An
/// interrupted exploration leaves the device halted, so that no force is sent before a person
/// rearms it (HapticDevice::rearm). Call all functions on the session's thread, except those of the
/// object that `control` returns.
class RealTimeExplorer final : public Explorer {
 public:
  explicit RealTimeExplorer(const RealTimeOptions& options = {});
  ~RealTimeExplorer() override;

  [[nodiscard]] bool in_real_time() const noexcept override { return true; }
  /// \throws exceptions of `participant.while_exploring`, after setting the force to zero
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    record::Trace& trace) override;

  /// The scheduling of the servo's thread.
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept;
  /// Requests from other threads. They apply to the current exploration; an emergency stop between
  /// two explorations applies to the next one.
  [[nodiscard]] device::ServoControl& control() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::session
