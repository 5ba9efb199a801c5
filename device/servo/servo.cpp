#include "device/servo/servo.hpp"

#include "core/named.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/flight_recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <type_traits>

namespace touchtrial::device {
namespace {

constexpr double kMinRateHz = 1'000.0;
constexpr double kMaxRateHz = 10'000.0;
constexpr double kComfortStopS = 0.1;  ///< from the first tick after the request
constexpr double kShareS = 0.1;        ///< for a change of the share from 0 to 1
/// Smaller forces are not compared with the device's reported force.
constexpr double kComparedN = 0.1;

double share_of(const ServoParameters& parameters) noexcept {
  return parameters.force_share >= 0.0 ? std::min(parameters.force_share, 1.0) : 0.0;
}

void check(const ServoOptions& options) {
  const bool rate_holds = options.rate_hz >= kMinRateHz && options.rate_hz <= kMaxRateHz;
  if (!rate_holds || options.limit_ticks < 0 || options.fade_ticks < 0) {
    throw std::invalid_argument("run_servo: the rate or a number of ticks is out of range");
  }
}

/// When a tick began.
struct TickStart {
  std::int64_t tick;
  ServoClock::Time since_first;
  ServoClock::Time late;
};

/// Waits for ticks by a clock and measures how late they begin.
template <typename Clock>
class Pacing {
 public:
  /// In virtual time no tick is late and the clock is not read, so it does not advance.
  static constexpr bool kIsVirtual = std::is_same_v<Clock, VirtualClock>;

  Pacing(Clock& clock, double rate_hz) noexcept
      : clock_(clock), rate_hz_(rate_hz), first_(clock.now()) {}

  /// Waits for this tick.
  /// \return the tick due then: a later one if this one was missed
  TickStart wait_for(std::int64_t tick) noexcept {
    if constexpr (kIsVirtual) return {tick, {}, {}};
    const ServoClock::Time due = time_of(tick);
    clock_.wait_until(first_ + due);
    const TickStart start = start_of(tick, due, clock_.now() - first_);
    note(start);
    return start;
  }

  [[nodiscard]] ServoClock::Time now() const noexcept { return clock_.now(); }
  [[nodiscard]] const DurationHistogram& lateness() const noexcept { return lateness_; }

  void report_to(ServoReport& report) const noexcept {
    report.rate_hz = kIsVirtual ? rate_hz_ : measured_rate_hz();
    report.lateness = {lateness_.percentile_us(0.5), lateness_.percentile_us(0.99),
                       lateness_.percentile_us(0.999), lateness_.percentile_us(1.0)};
  }

 private:
  [[nodiscard]] ServoClock::Time time_of(std::int64_t tick) const noexcept {
    return ServoClock::Time(std::llround(static_cast<double>(tick) * 1e9 / rate_hz_));
  }

  [[nodiscard]] TickStart start_of(std::int64_t tick, ServoClock::Time due,
                                   ServoClock::Time now) const noexcept {
    const ServoClock::Time late = now - due;
    if (now < time_of(tick + 1)) return {tick, now, late};
    const double ticks = static_cast<double>(now.count()) * 1e-9 * rate_hz_;
    const auto newest = static_cast<std::int64_t>(ticks);
    return {std::max(newest, tick), now, late};
  }

  void note(const TickStart& start) noexcept {
    if (lateness_.count() == 0) began_ = start.since_first;
    lateness_.add(start.late);
    last_ = start.since_first;
  }

  [[nodiscard]] double measured_rate_hz() const noexcept {
    const double span_s = std::chrono::duration<double>(last_ - began_).count();
    return span_s > 0.0 ? static_cast<double>(lateness_.count() - 1) / span_s : 0.0;
  }

