// The chain and the servo under hostile forces, devices, limits and time: which forces reach a
// hand.
#include "core/random.hpp"
#include "device/safety/safety_chain.hpp"
#include "device/servo/servo.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace device;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Mostly sensible; now and then a number that no force or position should be.
double hostile_number(RandomStream& random, double size) {
  switch (random.below(40)) {
    case 0:
      return kNaN;
    case 1:
      return random.below(2) == 0 ? kInfinity : -kInfinity;
    case 2:
      return 1e300;
    case 3:
      return random.uniform(-1e6, 1e6);
    case 4:
      return std::numeric_limits<double>::denorm_min();
    default:
      return random.uniform(-size, size);
  }
}

Vec3 hostile_force_n(RandomStream& random) {
  // Small ones open the gate; huge ones alternate in sign.
  const double size = random.below(3) == 0 ? 0.2 : 30.0;
  if (random.below(4) != 0) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  }
  return {hostile_number(random, size), hostile_number(random, size), 0.0};
}

/// A hand that strokes, on a device that fails in many ways.
class HostileReadings {
 public:
  explicit HostileReadings(RandomStream& random) : random_(random) {}

  DeviceSample next() {
    mood_ = random_.below(60) == 0 ? random_.below(6) : mood_;
    const bool is_stuck = mood_ == 1;
    if (!is_stuck) {
      ++good_.sequence;
      good_.position_mm.x += random_.uniform(-0.2, 0.2);
    }
    DeviceSample sample = good_;
    if (mood_ == 2) sample.ready = random_.below(2) == 0;
    if (mood_ == 3 && random_.below(10) == 0) sample.position_mm.y = hostile_number(random_, 100.0);
    if (mood_ == 4 && random_.below(10) == 0) sample.velocity_mm_s.z = hostile_number(random_, 3e3);
    if (mood_ == 5) mood_ = 0;
    return sample;
  }

 private:
  RandomStream& random_;
  DeviceSample good_;
  std::uint64_t mood_ = 0;
};

SafetyLimits hostile_limits(RandomStream& random) {
  SafetyLimits limits{.max_force_n = random.uniform(0.5, 8.0)};
  limits.max_slew_n_per_s = limits.max_force_n * random.uniform(21.0, 2000.0);
  limits.continuous_force_n = random.below(2) == 0 ? 0.0 : random.uniform(0.1, 2.0);
  limits.thermal_budget_s = random.uniform(0.01, 20.0);
  limits.ramp_up_s = random.uniform(0.0, 0.05);
  limits.max_support_n = random.uniform(0.0, 4.0);
  if (random.below(10) != 0) return limits;
  double SafetyLimits::*const members[] = {
      &SafetyLimits::max_force_n,      &SafetyLimits::continuous_force_n,
      &SafetyLimits::thermal_budget_s, &SafetyLimits::max_slew_n_per_s,
      &SafetyLimits::max_speed_mm_s,   &SafetyLimits::engage_force_n,
      &SafetyLimits::ramp_up_s,        &SafetyLimits::stale_s,
      &SafetyLimits::frozen_s,         &SafetyLimits::max_support_n};
  limits.*members[random.below(10)] = random.below(2) == 0 ? kNaN : -1.0;
  return limits;
}

/// Checks every force against the chain's promises, and names the first broken one.
class Judge {
 public:
  /// \param support_n  the most that a force may have beside its rendered part
  Judge(const SafetyLimits& limits, double tick_s, double support_n)
      : limits_(limits), tick_s_(tick_s), support_n_(support_n) {}

  void see(Vec3 force_n, bool is_fault) {
    const double slew_n = limits_.max_slew_n_per_s * tick_s_ + 2.0 * support_n_;
    if (!is_finite(force_n)) broken("not finite");
    if (!are_valid(limits_) && force_n != Vec3{}) broken("force under unsound limits");
    if (are_valid(limits_) && norm(force_n) > (limits_.max_force_n + support_n_) * kRounding)
      broken("norm");
    if (is_fault && force_n != Vec3{}) broken("force under a fault");
    const bool drops = is_fault && force_n == Vec3{};
    if (!drops && norm(force_n - last_n_) > slew_n * kRounding && are_valid(limits_))
      broken("slew");
    last_n_ = force_n;
    forces_ += force_n == Vec3{} ? 0 : 1;
  }
  void broken(const std::string& what) {
    if (first_broken.empty()) first_broken = what;
  }
  [[nodiscard]] std::int64_t forces() const { return forces_; }

