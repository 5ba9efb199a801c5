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
  double flight_s = 3.0;  ///< that the flight record holds, > 0
  /// As the watchdog sees it; must outlive the explorer.
  device::WatchdogTime* watchdog_time = &device::system_watchdog_time();
  /// The clock of each exploration; empty: a PacedClock. Tests own time.
  std::function<std::unique_ptr<device::ServoClock>()> clock{};
};

/// Runs the servo on a thread of its own that asked for real-time scheduling once. Samples go
/// through a ring to a TraceWriter; the session's thread looks after the participant; a watchdog
/// looks after the servo, and signals and crashes halt the device (StopOnSignals). An
/// exploration that is interrupted leaves the device halted, so that only a person's decision
/// (HapticDevice::rearm) lets force pass again. All functions belong to the session's thread, but
/// for what `control` gives.
class RealTimeExplorer final : public Explorer {
 public:
  explicit RealTimeExplorer(const RealTimeOptions& options = {});
  ~RealTimeExplorer() override;

  [[nodiscard]] bool in_real_time() const noexcept override { return true; }
  /// Also throws what `participant.exploring` throws: the force is zero by then.
  [[nodiscard]] Exploration explore(const engine::RenderingModel& model, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    store::Trace& trace) override;

  /// Of the servo's thread.
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept;
  /// For other threads. Requests hold for the exploration that runs; an emergency stop that comes
  /// between two holds for the next.
  [[nodiscard]] device::ServoControl& control() noexcept;

 private:
  struct Machinery;
  std::unique_ptr<Machinery> machinery_;
};

}  // namespace touchtrial::session
