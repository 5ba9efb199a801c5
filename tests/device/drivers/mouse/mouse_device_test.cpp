#include "device/drivers/mouse/mouse_device.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "device/drivers/mouse/pointer_exchange.hpp"
#include "device/drivers/mouse/scripted_pointer.hpp"
#include "device/drivers/registry.hpp"
#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"

#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

using namespace device;
using namespace std::chrono_literals;

/// One run of a script, tick by tick, without a safety chain, to test the device's own laws.
std::vector<ServoSample> run(const ScriptedPointer::Script& script, ForceSource& force,
                             std::int64_t ticks, double rate_hz = 1000.0) {
  VirtualClock clock;
  ScriptedPointer pointer(clock, script);
  MouseDevice mouse(pointer, clock);
  std::vector<ServoSample> samples;
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    clock.wait_until(ServoClock::Time(std::llround(static_cast<double>(tick) * 1e9 / rate_hz)));
    DeviceSample sample;
    REQUIRE(mouse.read(sample) == DeviceStatus::ok);
    samples.push_back({sample.position_mm, force.force_n(sample), tick});
    REQUIRE(mouse.write(samples.back().force_n) == DeviceStatus::ok);
  }
  return samples;
}

PointerState at(double x_mm, double y_mm, bool pressed = false) {
  return {{x_mm, y_mm}, pressed, false, 0};
}

TEST_CASE("on a flat plane the stylus rests exactly where the pointer does") {
  FlatWall wall;
  const bool pressed = GENERATE(false, true);
  const auto script = [=](double time_s) {
    return at(10.0 + 40.0 * std::min(time_s, 0.5), 25.0, pressed);
  };
  const auto samples = run(script, wall, 1500);
  CHECK(samples.front().position_mm.x == 10.0);
  CHECK(std::abs(samples.back().position_mm.x - 30.0) < 1e-9);
  CHECK(samples.back().position_mm.y == 25.0);
}

TEST_CASE("on a flat plane the moving stylus trails its pointer by no more than 25 ms") {
  FlatWall wall;
  const double speed_mm_s = 100.0;
  const auto script = [=](double time_s) { return at(speed_mm_s * time_s, 0.0, true); };
  for (const ServoSample& sample : run(script, wall, 2000)) {
    const double hand_mm = speed_mm_s * static_cast<double>(sample.tick) * 1e-3;
    CHECK(sample.position_mm.x <= hand_mm + 1e-12);
    CHECK(sample.position_mm.x >= hand_mm - 0.025 * speed_mm_s);
  }
}

TEST_CASE("a steady tangential force displaces the stylus by four millimetres for 0.1 N") {
  ConstantForce force({0.06, -0.08, 0.0});
  const auto samples = run([](double) { return at(50.0, 50.0); }, force, 1000);
  CHECK(samples.back().position_mm.x == Approx(50.0 + 2.4).margin(1e-6));
  CHECK(samples.back().position_mm.y == Approx(50.0 - 3.2).margin(1e-6));
}

TEST_CASE("no force displaces the stylus beyond its bound, however it alternates") {
  ForceBy force([tick = 0](const DeviceSample&) mutable {
    return Vec3{++tick / 37 % 2 == 0 ? -3.0 : 3.0, 1.0, 0.0};
  });
  const MouseOptions defaults;
  const double bound_mm = defaults.max_pull_n / defaults.pull_n_per_mm;
  double farthest_mm = 0.0;
  for (const ServoSample& sample : run([](double) { return at(0.0, 0.0); }, force, 5000)) {
    farthest_mm = std::max(farthest_mm, norm(Vec2{sample.position_mm.x, sample.position_mm.y}));
  }
  CHECK(farthest_mm <= bound_mm + 1e-9);
  CHECK(farthest_mm > 0.5 * bound_mm);
}