  std::string first_broken;

 private:
  static constexpr double kRounding = 1.0 + 1e-9;
  const SafetyLimits limits_;
  double tick_s_;
  double support_n_;
  Vec3 last_n_;
  std::int64_t forces_ = 0;
};

bool must_fault(Vec3 force_n, const DeviceSample& sample) {
  return !is_finite(force_n) || !is_finite(sample.position_mm) || !is_finite(sample.velocity_mm_s);
}

/// Further promises: latched until re-armed, closed until small, zero on a device that is not
/// ready, at rest, or stuck.
class ChainRun {
 public:
  ChainRun(std::uint64_t seed, double rate_hz)
      : random_(seed, "hostile chain"),
        limits_(hostile_limits(random_)),
        judge_(limits_, 1.0 / rate_hz, 0.0),
        chain_(limits_, 1.0 / rate_hz),
        readings_(random_),
        has_support_(seed % 2 == 1),
        stale_ticks_(limits_.stale_s * rate_hz) {}

  std::int64_t run(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) step();
    INFO(judge_.first_broken);
    CHECK(judge_.first_broken.empty());
    return judge_.forces();
  }

 private:
  void step() {
    if (chain_.faulted() && random_.below(8) == 0) {
      chain_.rearm();
      may_pass_ = false;
    }
    const Vec3 force_n = hostile_force_n(random_);
    const DeviceSample sample = readings_.next();
    const std::int64_t ticks = random_.below(30) == 0 ? 46 : 1;
    const Vec3 support_n = has_support_ ? hostile_force_n(random_) : Vec3{};
    const bool was_faulted = chain_.faulted() || !is_finite(support_n);
    const SafeForce safe = chain_.check(force_n, sample, ticks, support_n);
    const bool is_fault = safe.verdict == SafetyVerdict::fault;
    judge_.see(safe.rendered_n, is_fault);
    const double carried_n = norm(safe.force_n - safe.rendered_n);
    if (!(carried_n <= 1e-9 + std::max(0.0, limits_.max_support_n))) judge_.broken("support");
    if (is_fault && safe.force_n != Vec3{}) judge_.broken("support under a fault");
    hold(force_n, sample, safe.force_n, is_fault, was_faulted);
  }

  void hold(Vec3 force_n, const DeviceSample& sample, Vec3 sent_n, bool is_fault,
            bool was_faulted) {
    const bool passes = sent_n != Vec3{};
    if (norm(force_n) <= limits_.engage_force_n && sample.ready && !is_fault) may_pass_ = true;
    if (passes && !may_pass_) judge_.broken("gate");
    if (passes && !sample.ready) judge_.broken("force while not ready");
    if ((must_fault(force_n, sample) || was_faulted) && !is_fault) judge_.broken("latch");
    if (passes && norm(sample.velocity_mm_s) > limits_.max_speed_mm_s) judge_.broken("speed");
    stuck_ticks_ = sample.sequence == sequence_ ? stuck_ticks_ + 1 : 0;
    sequence_ = sample.sequence;
    if (!may_pass_ || is_fault) stuck_ticks_ = 0;
    if (passes && stuck_ticks_ > stale_ticks_) judge_.broken("stale");
    const double jump_mm = norm(sample.position_mm - last_mm_);
    if (passes && had_force_ && jump_mm > 300.0) judge_.broken("jump");
    last_mm_ = sample.position_mm;
    had_force_ = passes;
  }

  RandomStream random_;
  SafetyLimits limits_;
  Judge judge_;
  SafetyChain chain_;
  HostileReadings readings_;
  bool has_support_;
  double stale_ticks_;
  bool may_pass_ = false;
  bool had_force_ = false;
  double stuck_ticks_ = 0.0;
  std::uint64_t sequence_ = 0;
  Vec3 last_mm_;
};

