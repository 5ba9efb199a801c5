// What a person at a Force Dimension device feels: the driver, opened as a session opens it and
// driven by the servo, before a stand-in for the maker's library (fakes/maker_dhd.hpp). The
// stand-in's time is the servo's; nothing here depends on how fast the machine is.
#include "device/fakes/maker_dhd.hpp"

#include "device/fakes/loaded_fake.hpp"
#include "device/registry.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

namespace touchtrial {
namespace {

using device::DeviceFault;
using device::ServoEnd;
using fakes::eventually;
using fakes::kDelta3;
using fakes::kOmega3;
using fakes::kOmega7;
using fakes::kSigma7;
using fakes::MakerArm;
using fakes::MakerMoment;

struct LoadedMaker : fakes::LoadedFake<fakes::MakerDhdExports> {
  LoadedMaker() : LoadedFake(TOUCHTRIAL_MAKER_DHD, "maker_dhd_exports") {}
};

device::DeviceSettings settings_of_maker() {
  device::DeviceSettings settings;
  settings.dhd.library = TOUCHTRIAL_MAKER_DHD;
  return settings;
}

/// Steps that take a millisecond of real time or more, for a driver that looks at the clock: it
/// never sees less time than has passed for the device.
class UnhurriedClock final : public device::ServoClock {
 public:
  explicit UnhurriedClock(device::ServoClock& steps) : steps_(steps) {}
  [[nodiscard]] Time now() noexcept override { return steps_.now(); }
  void wait_until(Time time) noexcept override {
    std::this_thread::sleep_until(began_ + (time - first_));
    steps_.wait_until(time);
  }

 private:
  device::ServoClock& steps_;
  Time first_ = steps_.now();
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// A device on the table, opened, with a hand on it.
class Desk {
 public:
  explicit Desk(const MakerArm& arm = kOmega3) { fake.exports().plug(arm); }
  /// However a test ends, a device that was closed pushes nobody.
  ~Desk() {
    clock.reset();
    placed.reset();
    opened.reset();
    fake.exports().let_pass(1);
    CHECK(motors_rest());
    CHECK(fake->misuses == 0);
    CHECK(fake.calls().ends_with("close "));
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  void open() {
    opened = device::open_device("dhd", settings_of_maker());
    placed.emplace(*opened, device::PlanePlacement{});
  }
  /// Opens it, and waits until force may be sent.
  void open_ready() {
    open();
    REQUIRE(eventually([&] { return is_ready(); }));
    clock.emplace(fake.exports());
  }
  [[nodiscard]] bool is_ready() {
    device::DeviceSample sample;
    return opened->read(sample) == device::DeviceStatus::ok && sample.ready;
  }

  /// A trial without a fade, so that its end is like its middle.
  device::ServoReport feel(device::ForceSource& force, std::int64_t ticks,
                           const device::SafetyLimits& limits = {}) {
    NoSamples none;
    return device::run_servo(*placed, force, none,
                             {.limit_ticks = ticks, .fade_ticks = 0, .limits = limits}, *clock);
  }
  /// The same for a driver that looks at the clock.
  device::ServoReport feel_unhurried(device::ForceSource& force, std::int64_t ticks) {
    NoSamples none;
    UnhurriedClock unhurried(*clock);
    return device::run_servo(*placed, force, none, {.limit_ticks = ticks, .fade_ticks = 0},
                             unhurried);
  }
  /// Time without a trial.
  void wait_ms(int time) { REQUIRE(fake.exports().step(time)); }

  [[nodiscard]] std::vector<MakerMoment> last(std::size_t ms) const {
    std::vector<MakerMoment> moments = fake.exports().moments(ms);
    REQUIRE(moments.size() == ms);
    return moments;
  }
  /// \return the mean of what the hand carries, N
  [[nodiscard]] double carried_n(std::size_t ms) const {
    Vec3 sum_n;
    for (const MakerMoment& moment : last(ms)) sum_n = sum_n + moment.hand_n;
    return norm((1.0 / static_cast<double>(ms)) * sum_n);
  }
  /// \return what the tip pushes with, by axis: the median, as a machine that stands still for a
  ///   moment lets a force lapse
  [[nodiscard]] Vec3 push_n(std::size_t ms) const {
    const std::vector<MakerMoment> moments = last(ms);
    const auto median = [&](double Vec3::*axis) {
      std::vector<double> values;
      for (const MakerMoment& moment : moments) values.push_back(moment.tip_n.*axis);
      std::ranges::nth_element(values, values.begin() + values.size() / 2);
      return values[values.size() / 2];
    };
    return {median(&Vec3::x), median(&Vec3::y), median(&Vec3::z)};
  }
  [[nodiscard]] bool motors_rest() const {
    return std::ranges::none_of(
        last(1), [](const MakerMoment& moment) { return moment.motors_n != Vec3{}; });
  }

  LoadedMaker fake;
  std::unique_ptr<device::HapticDevice> opened;
  std::optional<device::PlacedDevice> placed;
  std::optional<fakes::SteppingClock<fakes::MakerDhdExports>> clock;
};

/// A press that grows within 0.3 s, so that the servo may engage, and a grating on top of it. Plane
/// frame.
class Press final : public device::ForceSource {
 public:
  explicit Press(Vec3 force_n, double grating_n = 0.0) : press_n_(force_n), grating_n_(grating_n) {}
  [[nodiscard]] Vec3 force_n(const device::DeviceSample& /*sample*/) noexcept override {
    const double share = std::min(1.0, ++ticks_ / 300.0);
    const double turn = 2.0 * std::numbers::pi * kGratingHz * 1e-3 * ticks_;
    return share * (press_n_ + Vec3{grating_n_ * std::sin(turn), 0.0, 0.0});
  }

