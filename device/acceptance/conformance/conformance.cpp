#include "device/acceptance/conformance/conformance.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

using Id = ConformanceId;
using Time = ServoClock::Time;

constexpr Time kTick{1'000'000};
/// How long the checks wait for an event without its own time limit.
constexpr double kTimeoutS = 5.0;
/// The same if times are not judged.
constexpr double kUntimedTimeoutS = 300.0;
/// How long the force must stay zero.
constexpr double kZeroLastsS = 0.050;
constexpr double kMaxSpeedMmS = 2000.0;
constexpr double kMaxDistanceMm = 10'000.0;
constexpr double kWorkspaceMargin = 0.2;
constexpr double kMaxRate = 10'000.0;
constexpr double kMaxStrength = 100.0;
constexpr double kMinRate = 500.0;

std::string force_text(Vec3 force_n) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) N", force_n.x, force_n.y, force_n.z);
}

/// \return the first fault of a description; empty if none
std::string description_fault(const DeviceInfo& info) {
  const auto is_within = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  if (info.name.empty()) return "it has no name";
  if (!(info.max_force_n > 0.0) || info.max_force_n > kMaxStrength) {
    return fmt::format("its peak force is {:g} N", info.max_force_n);
  }
  if (!is_within(info.continuous_force_n, 0.0, info.max_force_n)) {
    return fmt::format("its continuous force is {:g} N", info.continuous_force_n);
  }
  if (!is_within(info.max_rate_hz, kMinRate, kMaxRate)) {
    return fmt::format("its rate is {:g} Hz", info.max_rate_hz);
  }
  if (!is_within(info.max_stiffness_n_per_mm, 0.0, kMaxStrength)) {
    return fmt::format("its largest stiffness is {:g} N/mm", info.max_stiffness_n_per_mm);
  }
  if (!info.workspace) return {};
  const Vec3 size = info.workspace->max_mm - info.workspace->min_mm;
  const bool is_plausible = is_within(size.x, 1.0, 2000.0) && is_within(size.y, 1.0, 2000.0) &&
                            is_within(size.z, 1.0, 2000.0);
  return is_plausible
             ? ""
             : fmt::format("its workspace is {:g} x {:g} x {:g} mm", size.x, size.y, size.z);
}

/// Compares the velocity with the change of position in intervals of 50 ms with motion.
class VelocityCheck {
 public:
  void add(const DeviceSample& sample, double time_s) noexcept {
    if (ticks_ == 0) {
      start_mm_ = sample.position_mm;
    } else {
      travelled_mm_ =
          travelled_mm_ + (0.5 * (time_s - last_s_)) * (sample.velocity_mm_s + last_velocity_mm_s_);
    }
    last_velocity_mm_s_ = sample.velocity_mm_s;
    last_s_ = time_s;
    if (++ticks_ <= kIntervalTicks) return;
    judge(sample.position_mm - start_mm_);
    ticks_ = 0;
    travelled_mm_ = {};
  }
  [[nodiscard]] int intervals() const noexcept { return intervals_; }
  [[nodiscard]] int wrong_intervals() const noexcept { return wrong_intervals_; }

 private:
  static constexpr int kIntervalTicks = 50;
  static constexpr double kMovedMm = 1.0;

  void judge(Vec3 moved_mm) noexcept {
    const double max_mm = std::max(norm(moved_mm), norm(travelled_mm_));
    if (max_mm < kMovedMm) return;
    ++intervals_;
    if (norm(moved_mm - travelled_mm_) > 0.5 * max_mm) ++wrong_intervals_;
  }

  int ticks_ = 0;
  int intervals_ = 0;
  int wrong_intervals_ = 0;
  Vec3 start_mm_;
  Vec3 travelled_mm_;
  Vec3 last_velocity_mm_s_;
  double last_s_ = 0.0;
};

bool is_inside(const Workspace& workspace, Vec3 position_mm) noexcept {
  const Vec3 size = workspace.max_mm - workspace.min_mm;
  const Vec3 middle = 0.5 * (workspace.max_mm + workspace.min_mm);
  const Vec3 from_middle = position_mm - middle;
  const double share = 0.5 + kWorkspaceMargin;
  return std::abs(from_middle.x) <= share * size.x && std::abs(from_middle.y) <= share * size.y &&
         std::abs(from_middle.z) <= share * size.z;
}