TEST_CASE(
    "whatever the input, the chain passes forces that are finite, limited, smooth, and zero on "
    "faults") {
  std::int64_t forces = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    CAPTURE(seed);
    const double rate_hz = std::vector{1000.0, 4000.0, 10'000.0}[seed % 3];
    forces += ChainRun(seed, rate_hz).run(400);
  }
  CHECK(forces > 50'000);
}

class HostileDevice final : public HapticDevice {
 public:
  HostileDevice(RandomStream& random, double max_force_n, bool has_support)
      : random_(random), readings_(random), max_force_n_(max_force_n), has_support_(has_support) {}

  [[nodiscard]] DeviceInfo info() const override {
    DeviceInfo info{"hostile", "", max_force_n_, true};
    info.max_support_n = kMaxSupportN;
    info.has_encoders = true;
    return info;
  }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override {
    sample = readings_.next();
    return random_.below(500) == 0 ? DeviceStatus::fault : DeviceStatus::ok;
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override {
    written.push_back(force_n);
    return random_.below(1000) == 0 ? DeviceStatus::fault : DeviceStatus::ok;
  }
  [[nodiscard]] Vec3 support_force_n(const DeviceSample&) noexcept override {
    if (!has_support_) return {};
    return random_.below(300) == 0 ? hostile_force_n(random_)
                                   : Vec3{0.0, random_.uniform(-3.0, 3.0), 1.0};
  }
  void halt() noexcept override { halted = true; }
  void rearm() noexcept override {}

  static constexpr double kMaxSupportN = 2.0;
  std::vector<Vec3> written;
  bool halted = false;

 private:
  RandomStream& random_;
  HostileReadings readings_;
  double max_force_n_;
  bool has_support_;
};

/// Small at first, so that a run engages; then hostile, and with requests to the servo.
class HostileForce final : public ForceSource {
 public:
  HostileForce(RandomStream& random, ServoControl& control) : random_(random), control_(control) {}

  [[nodiscard]] Vec3 force_n(const DeviceSample&) noexcept override {
    if (++calls_ < 20) return {0.1, 0.0, 0.0};
    switch (random_.below(2000)) {
      case 0:
        control_.comfort_stop();
        break;
      case 1:
        control_.emergency_stop();
        break;
      case 2:
        control_.stall();
        break;
      default:
        break;
    }
    if (random_.below(100) == 0) return hostile_force_n(random_);
    return {random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0)};
  }

 private:
  RandomStream& random_;
  ServoControl& control_;
  int calls_ = 0;
};

/// Stands still now and then.
class HostileClock final : public ServoClock {
 public:
  explicit HostileClock(RandomStream& random) : random_(random) {}
  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    now_ = std::max(now_, time);
    if (random_.below(50) == 0) now_ += std::chrono::microseconds(random_.below(30'000));
  }

 private:
  RandomStream& random_;
  Time now_{};
};

class CountedSamples final : public SampleSink {
 public:
  void record(const ServoSample&) noexcept override { ++count; }
  std::int64_t count = 0;
};

TEST_CASE(
    "whatever the input, the servo writes forces that are finite, limited and smooth, and zero "
    "last") {
  std::int64_t forces = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, "hostile servo");
    ServoOptions options{.limit_ticks = 600, .fade_ticks = 100, .limits = hostile_limits(random)};
    options.rate_hz = random.uniform(1000.0, 10'000.0);
    HostileDevice device(random, random.uniform(0.5, 8.0), seed % 2 == 1);
    ServoControl control;
    HostileForce force(random, control);
    CountedSamples sink;
    HostileClock clock(random);
    ServoHooks hooks{.control = &control};
    const ServoReport report = device::run_servo(device, force, sink, options, clock, hooks);
    Judge judge(limits_on(device.info(), options.limits), 1.0 / options.rate_hz,
                HostileDevice::kMaxSupportN);
    for (std::size_t i = 0; i + 1 < device.written.size(); ++i) judge.see(device.written[i], false);
    forces += judge.forces();
    INFO(judge.first_broken);
    CHECK(judge.first_broken.empty());
    CHECK(device.written.back() == Vec3{});
    CHECK((report.end == ServoEnd::fault) == (report.fault != SafetyFault::none));
    CHECK(device.halted == (report.end == ServoEnd::fault));
    CHECK(report.ticks == sink.count);
  }
  CHECK(forces > 20'000);
}

}  // namespace
}  // namespace touchtrial