  Clock& clock_;
  double rate_hz_;
  ServoClock::Time first_;
  ServoClock::Time began_{};  ///< when the first tick began, since first_
  ServoClock::Time last_{};   ///< when the last one began
  DurationHistogram lateness_;
};

/// One run of the loop.
/// \tparam kIsWatched  whether there may be hooks
/// \tparam Device  HapticDevice, or a driver whose functions are to be compiled into the loop
template <bool kIsWatched, typename Device>
class ServoRun {
 public:
  ServoRun(Device& device, ForceSource& force, SampleSink& sink, const ServoOptions& options,
           const ServoHooks& hooks)
      : device_(device),
        force_(force),
        sink_(sink),
        hooks_(hooks),
        safety_(limits_on(device.info(), options.limits), 1.0 / options.rate_hz),
        rate_hz_(options.rate_hz),
        comfort_ticks_(comfort_ticks(limits_on(device.info(), options.limits), options.rate_hz)),
        fade_from_(options.limit_ticks),
        fade_ticks_(options.fade_ticks) {
    report_.force_limit_n = limits_on(device.info(), options.limits).max_force_n;
  }

  template <typename Clock>
  ServoReport run(Pacing<Clock> pacing) noexcept {
    std::optional<ServoEnd> end;
    take_heat(pacing.now());
    if (hooks_.parameters != nullptr) share_ = share_of(hooks_.parameters->get());
    {
      const RealtimeRegion region;
      end = run_ticks(pacing);
      // If a maker's library compensates the weight, a force of zero leaves the motors on.
      if (end == ServoEnd::fault) device_.halt();
      // The loop has ended; a lost device does not accept a zero either.
      static_cast<void>(device_.write({}));
      if (hooks_.heartbeat != nullptr) {
        hooks_.heartbeat->store(kServoAtRest, std::memory_order_release);
      }
    }
    if (hooks_.heat != nullptr) *hooks_.heat = {safety_.heat_n2(), pacing.now()};
    report_.end = end.value_or(end_of_fade_);
    report_.fault = safety_.fault();
    report_.device_fault = device_.fault();
    pacing.report_to(report_);
    if (hooks_.lateness != nullptr) hooks_.lateness->add(pacing.lateness());
    return report_;
  }

 private:
  template <typename Clock>
  std::optional<ServoEnd> run_ticks(Pacing<Clock>& pacing) noexcept {
    for (std::int64_t tick = 0; tick < end_of_ticks(); ++tick) {
      const TickStart start = pacing.wait_for(tick);
      if constexpr (!Pacing<Clock>::kIsVirtual) {
        report_.overruns += std::min(start.tick, end_of_ticks()) - tick;
        tick = start.tick;
        take_requests(tick);
        if (tick >= end_of_ticks()) break;
      }
      const std::optional<ServoEnd> end = run_tick(start);
      if (kIsWatched && hooks_.heartbeat != nullptr) {
        hooks_.heartbeat->fetch_add(1, std::memory_order_release);
      }
      if (end) return end;
    }
    return std::nullopt;
  }

  /// A comfort stop lasts until the slew limit has also reached zero.
  [[nodiscard]] std::int64_t end_of_ticks() const noexcept {
    const bool may_let_go = end_of_comfort_stop_ > end_of_fade();
    return may_let_go && safety_.sent_n() != Vec3{} ? end_of_comfort_stop_ : end_of_fade();
  }
  [[nodiscard]] std::int64_t end_of_fade() const noexcept { return fade_from_ + fade_ticks_; }

  void take_requests(std::int64_t tick) noexcept {
    if (!kIsWatched || hooks_.control == nullptr) return;
    if (hooks_.control->emergency_stop_asked()) safety_.trip(SafetyFault::emergency_stop);
    if (hooks_.control->stall_seen()) safety_.trip(SafetyFault::stalled);
    if (hooks_.control->comfort_stop_asked()) stop_in_comfort(tick);
    if (hooks_.control->finish_asked()) fade_out(tick, ServoEnd::hand_stopped);
  }

  /// Starts the fade now unless one has started.
  void fade_out(std::int64_t tick, ServoEnd end) noexcept {
    if (tick >= fade_from_) return;
    fade_from_ = tick;
    end_of_fade_ = end;
  }

  /// Fades from the current share, unless a running fade ends sooner. The fade leaves the slew
  /// limit the time that it may need of the 100 ms.
  void stop_in_comfort(std::int64_t tick) noexcept {
    const bool fades = tick >= fade_from_;
    if (fades && end_of_fade() <= tick + comfort_ticks_) return;
    fade_share_ = fades ? fade_at(tick - 1) : 1.0;
    fade_from_ = tick;
    fade_ticks_ = comfort_ticks_;
    end_of_comfort_stop_ = tick + std::llround(std::floor(kComfortStopS * rate_hz_));
    end_of_fade_ = ServoEnd::comfort_stop;
  }