/// Runs all checks once.
class ConformanceRun {
 public:
  ConformanceRun(const ConformanceSubject& subject, ServoClock& clock,
                 const ConformanceOptions& options)
      : subject_(subject), clock_(clock), options_(options), next_(clock.now()) {}

  std::vector<ConformanceCheck> run() {
    check_first_opening();
    if (!has_ended() && is_alive()) check_reopening();
    record_.set_remaining_not_observed(
        is_stopped() ? "the check was stopped" : "an earlier check failed", false);
    return record_.checks(false);
  }

 private:
  // --- Time -------------------------------------------------------------------------------------

  /// \return the observed time, s. Each tick counts for at most two, because during a pause of this
  ///   thread the driver may have paused as well.
  [[nodiscard]] double now_s() const noexcept { return seconds_in(observed_); }
  [[nodiscard]] double clock_s() const noexcept { return seconds_in(clock_.now() - start_); }
  [[nodiscard]] static double seconds_in(Time time) noexcept {
    return 1e-9 * static_cast<double>(time.count());
  }
  void wait_for_tick() noexcept {
    const Time before = clock_.now();
    next_ = std::max(next_ + kTick, before);
    clock_.wait_until(next_);
    observed_ += std::min(clock_.now() - before, 2 * kTick);
  }
  [[nodiscard]] bool is_stopped() const { return options_.stopped && options_.stopped(); }
  [[nodiscard]] bool has_ended() const { return has_failed_ || is_stopped(); }

  /// Checks a condition at every tick until it holds.
  /// \return false at the time limit, or if the run ends
  template <typename Condition>
  bool poll_until(double limit_s, const Condition& condition) {
    const double end_s = now_s() + limit_s;
    for (;;) {
      if (condition()) return true;
      if (has_ended() || now_s() >= end_s) return false;
      wait_for_tick();
    }
  }
  /// Reads, and writes the force if given, for this long.
  void pass_time(double time_s, const std::optional<Vec3>& force_n) {
    poll_until(time_s, [&] {
      (void)read();
      if (force_n && !has_failed_) write(*force_n);
      return false;
    });
  }
  [[nodiscard]] double timeout_s() const noexcept {
    return options_.judges_time ? kTimeoutS : kUntimedTimeoutS;
  }

  // --- The device -------------------------------------------------------------------------------

  /// Opens the device.
  /// \return whether it succeeded; else the check fails
  bool open(Id id) {
    try {
      device_ = subject_.open();
    } catch (const Error& error) {
      record_.fail(id, error.what());
      return false;
    }
    if (options_.guard) guard_ = options_.guard(*device_);
    return true;
  }
  void close() {
    guard_.reset();
    device_.reset();
  }

  /// Reads, and records a fault as the driver's failure.
  DeviceSample read() {
    DeviceSample sample;
    const DeviceStatus status = device_->read(sample);
    if (status == DeviceStatus::fault) record_fault();
    if (status == DeviceStatus::stopped) is_motion_over_ = true;
    return sample;
  }
  void write(Vec3 force_n) {
    if (device_->write(force_n) == DeviceStatus::fault) record_fault();
  }
  void record_fault() {
    if (has_failed_) return;
    has_failed_ = true;
    const auto failure = subject_.find_failure ? subject_.find_failure(*device_) : std::nullopt;
    if (failure) {
      record_.fail(failure->id, failure->details);
    } else if (device_->fault() == DeviceFault::bad_data) {
      record_.fail(Id::values, "the driver reports invalid data from the device");
    } else {
      record_.fail(Id::staying,
                   "the driver reported a fault after " + fmt::format("{:.1f} s", now_s()));
    }
  }

  [[nodiscard]] std::optional<Vec3> motor_force() const {
    return subject_.motor_force_n ? subject_.motor_force_n() : std::nullopt;
  }
  [[nodiscard]] bool is_motor_force_zero() const {
    const auto force_n = motor_force();
    return force_n && norm(*force_n) < ConformanceOptions::kZeroN;
  }
  [[nodiscard]] Vec3 push_n(int axis, double sign) const {
    const double strength = sign * std::min(ConformanceOptions::kPushN, info_.max_force_n);
    return {axis == 0 ? strength : 0.0, axis == 1 ? strength : 0.0, axis == 2 ? strength : 0.0};
  }