TEST_CASE("the stylus returns to the pointer when the force is gone, without passing it") {
  ForceBy force([tick = 0](const DeviceSample&) mutable {
    return Vec3{++tick < 300 ? 0.1 : 0.0, 0.0, 0.0};
  });
  const auto samples = run([](double) { return at(5.0, 5.0); }, force, 1000);
  CHECK(samples[299].position_mm.x > 8.9);
  for (const ServoSample& sample : samples) CHECK(sample.position_mm.x >= 5.0);
  CHECK(std::abs(samples.back().position_mm.x - 5.0) < 1e-9);
}

TEST_CASE(
    "a force that grows against the motion slows the stylus, one that grows with it speeds it") {
  // Uphill or downhill from 20 mm on: the force along x changes by 0.02 N/mm.
  const double rise_n_per_mm = GENERATE(-0.01, 0.02);
  ForceBy slope([=](const DeviceSample& sample) {
    return Vec3{-rise_n_per_mm * std::clamp(sample.position_mm.x - 20.0, 0.0, 15.0), 0.0, 0.0};
  });
  const auto script = [](double time_s) { return at(20.0 * time_s, 0.0); };
  const auto samples = run(script, slope, 1500);
  const double speed_mm_s = (samples[1300].position_mm.x - samples[1200].position_mm.x) / 0.1;
  CHECK(speed_mm_s == Approx(20.0 / (1.0 + rise_n_per_mm / 0.025)).epsilon(0.02));
}

TEST_CASE("pressing lands smoothly on the wall and holds 0.7 N, releasing lifts off") {
  FlatWall wall;
  const double rate_hz = GENERATE(1000.0, 4000.0, 10'000.0);
  const auto script = [](double time_s) { return at(0.0, 0.0, time_s >= 0.2 && time_s < 1.2); };
  const auto samples = run(script, wall, std::llround(2.0 * rate_hz), rate_hz);
  const auto tick_at = [&](double time_s) { return static_cast<std::size_t>(time_s * rate_hz); };
  double steepest_n_per_s = 0.0;
  double greatest_n = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double change_n = samples[i].force_n.z - samples[i - 1].force_n.z;
    steepest_n_per_s = std::max(steepest_n_per_s, std::abs(change_n) * rate_hz);
    greatest_n = std::max(greatest_n, samples[i].force_n.z);
  }
  CHECK(samples[tick_at(0.2)].force_n.z == 0.0);
  CHECK(samples[tick_at(1.15)].force_n.z == Approx(0.7).margin(1e-3));
  CHECK(samples[tick_at(1.15)].position_mm.z == Approx(-0.7 / 0.4).margin(0.01));
  CHECK(samples.back().force_n.z == 0.0);
  CHECK(samples.back().position_mm.z == Approx(MouseOptions{}.hover_mm).margin(1e-3));
  CHECK(greatest_n < 0.8);
  CHECK(steepest_n_per_s < 25.0);
}

TEST_CASE("a hand that was down at the end of a plane is up at the start of the next") {
  VirtualClock clock;
  bool pressed = true;
  ScriptedPointer pointer(clock, [&](double) { return at(20.0, 20.0, pressed); });
  MouseDevice mouse(pointer, clock);
  FlatWall wall;
  DeviceSample sample;
  const auto feel = [&](int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      clock.wait_until(clock.now() + 1ms);
      REQUIRE(mouse.read(sample) == DeviceStatus::ok);
      REQUIRE(mouse.write(wall.force_n(sample)) == DeviceStatus::ok);
    }
  };
  feel(500);
  CHECK(sample.position_mm.z < 0.0);
  pressed = GENERATE(false, true);
  clock.wait_until(clock.now() + 5s);  // nobody reads the device
  feel(1);
  CHECK(sample.position_mm.z == Approx(MouseOptions{}.hover_mm).margin(0.1));
  feel(500);
  CHECK((sample.position_mm.z < 0.0) == pressed);
}

TEST_CASE("without a wall a pressing hand goes no deeper than its reach") {
  ConstantForce none({});
  const auto samples = run([](double) { return at(0.0, 0.0, true); }, none, 2000);
  CHECK(samples.back().position_mm.z == -MouseDevice::kReachMm);
}