  static std::int64_t comfort_ticks(const SafetyLimits& limits, double rate_hz) noexcept {
    if (!is_sound(limits)) return 1;
    return std::llround(std::floor((kComfortStopS - let_go_s(limits)) * rate_hz)) - 1;
  }

  /// \return 1 until the fade begins, then falling to 0
  double fade_at(std::int64_t tick) const noexcept {
    if (tick < fade_from_) return 1.0;
    if (tick + 1 >= end_of_fade()) return 0.0;
    const double gone = static_cast<double>(tick + 1 - fade_from_);
    return fade_share_ * (1.0 - gone / static_cast<double>(fade_ticks_));
  }

  /// A known driver's tick and the chain are inlined into this.
  /// \return why the loop must end, or nothing
  [[gnu::flatten]] std::optional<ServoEnd> run_tick(const TickStart& start) noexcept {
    DeviceSample sample;
    const DeviceStatus state = device_.read(sample);
    if (state == DeviceStatus::stopped) return ServoEnd::hand_stopped;
    if (state == DeviceStatus::fault) safety_.trip(SafetyFault::device);
    if (sample.delivered_n) note_delivered(*sample.delivered_n);
    const double fade = fade_at(start.tick);
    const Vec3 rendered_n = (fade * share()) * by_number(force_.force_n(sample));
    if (force_.is_done()) fade_out(start.tick, ServoEnd::hand_stopped);
    const Vec3 carried_n = device_.support_force_n(sample);
    const Vec3 support_n = carried_n == Vec3{} ? carried_n : fade * carried_n;
    SafeForce safe = safety_.check(rendered_n, sample, start.tick - last_tick_, support_n);
    last_tick_ = start.tick;
    if (sample.limited && safe.verdict == SafetyVerdict::passed) {
      safe.verdict = SafetyVerdict::limited;
    }
    if (safe.verdict != SafetyVerdict::fault && device_.write(safe.force_n) != DeviceStatus::ok) {
      safety_.trip(SafetyFault::device);
      safe = {{}, SafetyVerdict::fault};
    }
    show(start, sample, support_n == Vec3{} ? rendered_n : rendered_n + support_n, safe);
    if (safe.verdict == SafetyVerdict::fault) return ServoEnd::fault;
    count(sample, safe, start.tick);
    return std::nullopt;
  }

  /// Compares the device's report with the force of the previous tick.
  void note_delivered(Vec3 delivered_n) noexcept {
    const Vec3 sent_n = safety_.sent_n();
    if (dot(sent_n, sent_n) < kComparedN * kComparedN) return;
    sent_squared_n2_ += dot(sent_n, sent_n);
    sent_delivered_n2_ += dot(sent_n, delivered_n);
    report_.delivered_share = sent_delivered_n2_ / sent_squared_n2_;
  }

  void take_heat(ServoClock::Time now) noexcept {
    if (hooks_.heat == nullptr) return;
    safety_.begin_warm(hooks_.heat->heat_n2,
                       std::chrono::duration<double>(now - hooks_.heat->when).count());
  }

  /// \return the factor of this tick's force, which follows the parameters
  double share() noexcept {
    if (!kIsWatched || hooks_.parameters == nullptr) return 1.0;
    const double max_step = 1.0 / (kShareS * rate_hz_);
    share_ += std::clamp(share_of(hooks_.parameters->get()) - share_, -max_step, max_step);
    return share_;
  }

  void count(const DeviceSample& sample, const SafeForce& safe, std::int64_t tick) noexcept {
    sink_.record({sample.position_mm, safe.rendered_n, tick});
    ++report_.ticks;
    if (safe.verdict == SafetyVerdict::limited) ++report_.limited_ticks;
    report_.contact_ticks += safe.rendered_n.z > 0.0 ? 1 : 0;
  }