  // --- Checks -----------------------------------------------------------------------------------

  /// \return whether the device opened and delivered new readings
  [[nodiscard]] bool is_alive() const {
    return !record_.failed(Id::opening) && !record_.failed(Id::numbering);
  }

  void check_first_opening() {
    if (!open(Id::opening)) return;
    record_.pass(Id::opening);
    check_description();
    if (wait_until_ready()) {
      observe_readings();
      if (!has_ended() && is_alive()) check_forces();
    }
    close();
    if (is_pushing_at_close_) check_closed();
  }

  void check_description() {
    info_ = device_->info();
    const std::string fault = description_fault(info_);
    if (!fault.empty()) {
      record_.fail(Id::description, fault);
    } else {
      record_.pass(Id::description,
                   fmt::format("{:.1f} N peak, {:.2f} N continuous, {:.0f} Hz", info_.max_force_n,
                               info_.continuous_force_n, info_.max_rate_hz));
    }
  }

  /// \return whether there was a reading; else the check fails
  bool wait_for_reading() {
    const bool has_reading =
        poll_until(timeout_s(), [&] { return read().sequence > 0 || has_failed_; });
    if (!has_reading && !is_stopped()) {
      record_.fail(Id::numbering, fmt::format("no reading in {:.0f} s", timeout_s()));
    }
    return has_reading && !has_failed_;
  }

  /// \return whether the device is ready
  bool wait_until_ready() {
    if (!wait_for_reading()) return false;
    UnreadyState observation;
    const bool is_ready = poll_until(options_.ready_limit_s, [&] {
      const DeviceSample sample = read();
      if (has_failed_ || sample.ready) return true;
      if (observation.readings == 0 && options_.advise) options_.advise(device_->readiness());
      // The driver itself must suppress this force.
      write(options_.pushes && motor_force() ? push_n(0, 1.0) : Vec3{});
      observe_unready(observation);
      return has_failed_;
    });
    judge(observation);
    if (has_failed_ || is_stopped()) return false;
    if (!is_ready) {
      record_.set_remaining_not_observed(
          fmt::format("the device was not ready within {:.0f} s", options_.ready_limit_s), false);
      return false;
    }
    // Resets the force to zero.
    pass_time(ConformanceOptions::kZeroWithinS, Vec3{});
    return !has_ended();
  }

  struct UnreadyState {
    int readings = 0;
    bool has_motor_data = false;
    double max_motor_n = 0.0;
  };

  void observe_unready(UnreadyState& observation) const {
    ++observation.readings;
    const auto force_n = motor_force();
    // A device that has just become ready may push.
    if (!force_n || device_->readiness() == DeviceReadiness::ready) return;
    observation.has_motor_data = true;
    observation.max_motor_n = std::max(observation.max_motor_n, norm(*force_n));
  }

  void judge(const UnreadyState& observation) {
    if (observation.readings == 0) {
      record_.set_not_observed(Id::unready_zero, "it was ready at once");
    } else if (!observation.has_motor_data) {
      record_.set_not_observed(Id::unready_zero, not_observable_reason());
    } else {
      judge_motors(Id::unready_zero, observation.max_motor_n);
    }
  }

  void judge_motors(Id id, double max_motor_n) {
    if (max_motor_n < ConformanceOptions::kZeroN) {
      record_.pass(id);
    } else {
      record_.fail(id, fmt::format("{:.2f} N on the motors", max_motor_n));
    }
  }

  [[nodiscard]] std::string not_observable_reason() const {
    return "the motor commands cannot be observed";
  }

  void observe_readings() {
    const double begin_s = clock_s();
    Observation observation;
    is_motion_over_ = false;
    poll_until(options_.seconds, [&] {
      const DeviceSample sample = read();
      if (!has_failed_ && !is_motion_over_) observe(sample, observation);
      write({});
      return has_failed_ || is_motion_over_;
    });
    judge(observation, clock_s() - begin_s);
  }

