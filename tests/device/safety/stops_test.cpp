// What stops a running servo: comfort stop, emergency stop, and what they leave in the hand.
#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace touchtrial {
namespace {

constexpr double kTexturePeakN = 0.4;

/// Presses and fluctuates like a texture under a stroke, and calls a function at one tick.
class TextureForce final : public device::ForceSource {
 public:
  TextureForce(double rate_hz, double texture_n) : rate_hz_(rate_hz), texture_n_(texture_n) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    const auto tick = static_cast<std::int64_t>(sample.sequence) - 1;
    if (tick == calls_at && call) call();
    if (tick < 10) return {};
    const double phase = 2.0 * std::numbers::pi * 90.0 * static_cast<double>(tick) / rate_hz_;
    return {texture_n_ * std::sin(phase), texture_n_ * std::cos(2.0 * phase), 1.5};
  }

  std::int64_t calls_at = 0;
  std::function<void()> call;

 private:
  double rate_hz_;
  double texture_n_;
};

double largest_change_n(const std::vector<Vec3>& forces, std::size_t from) {
  double largest = 0.0;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < forces.size(); ++i) {
    largest = std::max(largest, norm(forces[i] - forces[i - 1]));
  }
  return largest;
}

struct Stopped {
  device::ServoReport report;
  std::vector<Vec3> written;
  std::size_t asked_at = 0;
};

Stopped stop_by(void (device::ServoControl::*request)() noexcept, device::ServoOptions options,
                double texture_n, double at_s = 0.5) {
  RestingDevice device;
  device::ServoControl control;
  TextureForce force(options.rate_hz, texture_n);
  force.calls_at = std::llround(at_s * options.rate_hz);
  force.call = [&] { (control.*request)(); };
  NoSamples sink;
  device::VirtualClock clock;
  device::ServoHooks hooks{.control = &control};
  const device::ServoReport report = device::run_servo(device, force, sink, options, clock, hooks);
  return {report, device.written, static_cast<std::size_t>(force.calls_at)};
}

/// A 90 Hz wave and its double change by at most this in a tick.
double texture_step_n(double texture_n, double rate_hz) {
  return std::sqrt(5.0) * texture_n * 2.0 * std::numbers::pi * 90.0 / rate_hz;
}

TEST_CASE("a comfort stop brings the force to zero within 100 ms and without a step") {
  const double rate_hz = GENERATE(1000.0, 1700.0, 4000.0, 10'000.0);
  const std::int64_t fade_ticks = GENERATE(0, 100, 1'000'000);
  const double texture_n = GENERATE(0.0, kTexturePeakN);
  const double slew_n_per_s = GENERATE(66.0, 1000.0);
  device::ServoOptions options{.fade_ticks = fade_ticks, .rate_hz = rate_hz};
  options.limits.max_slew_n_per_s = slew_n_per_s;
  const Stopped stopped = stop_by(&device::ServoControl::comfort_stop, options, texture_n);
  CHECK(stopped.report.end == device::ServoEnd::comfort_stop);
  REQUIRE(stopped.written.size() > stopped.asked_at);
  // The tick of the request, those of 100 ms, and the zero that ends every run.
  CHECK(static_cast<double>(stopped.written.size() - stopped.asked_at) <= 0.1 * rate_hz + 2.0);
  CHECK(stopped.written.back() == Vec3{});
  CHECK(stopped.written[stopped.written.size() - 2] == Vec3{});
  const double fade_step_n = norm(Vec3{texture_n, texture_n, 1.5}) / (0.05 * rate_hz - 1.0);
  CHECK(largest_change_n(stopped.written, stopped.asked_at) <=
        1.001 * (texture_step_n(texture_n, rate_hz) + fade_step_n));
}

TEST_CASE("a comfort stop takes over a longer fade at its present share") {
  const device::ServoOptions options{.limit_ticks = 400, .fade_ticks = 1000};
  const Stopped stopped = stop_by(&device::ServoControl::comfort_stop, options, 0.0, 0.9);
  CHECK(stopped.report.end == device::ServoEnd::comfort_stop);
  CHECK(stopped.written.size() <= 900 + 102);
  CHECK(stopped.written[900].z == Approx(0.75).margin(0.01));
  CHECK(largest_change_n(stopped.written, 300) < 0.02);
}

TEST_CASE("a comfort stop does not change a fade that ends sooner") {
  const device::ServoOptions options{.limit_ticks = 400, .fade_ticks = 50};
  const Stopped stopped = stop_by(&device::ServoControl::comfort_stop, options, 0.0, 0.42);
  CHECK(stopped.report.end == device::ServoEnd::time_limit);
  CHECK(stopped.written.size() == 451);
}

TEST_CASE("an emergency stop, or a stall, sends zero at the very next tick and latches") {
  const double rate_hz = GENERATE(1000.0, 10'000.0);
  const bool is_stall = GENERATE(false, true);
  const Stopped stopped =
      stop_by(is_stall ? &device::ServoControl::stall : &device::ServoControl::emergency_stop,
              {.rate_hz = rate_hz}, kTexturePeakN);
  CHECK(stopped.report.end == device::ServoEnd::fault);
  CHECK(stopped.report.fault ==
        (is_stall ? device::SafetyFault::stalled : device::SafetyFault::emergency_stop));
  REQUIRE(stopped.written.size() == stopped.asked_at + 2);
  CHECK(norm(stopped.written[stopped.asked_at]) > 1.0);
  CHECK(stopped.written.back() == Vec3{});
}

}  // namespace
}  // namespace touchtrial
