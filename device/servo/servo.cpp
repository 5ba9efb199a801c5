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
/// Below this, a force is not compared with the force that the device reports.
constexpr double kMinComparedN = 0.1;

double share_of(const ServoParameters& parameters) noexcept {
  return parameters.force_share >= 0.0 ? std::min(parameters.force_share, 1.0) : 0.0;
}

void check(const ServoOptions& options) {
  const bool rate_ok = options.rate_hz >= kMinRateHz && options.rate_hz <= kMaxRateHz;
  if (!rate_ok || options.limit_ticks < 0 || options.fade_ticks < 0) {
    throw std::invalid_argument("run_servo: the rate or a number of ticks is out of range");
  }
}

/// The start of a tick.
struct TickStart {
  std::int64_t tick;
  ServoClock::Time since_first;
  ServoClock::Time lateness;
};

/// Waits for each tick and measures how late it begins.
template <typename Clock>
class Pacing {
 public:
  /// In virtual time no tick is late and the clock is not read, so it does not advance.
  static constexpr bool kIsVirtual = std::is_same_v<Clock, VirtualClock>;

  Pacing(Clock& clock, double rate_hz) noexcept
      : clock_(clock), rate_hz_(rate_hz), start_time_(clock.now()) {}

  /// \return the tick that is due after the wait: a later one if `tick` was missed
  TickStart wait_for(std::int64_t tick) noexcept {
    if constexpr (kIsVirtual) return {tick, {}, {}};
    const ServoClock::Time due = time_of(tick);
    clock_.wait_until(start_time_ + due);
    const TickStart start = start_of(tick, due, clock_.now() - start_time_);
    record_start(start);
    return start;
  }

  [[nodiscard]] ServoClock::Time now() const noexcept { return clock_.now(); }
  [[nodiscard]] const DurationHistogram& lateness() const noexcept { return lateness_; }

  void fill_report(ServoReport& report) const noexcept {
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
    const ServoClock::Time since_due = now - due;
    if (now < time_of(tick + 1)) return {tick, now, since_due};
    const double ticks = static_cast<double>(now.count()) * 1e-9 * rate_hz_;
    const auto newest = static_cast<std::int64_t>(ticks);
    return {std::max(newest, tick), now, since_due};
  }

  void record_start(const TickStart& start) noexcept {
    if (lateness_.count() == 0) first_start_ = start.since_first;
    lateness_.add(start.lateness);
    last_start_ = start.since_first;
  }

  [[nodiscard]] double measured_rate_hz() const noexcept {
    const double span_s = std::chrono::duration<double>(last_start_ - first_start_).count();
    return span_s > 0.0 ? static_cast<double>(lateness_.count() - 1) / span_s : 0.0;
  }

  Clock& clock_;
  double rate_hz_;
  ServoClock::Time start_time_;
  ServoClock::Time first_start_{};  ///< when the first tick began, relative to start_time_
  ServoClock::Time last_start_{};   ///< when the last tick began, relative to start_time_
  DurationHistogram lateness_;
};

