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
/// How long the checks wait where no time limit is judged.
constexpr double kTimeoutS = 5.0;
constexpr double kUntimedTimeoutS = 300.0;
/// How long the force must remain zero.
constexpr double kZeroLastsS = 0.050;
constexpr double kMaxSpeedMmS = 2000.0;
constexpr double kMaxPlaceMm = 10'000.0;
constexpr double kWorkspaceMargin = 0.2;
constexpr double kMaxRate = 10'000.0;
constexpr double kMaxStrength = 100.0;
constexpr double kMinRate = 500.0;

std::string force_words(Vec3 force_n) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) N", force_n.x, force_n.y, force_n.z);
}

/// \return the fault of a description; empty if none
std::string fault_in(const DeviceInfo& info) {
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
  const bool sound = is_within(size.x, 1.0, 2000.0) && is_within(size.y, 1.0, 2000.0) &&
                     is_within(size.z, 1.0, 2000.0);
  return sound ? "" : fmt::format("its workspace is {:g} x {:g} x {:g} mm", size.x, size.y, size.z);
}

/// Compares the velocity with the change of position over parts of 50 ms with motion.
class VelocityJudge {
 public:
  void add(const DeviceSample& sample, double time_s) noexcept {
    if (ticks_ == 0) {
      begin_ = sample.position_mm;
    } else {
      travelled_mm_ =
          travelled_mm_ + (0.5 * (time_s - last_s_)) * (sample.velocity_mm_s + last_velocity_mm_s_);
    }
    last_velocity_mm_s_ = sample.velocity_mm_s;
    last_s_ = time_s;
    if (++ticks_ <= kPart) return;
    judge(sample.position_mm - begin_);
    ticks_ = 0;
    travelled_mm_ = {};
  }
  [[nodiscard]] int parts() const noexcept { return parts_; }
  [[nodiscard]] int wrong() const noexcept { return wrong_; }

 private:
  static constexpr int kPart = 50;
  static constexpr double kMovedMm = 1.0;

  void judge(Vec3 moved_mm) noexcept {
    const double max_mm = std::max(norm(moved_mm), norm(travelled_mm_));
    if (max_mm < kMovedMm) return;
    ++parts_;
    if (norm(moved_mm - travelled_mm_) > 0.5 * max_mm) ++wrong_;
  }

  int ticks_ = 0;
  int parts_ = 0;
  int wrong_ = 0;
  Vec3 begin_;
  Vec3 travelled_mm_;
  Vec3 last_velocity_mm_s_;
  double last_s_ = 0.0;
};

bool is_inside(const Workspace& workspace, Vec3 position_mm) noexcept {
  const Vec3 size = workspace.max_mm - workspace.min_mm;
  const Vec3 middle = 0.5 * (workspace.max_mm + workspace.min_mm);
  const Vec3 off = position_mm - middle;
  const double share = 0.5 + kWorkspaceMargin;
  return std::abs(off.x) <= share * size.x && std::abs(off.y) <= share * size.y &&
         std::abs(off.z) <= share * size.z;
}

/// One run of the checks.
class ConformanceRun {
 public:
  ConformanceRun(const ConformanceSubject& subject, ServoClock& clock,
                 const ConformanceOptions& options)
      : subject_(subject), clock_(clock), options_(options), next_(clock.now()) {}

  std::vector<ConformanceCheck> run() {
    check_first_opening();
    if (!ended() && is_alive()) check_reopening();
    record_.leave_rest(is_stopped() ? "the check was stopped" : "an earlier check failed", false);
    return record_.checks(false);
  }

 private:
  // --- Time -------------------------------------------------------------------------------------

  /// The observed time, s. One tick counts for two at most, because during a pause of this thread
  /// the driver may have paused as well.
  [[nodiscard]] double now_s() const noexcept { return seconds_in(watched_); }
  [[nodiscard]] double clock_s() const noexcept { return seconds_in(clock_.now() - begun_); }
  [[nodiscard]] static double seconds_in(Time time) noexcept {
    return 1e-9 * static_cast<double>(time.count());
  }
  void wait_for_tick() noexcept {
    const Time before = clock_.now();
    next_ = std::max(next_ + kTick, before);
    clock_.wait_until(next_);
    watched_ += std::min(clock_.now() - before, 2 * kTick);
  }
  [[nodiscard]] bool is_stopped() const { return options_.stopped && options_.stopped(); }
  [[nodiscard]] bool ended() const { return lost_ || is_stopped(); }