  /// Publishes this tick to the observer and the flight recorder.
  void show(const TickStart& start, const DeviceSample& sample, Vec3 requested_n,
            const SafeForce& safe) noexcept {
    if constexpr (!kIsWatched) return;
    const double late_us = static_cast<double>(start.late.count()) * 1e-3;
    if (hooks_.state != nullptr) {
      hooks_.state->set({sample, safe.rendered_n, safe.verdict, start.tick, late_us});
    }
    if (hooks_.recorder != nullptr) {
      const bool fault = safe.verdict == SafetyVerdict::fault;
      hooks_.recorder->record({start.tick, start.since_first, sample, requested_n, safe.force_n,
                               safe.verdict, safety_.fault(),
                               fault ? device_.fault() : DeviceFault::none, late_us});
    }
  }

  Device& device_;
  ForceSource& force_;
  SampleSink& sink_;
  const ServoHooks& hooks_;
  SafetyChain safety_;
  double rate_hz_;
  std::int64_t comfort_ticks_;
  std::int64_t last_tick_ = -1;
  std::int64_t fade_from_;
  std::int64_t fade_ticks_;
  double fade_share_ = 1.0;  ///< at which the fade begins
  double share_ = 1.0;       ///< follows ServoParameters::force_share
  double sent_squared_n2_ = 0.0;
  double sent_delivered_n2_ = 0.0;
  std::int64_t end_of_comfort_stop_ = 0;
  ServoEnd end_of_fade_ = ServoEnd::time_limit;
  ServoReport report_;
};

template <typename Clock, typename Device>
ServoReport run(Device& device, ForceSource& force, SampleSink& sink, const ServoOptions& options,
                Clock& clock, const ServoHooks& hooks) {
  check(options);
  // A run in virtual time is neither observed nor controlled.
  constexpr bool kIsWatched = !Pacing<Clock>::kIsVirtual;
  ServoRun<kIsWatched, Device> servo(device, force, sink, options, hooks);
  return servo.run(Pacing<Clock>(clock, options.rate_hz));
}

}  // namespace

ServoReport run_servo(HapticDevice& device, ForceSource& force, SampleSink& sink,
                      const ServoOptions& options, ServoClock& clock, const ServoHooks& hooks) {
  return run(device, force, sink, options, clock, hooks);
}

ServoReport run_servo_in_virtual_time(HapticDevice& device, ForceSource& force, SampleSink& sink,
                                      const ServoOptions& options) {
  VirtualClock clock;
  if (auto* const hand = dynamic_cast<SimulatedHand*>(&device)) {
    return run(*hand, force, sink, options, clock, {});
  }
  return run(device, force, sink, options, clock, {});
}

std::string_view name_of(ServoEnd end) noexcept {
  using enum ServoEnd;
  static constexpr auto kNames = std::to_array<Named<ServoEnd>>({{"hand_stopped", hand_stopped},
                                                                 {"time_limit", time_limit},
                                                                 {"comfort_stop", comfort_stop},
                                                                 {"fault", fault}});
  return name_in(kNames, end);
}

std::string_view name_of(SafetyVerdict verdict) noexcept {
  using enum SafetyVerdict;
  static constexpr auto kNames = std::to_array<Named<SafetyVerdict>>(
      {{"passed", passed}, {"limited", limited}, {"fault", fault}});
  return name_in(kNames, verdict);
}

std::string_view name_of(SafetyFault fault) noexcept {
  using enum SafetyFault;
  static constexpr auto kNames =
      std::to_array<Named<SafetyFault>>({{"none", none},
                                         {"not_finite", not_finite},
                                         {"emergency_stop", emergency_stop},
                                         {"not_ready", not_ready},
                                         {"overspeed", overspeed},
                                         {"stale_sample", stale_sample},
                                         {"frozen_encoders", frozen_encoders},
                                         {"stalled", stalled},
                                         {"device", device}});
  return name_in(kNames, fault);
}

std::string_view name_of(DeviceFault fault) noexcept {
  using enum DeviceFault;
  static constexpr auto kNames = std::to_array<Named<DeviceFault>>({{"none", none},
                                                                    {"link_lost", link_lost},
                                                                    {"bad_data", bad_data},
                                                                    {"warm_motors", warm_motors},
                                                                    {"limit_passed", limit_passed},
                                                                    {"driver", driver}});
  return name_in(kNames, fault);
}

std::string fault_names(const ServoReport& report) {
  std::string names(name_of(report.fault));
  if (report.device_fault != DeviceFault::none) {
    names += " (" + std::string(name_of(report.device_fault)) + ")";
  }
  return names;
}

}  // namespace touchtrial::device