  struct Observation {
    std::uint64_t first_sequence = 0;
    std::uint64_t last_sequence = 0;
    double last_new_s = 0.0;
    double longest_gap_s = 0.0;
    bool has_decreased = false;
    std::string bad_value;
    bool is_outside = false;
    Vec3 outside_mm;
    VelocityCheck velocity;
    bool has_motor_data = false;
    double max_motor_n = 0.0;
  };

  void observe(const DeviceSample& sample, Observation& observation) const {
    const double time_s = now_s();
    if (observation.first_sequence == 0) {
      observation.first_sequence = observation.last_sequence = sample.sequence;
      observation.last_new_s = time_s;
    }
    if (sample.sequence < observation.last_sequence) observation.has_decreased = true;
    observation.longest_gap_s =
        std::max(observation.longest_gap_s, time_s - observation.last_new_s);
    if (sample.sequence > observation.last_sequence) {
      observation.last_sequence = sample.sequence;
      observation.last_new_s = time_s;
    }
    observe_values(sample, observation);
    if (observation.bad_value.empty()) observation.velocity.add(sample, clock_s());
    if (const auto force_n = motor_force()) {
      observation.has_motor_data = true;
      observation.max_motor_n = std::max(observation.max_motor_n, norm(*force_n));
    }
  }

  void observe_values(const DeviceSample& sample, Observation& observation) const {
    const double distance_mm = norm(sample.position_mm);
    const double speed_mm_s = norm(sample.velocity_mm_s);
    if (!(distance_mm <= kMaxDistanceMm))
      observation.bad_value = fmt::format("{:g} mm away", distance_mm);
    if (!(speed_mm_s <= kMaxSpeedMmS)) observation.bad_value = fmt::format("{:g} mm/s", speed_mm_s);
    if (info_.workspace && !is_inside(*info_.workspace, sample.position_mm)) {
      observation.is_outside = true;
      observation.outside_mm = sample.position_mm;
    }
  }

  void judge(const Observation& observation, double observed_s) {
    if (has_failed_ || is_stopped()) return;
    record_.pass(Id::staying);
    if (observation.has_decreased) {
      record_.fail(Id::numbering, "a number was smaller than the previous one");
    }
    if (observation.last_sequence == observation.first_sequence) {
      record_.fail(Id::numbering, fmt::format("no new reading in {:.1f} s", observed_s));
      return;
    }
    record_.pass(Id::numbering, counted(static_cast<std::int64_t>(observation.last_sequence -
                                                                  observation.first_sequence),
                                        "new reading"));
    judge_values(observation);
    judge_times(observation, observed_s);
    if (!observation.has_motor_data) {
      record_.set_not_observed(Id::rest_zero, not_observable_reason());
    } else {
      judge_motors(Id::rest_zero, observation.max_motor_n);
    }
  }

  void judge_values(const Observation& observation) {
    if (observation.bad_value.empty()) {
      record_.pass(Id::values);
    } else {
      record_.fail(Id::values, observation.bad_value);
    }
    if (!info_.workspace) {
      record_.set_not_observed(Id::workspace, "the device has no device frame");
    } else if (observation.is_outside) {
      record_.fail(Id::workspace,
                   fmt::format("at ({:.1f}, {:.1f}, {:.1f}) mm", observation.outside_mm.x,
                               observation.outside_mm.y, observation.outside_mm.z));
    } else {
      record_.pass(Id::workspace);
    }
    const int intervals = observation.velocity.intervals();
    if (intervals == 0) {
      record_.set_not_observed(Id::velocity, "the handle did not move; move it during the check");
    } else if (5 * observation.velocity.wrong_intervals() > intervals) {
      record_.fail(Id::velocity, fmt::format("not so in {} of {} parts of 50 ms with motion",
                                             observation.velocity.wrong_intervals(), intervals));
    } else {
      record_.pass(Id::velocity, counted(intervals, "part") + " of 50 ms with motion");
    }
  }

  void judge_times(const Observation& observation, double observed_s) {
    const double rate_hz =
        static_cast<double>(observation.last_sequence - observation.first_sequence) / observed_s;
    const double min_hz = std::max(kMinRate, 0.5 * info_.max_rate_hz);
    const std::string rate = fmt::format("{:.0f} new readings per second", rate_hz);
    judge_time(Id::rate, rate_hz >= min_hz, rate);
    judge_time(Id::gaps, observation.longest_gap_s <= ConformanceOptions::kMaxGapS + 1e-9,
               fmt::format("oldest {:.1f} ms", 1e3 * observation.longest_gap_s));
  }