TEST_CASE("the stylus is stable on stiff walls and textures at every rate of the servo") {
  ForceBy stiff([](const DeviceSample& sample) -> Vec3 {
    const Vec3 p = sample.position_mm;
    if (p.z >= 0.0) return {};
    const auto valley = [](double x) { return -10.0 * (x - std::round(x)) / 5.0; };
    return {valley(p.x), valley(p.y), -10.0 * p.z};
  });
  const double rate_hz = GENERATE(1000.0, 10'000.0);
  const auto script = [](double) { return at(10.3, 10.4, true); };
  const auto samples = run(script, stiff, std::llround(3.0 * rate_hz), rate_hz);
  const Vec3 last = samples.back().position_mm;
  const Vec3 before = samples[samples.size() - 50].position_mm;
  CHECK(norm(last - before) < 1e-6);
  CHECK(last.z == Approx(-0.07).margin(1e-3));
}

TEST_CASE("no pointer and no force moves the stylus faster than the servo lets a hand move") {
  RandomStream random(7, "hostile pointer");
  const auto either = [&random] { return random.uniform() < 0.5 ? -3.0 : 3.0; };
  ForceBy force([&](const DeviceSample&) { return Vec3{either(), either(), 0.0}; });
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double time_s) {
    return at(std::fmod(time_s, 0.4) < 0.2 ? -500.0 : 500.0, 0.0, true);
  });
  MouseDevice mouse(pointer, clock);
  DeviceSample sample;
  double fastest_mm_s = 0.0;
  for (int tick = 0; tick < 20'000; ++tick) {
    clock.wait_until(tick * 1ms);
    REQUIRE(mouse.read(sample) == DeviceStatus::ok);
    fastest_mm_s = std::max(fastest_mm_s, norm(sample.velocity_mm_s));
    REQUIRE(mouse.write(force.force_n(sample)) == DeviceStatus::ok);
  }
  CHECK(fastest_mm_s < 1700.0);
  CHECK(fastest_mm_s > 400.0);
}

TEST_CASE("readings are numbered even while the pointer rests, and the window gets them") {
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double) { return at(3.0, 4.0, true); });
  MouseDevice mouse(pointer, clock);
  DeviceSample sample;
  for (std::uint64_t reading = 1; reading <= 3; ++reading) {
    REQUIRE(mouse.read(sample) == DeviceStatus::ok);
    CHECK(sample.sequence == reading);
    CHECK(sample.buttons == 1U);
    CHECK(pointer.shown.sequence == reading);
    CHECK(pointer.shown.position_mm == Vec2{3.0, 4.0});
  }
}

TEST_CASE("while the window hangs the hand lets go, and the stylus stays where it was") {
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double) { return at(3.0, 4.0, true); });
  pointer.hangs_after = 100;
  MouseDevice mouse(pointer, clock);
  FlatWall wall;
  KeptSamples kept;
  CHECK(device::run_servo(mouse, wall, kept, {.limit_ticks = 2500}, clock).end ==
        ServoEnd::time_limit);
  CHECK(kept.samples[1400].force_n.z > 0.69);
  CHECK(kept.samples[2400].force_n.z == 0.0);
  CHECK(kept.samples[2400].position_mm.x == 3.0);
}

TEST_CASE("a closed window is a lost link, and the last force is zero") {
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double time_s) {
    PointerState state = at(0.0, 0.0, true);
    state.closed = time_s >= 0.5;
    return state;
  });
  MouseDevice mouse(pointer, clock);
  FlatWall wall;
  KeptSamples kept;
  const ServoReport report = device::run_servo(mouse, wall, kept, {.limit_ticks = 1000}, clock);
  CHECK(report.end == ServoEnd::fault);
  CHECK(report.device_fault == DeviceFault::link_lost);
  CHECK(report.ticks == 500);
}