  static constexpr double kGratingHz = 40.0;

 private:
  Vec3 press_n_;
  double grating_n_;
  double ticks_ = 0.0;
};

/// \return the amplitude of a grating along the maker's y: the median over tenths of a second
double felt_grating_n(const std::vector<MakerMoment>& moments) {
  constexpr std::size_t kWindow = 100;
  std::vector<double> amplitudes;
  for (std::size_t begin = 0; begin + kWindow <= moments.size(); begin += kWindow) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = begin; i < begin + kWindow; ++i) {
      const double turn =
          2.0 * std::numbers::pi * Press::kGratingHz * 1e-3 * static_cast<double>(i);
      sum += moments[i].tip_n.y * std::polar(1.0, -turn);
    }
    amplitudes.push_back(2.0 * std::abs(sum) / kWindow);
  }
  std::ranges::sort(amplitudes);
  return amplitudes[amplitudes.size() / 2];
}

TEST_CASE(
    "maker's dhd: a session goes on for seconds while nearly every reading is a guarded one") {
  Desk desk;
  desk.open_ready();
  ConstantForce nothing({});
  for (int trial = 0; trial < 2; ++trial) {
    const device::ServoReport report = desk.feel(nothing, 2000);
    CHECK(report.end == ServoEnd::time_limit);
    CHECK(report.fault == device::SafetyFault::none);
    CHECK(desk.opened->fault() == DeviceFault::none);
    desk.wait_ms(300);
  }
}

TEST_CASE("maker's dhd: positions arrive in the device frame, as fresh as the exchange before") {
  Desk desk;
  desk.fake->hand_m.set({0.01, 0.02, 0.03});
  desk.open_ready();
  ConstantForce nothing({});
  (void)desk.feel(nothing, 600);
  device::DeviceSample sample;
  REQUIRE(desk.opened->read(sample) == device::DeviceStatus::ok);
  const Vec3 tip_m = desk.fake->tip_m.get();
  CHECK(norm(sample.position_mm - 1e3 * Vec3{tip_m.y, tip_m.z, tip_m.x}) < 0.05);
}

TEST_CASE("maker's dhd: a hand carries nothing of the arm, in trials and between them") {
  const MakerArm arm = GENERATE(kOmega3, kDelta3, kOmega7, kSigma7);
  INFO(arm.name);
  Desk desk(arm);
  desk.open_ready();
  ConstantForce nothing({});
  REQUIRE(desk.feel(nothing, 800).end == ServoEnd::time_limit);
  CHECK(desk.carried_n(300) < 0.3);
  desk.wait_ms(800);
  CHECK(desk.carried_n(300) < 0.3);
  REQUIRE(desk.feel(nothing, 800).end == ServoEnd::time_limit);
  CHECK(desk.carried_n(300) < 0.3);
}

TEST_CASE("maker's dhd: a press and a grating are felt as asked for, whatever the arm weighs") {
  const MakerArm arm = GENERATE(kOmega3, kDelta3, kOmega7, kSigma7);
  INFO(arm.name);
  Desk desk(arm);
  desk.open_ready();
  Press press({0.0, 0.0, 0.7}, 0.05);
  REQUIRE(desk.feel(press, 1300).end == ServoEnd::time_limit);
  CHECK(desk.push_n(1000).z == Approx(0.7).epsilon(0.03));
  CHECK(felt_grating_n(desk.last(1000)) == Approx(0.05).epsilon(0.03));
}

TEST_CASE("maker's dhd: a press is felt along its own axis alone") {
  // In the plane frame, and in the maker's.
  const auto [asked, felt] = GENERATE(table<Vec3, Vec3>({{{0.6, 0.0, 0.0}, {0.0, 0.6, 0.0}},
                                                         {{0.0, 0.6, 0.0}, {0.6, 0.0, 0.0}},
                                                         {{0.0, 0.0, -0.6}, {0.0, 0.0, -0.6}},
                                                         {{0.5, -0.4, 0.3}, {-0.4, 0.5, 0.3}}}));
  Desk desk;
  desk.open_ready();
  Press press(asked);
  REQUIRE(desk.feel(press, 600).end == ServoEnd::time_limit);
  CHECK(norm(desk.push_n(200) - felt) < 0.02);
}

TEST_CASE("maker's dhd: the largest force is the study's, whatever the arm weighs") {
  const MakerArm arm = GENERATE(kOmega3, kSigma7);
  INFO(arm.name);
  Desk desk(arm);
  desk.open_ready();
  device::SafetyLimits limits;
  limits.max_force_n = 2.0;
  Press press({4.0, 0.0, 4.0});
  REQUIRE(desk.feel(press, 600, limits).end == ServoEnd::time_limit);
  const Vec3 felt_n = desk.push_n(200);
  CHECK(norm(felt_n) < 2.0 * 1.03);
  CHECK(felt_n.y == Approx(felt_n.z).epsilon(0.03));
  CHECK(felt_n.z > 0.7);
}

TEST_CASE("maker's dhd: a force that the motors cannot give whole is a limit and no fault") {
  MakerArm weak = kOmega3;
  weak.motors_n = weak.weight_n() + 1.0;
  Desk desk(weak);
  desk.open_ready();
  Press press({0.0, 0.0, 2.0});
  REQUIRE(desk.feel(press, 600).end == ServoEnd::time_limit);
  CHECK(desk.opened->fault() == DeviceFault::none);
  CHECK(desk.push_n(200).z < 1.1);
}

TEST_CASE(
    "maker's dhd: a device that is halted pushes no more within 50 ms, until it is re-armed") {
  const MakerArm arm = GENERATE(kOmega3, kSigma7);
  INFO(arm.name);
  Desk desk(arm);
  desk.open_ready();
  Press press({0.0, 0.0, 0.7});
  REQUIRE(desk.feel(press, 500).end == ServoEnd::time_limit);
  desk.opened->halt();
  desk.wait_ms(50);
  desk.fake->forceful_ms = 0;
  desk.wait_ms(500);
  CHECK(desk.fake->forceful_ms == 0);

  desk.opened->rearm();
  desk.wait_ms(500);
  CHECK(desk.is_ready());
  Press again({0.0, 0.0, 0.7});
  REQUIRE(desk.feel(again, 600).end == ServoEnd::time_limit);
  CHECK(desk.push_n(200).z == Approx(0.7).epsilon(0.03));
}

TEST_CASE("maker's dhd: a session opens it halted, and a person's consent is all that it needs") {
  Desk desk;
  desk.open();
  desk.opened->halt();
  REQUIRE(eventually([&] { return desk.opened->readiness() == device::DeviceReadiness::ready; }));
  desk.clock.emplace(desk.fake.exports());
  desk.wait_ms(50);
  desk.fake->forceful_ms = 0;
  desk.wait_ms(500);
  CHECK(desk.fake->forceful_ms == 0);
  CHECK(desk.opened->readiness() == device::DeviceReadiness::ready);
  desk.opened->rearm();
  desk.wait_ms(800);
  CHECK(desk.is_ready());
  CHECK(desk.carried_n(300) < 0.3);
}

/// \return the longest time in which the tip pushed with 1 N or more, ms
int longest_press_ms(const std::vector<MakerMoment>& moments) {
  int longest = 0;
  int lasted = 0;
  for (const MakerMoment& moment : moments) {
    lasted = norm(moment.tip_n) >= 1.0 ? lasted + 1 : 0;
    longest = std::max(longest, lasted);
  }
  return longest;
}

TEST_CASE("maker's dhd: encoders that stop under a press are a fault within half a second") {
  Desk desk;
  desk.open_ready();
  Press firm({0.0, 0.0, 1.2});
  ForceBy press([&, ticks = 0](const device::DeviceSample& sample) mutable {
    if (++ticks == 1000) desk.fake->frozen = true;
    return firm.force_n(sample);
  });
  // On a busy machine forces lapse, so the unbroken press may be late.
  const device::ServoReport report = desk.feel_unhurried(press, 10'000);
  CHECK(report.end == ServoEnd::fault);
  CHECK(report.fault == device::SafetyFault::frozen_encoders);
  CHECK(report.ticks > 1000);
  CHECK(longest_press_ms(desk.last(static_cast<std::size_t>(report.ticks) - 1000)) <= 500);
  desk.wait_ms(50);
  CHECK(desk.motors_rest());
}

TEST_CASE("maker's dhd: a hand that presses hard, and keeps as still as a hand can, is no fault") {
  Desk desk;
  desk.open_ready();
  Press press({0.0, 0.0, 2.0});
  REQUIRE(desk.feel_unhurried(press, 2000).end == ServoEnd::time_limit);
}

TEST_CASE("maker's dhd: an arm that stands bit-still in its holder is no fault") {
  Desk desk(kSigma7);
  desk.fake->clamped = true;
  desk.open_ready();
  ConstantForce nothing({});
  REQUIRE(desk.feel_unhurried(nothing, 1000).end == ServoEnd::time_limit);
  CHECK(desk.opened->fault() == DeviceFault::none);
}

TEST_CASE("maker's dhd: the device stops by itself when the host is dead") {
  Desk desk;
  desk.open_ready();
  Press press({0.0, 0.0, 0.7});
  REQUIRE(desk.feel(press, 500).end == ServoEnd::time_limit);
  REQUIRE_FALSE(desk.motors_rest());
  desk.fake.exports().let_pass(40);
  CHECK(desk.motors_rest());
  CHECK(desk.fake->off_cause == 3);
}

TEST_CASE("maker's dhd: a device that is unplugged in a trial ends it, and pushes nobody") {
  Desk desk;
  desk.open_ready();
  Press press({0.0, 0.0, 0.7});
  REQUIRE(desk.feel(press, 500).end == ServoEnd::time_limit);
  desk.fake->unplugged = true;
  Press again({0.0, 0.0, 0.7});
  const device::ServoReport report = desk.feel(again, 500);
  CHECK(report.end == ServoEnd::fault);
  CHECK(report.device_fault == DeviceFault::link_lost);
  CHECK(desk.motors_rest());
}

}  // namespace
}  // namespace touchtrial