  void judge_time(Id id, bool passed, const std::string& finding) {
    if (!options_.judges_time) {
      record_.set_not_observed(id, finding + "; not judged");
    } else if (passed) {
      record_.pass(id, finding);
    } else {
      record_.fail(id, finding);
    }
  }

  void check_forces() {
    if (!options_.pushes || !motor_force()) {
      const std::string reason =
          options_.pushes ? not_observable_reason() : "no force was permitted";
      for (const Id id : {Id::pushing, Id::lapsing, Id::halting, Id::rearming, Id::closing_zero}) {
        record_.set_not_observed(id, reason);
      }
      return;
    }
    check_pushing();
    check_force_lifetime();
    check_halting();
    // Leaves a force on, to test closing.
    if (!has_ended())
      is_pushing_at_close_ = push(push_n(1, 1.0), [&] { return !is_motor_force_zero(); });
  }

  /// Writes a force until the motors meet a condition.
  /// \return false at the time limit
  template <typename Condition>
  bool push(Vec3 force_n, const Condition& condition, double limit_s) {
    return poll_until(limit_s, [&] {
      (void)read();
      write(force_n);
      return condition();
    });
  }
  template <typename Condition>
  bool push(Vec3 force_n, const Condition& condition) {
    return push(force_n, condition, timeout_s());
  }