TEST_CASE("halt makes the hand let go and takes the force from the stylus until it is re-armed") {
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double) { return at(0.0, 0.0, true); });
  MouseDevice mouse(pointer, clock);
  DeviceSample sample;
  const auto tick_for = [&](ServoClock::Time time) {
    for (const auto end = clock.now() + time; clock.now() < end;
         clock.wait_until(clock.now() + 1ms)) {
      REQUIRE(mouse.read(sample) == DeviceStatus::ok);
      REQUIRE(mouse.write({0.1, 0.0, std::max(0.0, -0.4 * sample.position_mm.z)}) ==
              DeviceStatus::ok);
    }
  };
  tick_for(1s);
  CHECK(sample.position_mm.x == Approx(4.0).margin(1e-6));
  CHECK(sample.position_mm.z < -1.7);
  mouse.halt();
  tick_for(1s);
  CHECK(sample.position_mm.x == Approx(0.0).margin(1e-6));
  CHECK(sample.position_mm.z > 1.9);
  mouse.rearm();
  tick_for(1s);
  CHECK(sample.position_mm.z < -1.7);
}

TEST_CASE(
    "a mouse is not ready before its window has begun, and takes a force that is not a number as "
    "zero") {
  VirtualClock clock;
  PointerExchange exchange;
  MouseDevice mouse(exchange, clock);
  DeviceSample sample;
  REQUIRE(mouse.read(sample) == DeviceStatus::ok);
  CHECK_FALSE(sample.ready);
  exchange.publish(at(7.0, 8.0));
  REQUIRE(mouse.write({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}) == DeviceStatus::ok);
  clock.wait_until(1ms);
  REQUIRE(mouse.read(sample) == DeviceStatus::ok);
  CHECK(sample.ready);
  CHECK(sample.position_mm.x == 7.0);
  CHECK(exchange.stylus().sequence == 2);
}

TEST_CASE("the mouse says that it is visual, and refuses options out of range") {
  VirtualClock clock;
  PointerExchange exchange;
  CHECK(MouseDevice(exchange, clock).info().visual);
  CHECK(MouseDevice(exchange, clock).info().name == "mouse");
  CHECK_THROWS_AS(MouseDevice(exchange, clock, {.pull_n_per_mm = 0.0}), std::invalid_argument);
}

TEST_CASE("a smooth pull never leaves the range of its targets, whatever the steps") {
  SmoothPull pull(0.01);
  const double step_s = GENERATE(0.0, 1e-4, 1e-3, 0.5, 1e6);
  for (int i = 0; i < 500; ++i) {
    pull.step({i % 3 == 0 ? -2.0 : 1.0, 0.5}, step_s);
    CHECK(pull.value().x >= -2.0);
    CHECK(pull.value().x <= 1.0);
    CHECK(pull.value().y <= 0.5);
  }
}

TEST_CASE("the mouse is listed with a display, and otherwise with what is missing") {
  const EnvironmentVariable wayland("WAYLAND_DISPLAY", nullptr);
  {
    const EnvironmentVariable display("DISPLAY", ":7");
    const DeviceListing listing = device::device_driver("mouse").list({}).at(0);
    CHECK(listing.present);
    CHECK(listing.where == ":7");
    CHECK(listing.missing.empty());
  }
  const EnvironmentVariable no_display("DISPLAY", nullptr);
  const DeviceListing listing = device::device_driver("mouse").list({}).at(0);
  CHECK_FALSE(listing.present);
  REQUIRE(listing.missing.size() == 1);
  CHECK_FALSE(listing.missing[0].empty());
}

TEST_CASE("the registry lists the mouse, which only a window can open") {
  CHECK_THROWS_AS(device::open_device("mouse", {}), DeviceError);
  bool listed = false;
  for (const DeviceListing& listing : list_devices({})) listed |= listing.driver == "mouse";
  CHECK(listed);
}

}  // namespace

}  // namespace touchtrial