/// One run of the loop.
/// \tparam kHasHooks  whether hooks may be set
/// \tparam Device  HapticDevice, or a driver whose functions are to be inlined into the loop
template <bool kHasHooks, typename Device>
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
        fade_start_(options.limit_ticks),
        fade_ticks_(options.fade_ticks) {
    report_.force_limit_n = limits_on(device.info(), options.limits).max_force_n;
  }

  template <typename Clock>
  ServoReport run(Pacing<Clock> pacing) noexcept {
    std::optional<ServoEnd> end;
    load_heat(pacing.now());
    if (hooks_.parameters != nullptr) share_ = share_of(hooks_.parameters->get());
    {
      const RealtimeRegion region;
      end = run_ticks(pacing);
      // If a maker's library compensates the weight, a force of zero leaves the motors on.
      if (end == ServoEnd::fault) device_.halt();
      // The status is irrelevant: the loop has ended, and a lost device does not accept zero
      // either.
      static_cast<void>(device_.write({}));
      if (hooks_.heartbeat != nullptr) {
        hooks_.heartbeat->store(kServoAtRest, std::memory_order_release);
      }
    }
    if (hooks_.heat != nullptr) *hooks_.heat = {safety_.heat_n2(), pacing.now()};
    report_.end = end.value_or(fade_result_);
    report_.fault = safety_.fault();
    report_.device_fault = device_.fault();
    pacing.fill_report(report_);
    if (hooks_.lateness != nullptr) hooks_.lateness->add(pacing.lateness());
    return report_;
  }

 private:
  template <typename Clock>
  std::optional<ServoEnd> run_ticks(Pacing<Clock>& pacing) noexcept {
    for (std::int64_t tick = 0; tick < end_tick(); ++tick) {
      const TickStart start = pacing.wait_for(tick);
      if constexpr (!Pacing<Clock>::kIsVirtual) {
        report_.overruns += std::min(start.tick, end_tick()) - tick;
        tick = start.tick;
        handle_requests(tick);
        if (tick >= end_tick()) break;
      }
      const std::optional<ServoEnd> end = run_tick(start);
      if (kHasHooks && hooks_.heartbeat != nullptr) {
        hooks_.heartbeat->fetch_add(1, std::memory_order_release);
      }
      if (end) return end;
    }
    return std::nullopt;
  }

  /// A comfort stop lasts until the slew limit has also reached zero.
  [[nodiscard]] std::int64_t end_tick() const noexcept {
    const bool is_releasing =
        comfort_stop_end_tick_ > fade_end_tick() && safety_.sent_n() != Vec3{};
    return is_releasing ? comfort_stop_end_tick_ : fade_end_tick();
  }
  [[nodiscard]] std::int64_t fade_end_tick() const noexcept { return fade_start_ + fade_ticks_; }

  void handle_requests(std::int64_t tick) noexcept {
    if (!kHasHooks || hooks_.control == nullptr) return;
    if (hooks_.control->emergency_stop_requested()) safety_.trip(SafetyFault::emergency_stop);
    if (hooks_.control->stall_requested()) safety_.trip(SafetyFault::stalled);
    if (hooks_.control->comfort_stop_requested()) start_comfort_stop(tick);
    if (hooks_.control->finish_requested()) fade_out(tick, ServoEnd::hand_stopped);
  }

  /// Starts the fade now unless one has started.
  void fade_out(std::int64_t tick, ServoEnd end) noexcept {
    if (tick >= fade_start_) return;
    fade_start_ = tick;
    fade_result_ = end;
  }

  /// Fades from the current share, unless a running fade ends sooner. The fade takes less than
  /// kComfortStopS, so that the slew limit also reaches zero in time.
  void start_comfort_stop(std::int64_t tick) noexcept {
    const bool is_fading = tick >= fade_start_;
    if (is_fading && fade_end_tick() <= tick + comfort_ticks_) return;
    fade_share_ = is_fading ? fade_at(tick - 1) : 1.0;
    fade_start_ = tick;
    fade_ticks_ = comfort_ticks_;
    comfort_stop_end_tick_ = tick + std::llround(std::floor(kComfortStopS * rate_hz_));
    fade_result_ = ServoEnd::comfort_stop;
  }

  static std::int64_t comfort_ticks(const SafetyLimits& limits, double rate_hz) noexcept {
    if (!are_valid(limits)) return 1;
    return std::llround(std::floor((kComfortStopS - max_release_s(limits)) * rate_hz)) - 1;
  }

  /// \return 1 until the fade begins, then falling to 0
  double fade_at(std::int64_t tick) const noexcept {
    if (tick < fade_start_) return 1.0;
    if (tick + 1 >= fade_end_tick()) return 0.0;
    const double elapsed = static_cast<double>(tick + 1 - fade_start_);
    return fade_share_ * (1.0 - elapsed / static_cast<double>(fade_ticks_));
  }

  /// Flattened, so that the safety chain and a driver of known type are inlined.
  /// \return why the loop must end, or nothing
  [[gnu::flatten]] std::optional<ServoEnd> run_tick(const TickStart& start) noexcept {
    DeviceSample sample;
    const DeviceStatus status = device_.read(sample);
    if (status == DeviceStatus::stopped) return ServoEnd::hand_stopped;
    if (status == DeviceStatus::fault) safety_.trip(SafetyFault::device);
    if (sample.delivered_n) add_delivered(*sample.delivered_n);
    const double fade = fade_at(start.tick);
    const Vec3 rendered_n = (fade * next_share()) * copy_by_component(force_.force_n(sample));
    if (force_.is_done()) fade_out(start.tick, ServoEnd::hand_stopped);
    const Vec3 device_support_n = device_.support_force_n(sample);
    const Vec3 support_n = device_support_n == Vec3{} ? device_support_n : fade * device_support_n;
    SafeForce safe = safety_.check(rendered_n, sample, start.tick - last_tick_, support_n);
    last_tick_ = start.tick;
    if (sample.limited && safe.verdict == SafetyVerdict::passed) {
      safe.verdict = SafetyVerdict::limited;
    }
    if (safe.verdict != SafetyVerdict::fault && device_.write(safe.force_n) != DeviceStatus::ok) {
      safety_.trip(SafetyFault::device);
      safe = {{}, SafetyVerdict::fault};
    }
    publish(start, sample, support_n == Vec3{} ? rendered_n : rendered_n + support_n, safe);
    if (safe.verdict == SafetyVerdict::fault) return ServoEnd::fault;
    record_tick(sample, safe, start.tick);
    return std::nullopt;
  }

  /// Compares the device's report with the force of the previous tick.
  void add_delivered(Vec3 delivered_n) noexcept {
    const Vec3 sent_n = safety_.sent_n();
    if (dot(sent_n, sent_n) < kMinComparedN * kMinComparedN) return;
    sent_squared_n2_ += dot(sent_n, sent_n);
    sent_delivered_n2_ += dot(sent_n, delivered_n);
    report_.delivered_share = sent_delivered_n2_ / sent_squared_n2_;
  }

  void load_heat(ServoClock::Time now) noexcept {
    if (hooks_.heat == nullptr) return;
    safety_.begin_warm(hooks_.heat->heat_n2,
                       std::chrono::duration<double>(now - hooks_.heat->when).count());
  }

  /// Moves the share towards ServoParameters::force_share by one step.
  /// \return the factor of this tick's force
  double next_share() noexcept {
    if (!kHasHooks || hooks_.parameters == nullptr) return 1.0;
    const double max_step = 1.0 / (kShareS * rate_hz_);
    share_ += std::clamp(share_of(hooks_.parameters->get()) - share_, -max_step, max_step);
    return share_;
  }

  void record_tick(const DeviceSample& sample, const SafeForce& safe, std::int64_t tick) noexcept {
    sink_.record({sample.position_mm, safe.rendered_n, tick});
    ++report_.ticks;
    if (safe.verdict == SafetyVerdict::limited) ++report_.limited_ticks;
    report_.contact_ticks += safe.rendered_n.z > 0.0 ? 1 : 0;
  }

  /// Publishes this tick to the observer and the flight recorder.
  void publish(const TickStart& start, const DeviceSample& sample, Vec3 requested_n,
               const SafeForce& safe) noexcept {
    if constexpr (!kHasHooks) return;
    const double lateness_us = static_cast<double>(start.lateness.count()) * 1e-3;
    if (hooks_.state != nullptr) {
      hooks_.state->set({sample, safe.rendered_n, safe.verdict, start.tick, lateness_us});
    }
    if (hooks_.recorder != nullptr) {
      const bool is_fault = safe.verdict == SafetyVerdict::fault;
      hooks_.recorder->record({start.tick, start.since_first, sample, requested_n, safe.force_n,
                               safe.verdict, safety_.fault(),
                               is_fault ? device_.fault() : DeviceFault::none, lateness_us});
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
  std::int64_t fade_start_;
  std::int64_t fade_ticks_;
  double fade_share_ = 1.0;  ///< the share at which the fade begins
  double share_ = 1.0;       ///< follows ServoParameters::force_share
  double sent_squared_n2_ = 0.0;
  double sent_delivered_n2_ = 0.0;
  std::int64_t comfort_stop_end_tick_ = 0;
  ServoEnd fade_result_ = ServoEnd::time_limit;
  ServoReport report_;
};

template <typename Clock, typename Device>
ServoReport run(Device& device, ForceSource& force, SampleSink& sink, const ServoOptions& options,
                Clock& clock, const ServoHooks& hooks) {
  check(options);
  // A run in virtual time is neither observed nor controlled.
  constexpr bool kHasHooks = !Pacing<Clock>::kIsVirtual;
  ServoRun<kHasHooks, Device> servo(device, force, sink, options, hooks);
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