  void check_pushing() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Vec3 sent_n = push_n(axis, sign);
        const double allowed_n = 0.05 * norm(sent_n) + ConformanceOptions::kZeroN;
        const bool was_received = push(sent_n, [&] {
          const auto force_n = motor_force();
          return force_n && norm(*force_n - sent_n) < allowed_n;
        });
        if (was_received || has_ended()) continue;
        const auto force_n = motor_force();
        record_.fail(Id::pushing, "sent " + force_text(sent_n) + ", the motors had " +
                                      (force_n ? force_text(*force_n) : "an unknown force"));
        return;
      }
    }
    if (!has_ended()) record_.pass(Id::pushing, "0.3 N along each axis in both directions");
  }

  /// \return the time until the motors are without force, s; nothing at the time limit
  std::optional<double> time_to_zero(const std::function<void()>& action) {
    const double begin_s = now_s();
    const bool reached_zero = poll_until(timeout_s(), [&] {
      (void)read();
      if (action) action();
      return is_motor_force_zero();
    });
    if (!reached_zero) return std::nullopt;
    return now_s() - begin_s;
  }

  /// \return whether the force ended in time
  bool judge_zero(Id id, const std::optional<double>& after_s) {
    if (has_ended()) return false;
    if (!after_s) {
      record_.fail(id, "a force stays on the motors");
      return false;
    }
    judge_time(id, *after_s <= ConformanceOptions::kZeroWithinS,
               fmt::format("after {:.0f} ms", 1e3 * *after_s));
    return true;
  }

  void check_force_lifetime() {
    if (has_ended()) return;
    if (!push(push_n(0, 1.0), [&] { return !is_motor_force_zero(); }))
      return skip_without_force(Id::lapsing);
    const bool reached_zero = judge_zero(Id::lapsing, time_to_zero({}));
    // Waits for a lasting zero before the next check.
    if (reached_zero) pass_time(kZeroLastsS, std::nullopt);
  }

  void skip_without_force(Id id) {
    if (!has_ended()) record_.set_not_observed(id, "there was no force that could end");
  }

  void check_halting() {
    if (has_ended()) return;
    const Vec3 force_n = push_n(2, 1.0);
    if (!push(force_n, [&] { return !is_motor_force_zero(); })) {
      skip_without_force(Id::halting);
      return skip_without_force(Id::rearming);
    }
    device_->halt();
    const bool reached_zero = judge_zero(Id::halting, time_to_zero([&] { write(force_n); }));
    if (!reached_zero) {
      device_->rearm();
      return;
    }
    if (push(
            force_n, [&] { return !is_motor_force_zero(); }, kZeroLastsS)) {
      record_.fail(Id::halting, "a force returned before re-arming");
    }
    device_->rearm();
    if (push(force_n, [&] { return !is_motor_force_zero(); })) {
      record_.pass(Id::rearming);
    } else if (!has_ended()) {
      record_.fail(Id::rearming, "no force followed");
    }
  }

  void check_closed() {
    const bool reached_zero = poll_until(kZeroLastsS, [&] { return is_motor_force_zero(); });
    if (reached_zero) {
      record_.pass(Id::closing_zero);
    } else {
      const auto force_n = motor_force();
      record_.fail(Id::closing_zero, (force_n ? force_text(*force_n) : std::string("a force")) +
                                         " remains on the motors");
    }
  }

  /// Waits for a reading with a larger number than `last`, and updates `last`.
  /// \return whether there was one
  bool wait_for_new_reading(std::uint64_t& last) {
    return poll_until(timeout_s(),
                      [&] {
                        const DeviceSample sample = read();
                        write({});
                        if (has_failed_ || sample.sequence <= last) return has_failed_;
                        last = sample.sequence;
                        return true;
                      }) &&
           !has_failed_;
  }

  void check_opening_twice() {
    if (!subject_.can_open_twice) {
      return record_.set_not_observed(Id::opening_twice, "the test rig allows one opening");
    }
    std::uint64_t last = 0;
    if (!wait_for_new_reading(last)) return;
    std::string finding = "the second opening works";
    try {
      const std::unique_ptr<HapticDevice> second = subject_.open();
      wait_for_tick();
    } catch (const Error& error) {
      finding = std::string("refused: ") + error.what();
    }
    // Checks three ticks, because the first reading may have been in transit.
    for (int i = 0; i < 3; ++i) {
      if (detect_end_of_first(last)) {
        return record_.fail(Id::opening_twice, "the first opening delivered no more readings");
      }
    }
    record_.pass(Id::opening_twice, finding);
  }

  /// Waits for a new reading of the first opening.
  /// \return whether there is none because of the second opening
  bool detect_end_of_first(std::uint64_t& last) {
    DeviceSample sample;
    const bool responds = poll_until(timeout_s(), [&] {
      const DeviceStatus status = device_->read(sample);
      if (status == DeviceStatus::fault) return true;
      (void)device_->write({});
      return sample.sequence > last;
    });
    const bool still_works = responds && device_->fault() == DeviceFault::none;
    last = sample.sequence;
    return !still_works && !is_stopped();
  }

  void check_reopening() {
    const DeviceInfo first = info_;
    for (int i = 0; i < options_.reopenings && !is_stopped(); ++i) {
      if (!open(Id::reopening)) return;
      const DeviceInfo reopened = device_->info();
      std::uint64_t last = 0;
      const bool has_reading = wait_for_new_reading(last);
      if (i == 0 && has_reading && !is_stopped()) check_opening_twice();
      close();
      if (has_failed_ || is_stopped()) return;
      if (!has_reading)
        return record_.fail(Id::reopening, "the device delivers no readings when reopened");
      if (reopened.serial != first.serial || reopened.model != first.model) {
        return record_.fail(Id::reopening, "it is '" + reopened.model + "' '" + reopened.serial +
                                               "' now, and was '" + first.model + "' '" +
                                               first.serial + "'");
      }
    }
    if (options_.reopenings > 0) record_.pass(Id::reopening, counted(options_.reopenings, "time"));
  }

  const ConformanceSubject& subject_;
  ServoClock& clock_;
  const ConformanceOptions& options_;
  Time next_;
  Time start_ = clock_.now();
  Time observed_{};
  ConformanceRecord record_;
  std::unique_ptr<HapticDevice> device_;
  std::shared_ptr<void> guard_;
  DeviceInfo info_;
  bool has_failed_ = false;      ///< a fault ended the device
  bool is_motion_over_ = false;  ///< the device has no more motion
  bool is_pushing_at_close_ = false;
};

}  // namespace

std::vector<ConformanceCheck> check_conformance(const ConformanceSubject& subject,
                                                ServoClock& clock,
                                                const ConformanceOptions& options) {
  return ConformanceRun(subject, clock, options).run();
}

}  // namespace touchtrial::device