  /// Ticks until a condition holds.
  /// \return false at the time limit, or if the run ends
  template <typename Holds>
  bool until(double limit_s, const Holds& holds) {
    const double end_s = now_s() + limit_s;
    for (;;) {
      if (holds()) return true;
      if (ended() || now_s() >= end_s) return false;
      wait_for_tick();
    }
  }
  /// Reads, and writes a given force, for this long.
  void pass_time(double time_s, const std::optional<Vec3>& force_n) {
    until(time_s, [&] {
      (void)read();
      if (force_n && !lost_) write(*force_n);
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
    if (status == DeviceStatus::fault) blame_for_fault();
    if (status == DeviceStatus::stopped) done_ = true;
    return sample;
  }
  void write(Vec3 force_n) {
    if (device_->write(force_n) == DeviceStatus::fault) blame_for_fault();
  }
  void blame_for_fault() {
    if (lost_) return;
    lost_ = true;
    const auto blame = subject_.blame ? subject_.blame(*device_) : std::nullopt;
    if (blame) {
      record_.fail(blame->id, blame->words);
    } else if (device_->fault() == DeviceFault::bad_data) {
      record_.fail(Id::values, "the driver reports invalid data from the device");
    } else {
      record_.fail(Id::staying,
                   "the driver reported a fault after " + fmt::format("{:.1f} s", now_s()));
    }
  }

  [[nodiscard]] std::optional<Vec3> motors() const {
    return subject_.motor_force_n ? subject_.motor_force_n() : std::nullopt;
  }
  [[nodiscard]] bool is_zero() const {
    const auto force_n = motors();
    return force_n && norm(*force_n) < ConformanceOptions::kZeroN;
  }
  [[nodiscard]] Vec3 push_n(int axis, double sign) const {
    const double strength = sign * std::min(ConformanceOptions::kPushN, info_.max_force_n);
    return {axis == 0 ? strength : 0.0, axis == 1 ? strength : 0.0, axis == 2 ? strength : 0.0};
  }

  // --- Checks -----------------------------------------------------------------------------------

  /// \return whether it opened and gave new readings
  [[nodiscard]] bool is_alive() const {
    return !record_.failed(Id::opening) && !record_.failed(Id::numbering);
  }

  void check_first_opening() {
    if (!open(Id::opening)) return;
    record_.pass(Id::opening);
    check_description();
    if (wait_until_ready()) {
      watch();
      if (!ended() && is_alive()) check_forces();
    }
    close();
    if (pushed_at_close_) check_closed();
  }

  void check_description() {
    info_ = device_->info();
    const std::string trouble = fault_in(info_);
    if (!trouble.empty()) {
      record_.fail(Id::description, trouble);
    } else {
      record_.pass(Id::description,
                   fmt::format("{:.1f} N peak, {:.2f} N continuous, {:.0f} Hz", info_.max_force_n,
                               info_.continuous_force_n, info_.max_rate_hz));
    }
  }

  /// \return whether there was a reading; else the check of their numbers fails
  bool wait_for_reading() {
    const bool came = until(timeout_s(), [&] { return read().sequence > 0 || lost_; });
    if (!came && !is_stopped()) {
      record_.fail(Id::numbering, fmt::format("no reading in {:.0f} s", timeout_s()));
    }
    return came && !lost_;
  }

  /// \return whether the device is ready
  bool wait_until_ready() {
    if (!wait_for_reading()) return false;
    Unready seen;
    const bool ready = until(options_.ready_limit_s, [&] {
      const DeviceSample sample = read();
      if (lost_ || sample.ready) return true;
      if (seen.readings == 0 && options_.advise) options_.advise(device_->readiness());
      // The driver itself must suppress this force.
      write(options_.pushes && motors() ? push_n(0, 1.0) : Vec3{});
      look_at_unready(seen);
      return lost_;
    });
    judge(seen);
    if (lost_ || is_stopped()) return false;
    if (!ready) {
      record_.leave_rest(
          fmt::format("the device was not ready within {:.0f} s", options_.ready_limit_s), false);
      return false;
    }
    // Resets the force to zero.
    pass_time(ConformanceOptions::kZeroWithinS, Vec3{});
    return !ended();
  }

  struct Unready {
    int readings = 0;
    bool has_motor_data = false;
    double largest_n = 0.0;
  };

  void look_at_unready(Unready& seen) const {
    ++seen.readings;
    const auto force_n = motors();
    // If it has become ready meanwhile, it may push.
    if (!force_n || device_->readiness() == DeviceReadiness::ready) return;
    seen.has_motor_data = true;
    seen.largest_n = std::max(seen.largest_n, norm(*force_n));
  }

  void judge(const Unready& seen) {
    if (seen.readings == 0) {
      record_.leave(Id::unready_zero, "it was ready at once");
    } else if (!seen.has_motor_data) {
      record_.leave(Id::unready_zero, not_observable());
    } else {
      judge_motors(Id::unready_zero, seen.largest_n);
    }
  }

  void judge_motors(Id id, double largest_n) {
    if (largest_n < ConformanceOptions::kZeroN) {
      record_.pass(id);
    } else {
      record_.fail(id, fmt::format("{:.2f} N on the motors", largest_n));
    }
  }

  [[nodiscard]] std::string not_observable() const {
    return "the motor commands cannot be observed";
  }

  void watch() {
    const double begin_s = clock_s();
    Watched seen;
    done_ = false;
    until(options_.seconds, [&] {
      const DeviceSample sample = read();
      if (!lost_ && !done_) look_at(sample, seen);
      write({});
      return lost_ || done_;
    });
    judge(seen, clock_s() - begin_s);
  }

  struct Watched {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    double last_new_s = 0.0;
    double longest_gap_s = 0.0;
    bool fell = false;
    std::string bad_value;
    bool left_workspace = false;
    Vec3 outside_mm;
    VelocityJudge velocity;
    bool has_motor_data = false;
    double largest_n = 0.0;
  };

  void look_at(const DeviceSample& sample, Watched& seen) const {
    const double time_s = now_s();
    if (seen.first == 0) {
      seen.first = seen.last = sample.sequence;
      seen.last_new_s = time_s;
    }
    if (sample.sequence < seen.last) seen.fell = true;
    seen.longest_gap_s = std::max(seen.longest_gap_s, time_s - seen.last_new_s);
    if (sample.sequence > seen.last) {
      seen.last = sample.sequence;
      seen.last_new_s = time_s;
    }
    look_at_values(sample, seen);
    if (seen.bad_value.empty()) seen.velocity.add(sample, clock_s());
    if (const auto force_n = motors()) {
      seen.has_motor_data = true;
      seen.largest_n = std::max(seen.largest_n, norm(*force_n));
    }
  }

  void look_at_values(const DeviceSample& sample, Watched& seen) const {
    const double place_mm = norm(sample.position_mm);
    const double speed_mm_s = norm(sample.velocity_mm_s);
    if (!(place_mm <= kMaxPlaceMm)) seen.bad_value = fmt::format("{:g} mm away", place_mm);
    if (!(speed_mm_s <= kMaxSpeedMmS)) seen.bad_value = fmt::format("{:g} mm/s", speed_mm_s);
    if (info_.workspace && !is_inside(*info_.workspace, sample.position_mm)) {
      seen.left_workspace = true;
      seen.outside_mm = sample.position_mm;
    }
  }

  void judge(const Watched& seen, double watched_s) {
    if (lost_ || is_stopped()) return;
    record_.pass(Id::staying);
    if (seen.fell) record_.fail(Id::numbering, "a number was smaller than the one before");
    if (seen.last == seen.first) {
      record_.fail(Id::numbering, fmt::format("no new reading in {:.1f} s", watched_s));
      return;
    }
    record_.pass(Id::numbering,
                 counted(static_cast<std::int64_t>(seen.last - seen.first), "new reading"));
    judge_values(seen);
    judge_times(seen, watched_s);
    if (!seen.has_motor_data) {
      record_.leave(Id::rest_zero, not_observable());
    } else {
      judge_motors(Id::rest_zero, seen.largest_n);
    }
  }

  void judge_values(const Watched& seen) {
    if (seen.bad_value.empty()) {
      record_.pass(Id::values);
    } else {
      record_.fail(Id::values, seen.bad_value);
    }
    if (!info_.workspace) {
      record_.leave(Id::workspace, "the device has no frame of its own");
    } else if (seen.left_workspace) {
      record_.fail(Id::workspace, fmt::format("at ({:.1f}, {:.1f}, {:.1f}) mm", seen.outside_mm.x,
                                              seen.outside_mm.y, seen.outside_mm.z));
    } else {
      record_.pass(Id::workspace);
    }
    const int parts = seen.velocity.parts();
    if (parts == 0) {
      record_.leave(Id::velocity, "the handle did not move; move it during the check");
    } else if (5 * seen.velocity.wrong() > parts) {
      record_.fail(Id::velocity, fmt::format("not so in {} of {} parts of 50 ms with motion",
                                             seen.velocity.wrong(), parts));
    } else {
      record_.pass(Id::velocity, counted(parts, "part") + " of 50 ms with motion");
    }
  }

  void judge_times(const Watched& seen, double watched_s) {
    const double rate_hz = static_cast<double>(seen.last - seen.first) / watched_s;
    const double needed_hz = std::max(kMinRate, 0.5 * info_.max_rate_hz);
    const std::string rate = fmt::format("{:.0f} new readings a second", rate_hz);
    judge_time(Id::rate, rate_hz >= needed_hz, rate);
    judge_time(Id::gaps, seen.longest_gap_s <= ConformanceOptions::kMaxGapS + 1e-9,
               fmt::format("oldest {:.1f} ms", 1e3 * seen.longest_gap_s));
  }

  void judge_time(Id id, bool good, const std::string& finding) {
    if (!options_.judges_time) {
      record_.leave(id, finding + "; not judged");
    } else if (good) {
      record_.pass(id, finding);
    } else {
      record_.fail(id, finding);
    }
  }

  void check_forces() {
    if (!options_.pushes || !motors()) {
      const std::string reason = options_.pushes ? not_observable() : "no force was permitted";
      for (const Id id : {Id::pushing, Id::lapsing, Id::halting, Id::rearming, Id::closing_zero}) {
        record_.leave(id, reason);
      }
      return;
    }
    check_pushing();
    check_force_lifetime();
    check_halting();
    // Leaves a force on, to test closing.
    if (!ended()) pushed_at_close_ = push(push_n(1, 1.0), [&] { return !is_zero(); });
  }

  /// Writes a force until the motors meet a condition.
  /// \return false at the time limit
  template <typename Holds>
  bool push(Vec3 force_n, const Holds& holds, double limit_s) {
    return until(limit_s, [&] {
      (void)read();
      write(force_n);
      return holds();
    });
  }
  template <typename Holds>
  bool push(Vec3 force_n, const Holds& holds) {
    return push(force_n, holds, timeout_s());
  }

  void check_pushing() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Vec3 sent_n = push_n(axis, sign);
        const double allowed_n = 0.05 * norm(sent_n) + ConformanceOptions::kZeroN;
        const bool arrived = push(sent_n, [&] {
          const auto force_n = motors();
          return force_n && norm(*force_n - sent_n) < allowed_n;
        });
        if (arrived || ended()) continue;
        const auto force_n = motors();
        record_.fail(Id::pushing, "told " + force_words(sent_n) + ", the motors had " +
                                      (force_n ? force_words(*force_n) : "nothing known"));
        return;
      }
    }
    if (!ended()) record_.pass(Id::pushing, "0.3 N along each axis, both ways");
  }

  /// The time until the motors are without force.
  std::optional<double> time_to_zero(const std::function<void()>& meanwhile) {
    const double begin_s = now_s();
    const bool zero = until(timeout_s(), [&] {
      (void)read();
      if (meanwhile) meanwhile();
      return is_zero();
    });
    if (!zero) return std::nullopt;
    return now_s() - begin_s;
  }

  /// \return whether the force ended in time
  bool judge_zero(Id id, const std::optional<double>& after_s) {
    if (ended()) return false;
    if (!after_s) {
      record_.fail(id, "a force stays on the motors");
      return false;
    }
    judge_time(id, *after_s <= ConformanceOptions::kZeroWithinS,
               fmt::format("after {:.0f} ms", 1e3 * *after_s));
    return true;
  }

  void check_force_lifetime() {
    if (ended()) return;
    if (!push(push_n(0, 1.0), [&] { return !is_zero(); })) return leave_without_force(Id::lapsing);
    const bool zero = judge_zero(Id::lapsing, time_to_zero({}));
    // Waits for a lasting zero before the next check.
    if (zero) pass_time(kZeroLastsS, std::nullopt);
  }

  void leave_without_force(Id id) {
    if (!ended()) record_.leave(id, "no force came that could have ended");
  }

  void check_halting() {
    if (ended()) return;
    const Vec3 force_n = push_n(2, 1.0);
    if (!push(force_n, [&] { return !is_zero(); })) {
      leave_without_force(Id::halting);
      return leave_without_force(Id::rearming);
    }
    device_->halt();
    const bool zero = judge_zero(Id::halting, time_to_zero([&] { write(force_n); }));
    if (!zero) {
      device_->rearm();
      return;
    }
    if (push(
            force_n, [&] { return !is_zero(); }, kZeroLastsS)) {
      record_.fail(Id::halting, "a force came back before anybody re-armed");
    }
    device_->rearm();
    if (push(force_n, [&] { return !is_zero(); })) {
      record_.pass(Id::rearming);
    } else if (!ended()) {
      record_.fail(Id::rearming, "no force came any more");
    }
  }

  void check_closed() {
    const bool zero = until(kZeroLastsS, [&] { return is_zero(); });
    if (zero) {
      record_.pass(Id::closing_zero);
    } else {
      const auto force_n = motors();
      record_.fail(Id::closing_zero, (force_n ? force_words(*force_n) : std::string("a force")) +
                                         " is left on the motors");
    }
  }

  /// \return whether there was a reading after this number
  bool has_new_reading(std::uint64_t& last) {
    return until(timeout_s(),
                 [&] {
                   const DeviceSample sample = read();
                   write({});
                   if (lost_ || sample.sequence <= last) return lost_;
                   last = sample.sequence;
                   return true;
                 }) &&
           !lost_;
  }

  void check_opening_twice() {
    if (!subject_.can_open_twice) {
      return record_.leave(Id::opening_twice, "the rig cannot be asked");
    }
    std::uint64_t last = 0;
    if (!has_new_reading(last)) return;
    std::string finding = "the second opening works";
    try {
      const std::unique_ptr<HapticDevice> second = subject_.open();
      wait_for_tick();
    } catch (const Error& error) {
      finding = std::string("refused: ") + error.what();
    }
    // Of three ticks, because the first reading may have been in transit.
    for (int i = 0; i < 3; ++i) {
      if (ended_by_second(last)) {
        return record_.fail(Id::opening_twice, "the first opening gave no more readings");
      }
    }
    record_.pass(Id::opening_twice, finding);
  }

  bool ended_by_second(std::uint64_t& last) {
    DeviceSample sample;
    const bool reads = until(timeout_s(), [&] {
      const DeviceStatus status = device_->read(sample);
      if (status == DeviceStatus::fault) return true;
      (void)device_->write({});
      return sample.sequence > last;
    });
    const bool continues = reads && device_->fault() == DeviceFault::none;
    last = sample.sequence;
    return !continues && !is_stopped();
  }

  void check_reopening() {
    const DeviceInfo first = info_;
    for (int i = 0; i < options_.reopenings && !is_stopped(); ++i) {
      if (!open(Id::reopening)) return;
      const DeviceInfo again = device_->info();
      std::uint64_t last = 0;
      const bool reads = has_new_reading(last);
      if (i == 0 && reads && !is_stopped()) check_opening_twice();
      close();
      if (lost_ || is_stopped()) return;
      if (!reads)
        return record_.fail(Id::reopening, "the device gives no readings when opened again");
      if (again.serial != first.serial || again.model != first.model) {
        return record_.fail(Id::reopening, "it is '" + again.model + "' '" + again.serial +
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
  Time begun_ = clock_.now();
  Time watched_{};
  ConformanceRecord record_;
  std::unique_ptr<HapticDevice> device_;
  std::shared_ptr<void> guard_;
  DeviceInfo info_;
  bool lost_ = false;  ///< a fault ended the device
  bool done_ = false;  ///< the device has no more motion
  bool pushed_at_close_ = false;
};

}  // namespace

std::vector<ConformanceCheck> check_conformance(const ConformanceSubject& subject,
                                                ServoClock& clock,
                                                const ConformanceOptions& options) {
  return ConformanceRun(subject, clock, options).run();
}

}  // namespace touchtrial::device
