// How often the stated interval of a delay holds the truth, over devices drawn at random.
#include "core/random.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <set>
#include <string>

namespace touchtrial {
namespace {

using device::DeviceModel;

/// A shipped model with mass, friction, encoder step, delay and motors drawn anew; a third of the
/// devices has motors without a low-pass.
DeviceModel drawn_device(const std::string& name, std::uint64_t index) {
  RandomStream random(7, "delay coverage " + name, index);
  DeviceModel model = device::device_model(name);
  model.mass_kg *= random.uniform(0.7, 1.4);
  model.coulomb_n *= random.uniform(0.5, 1.5);
  model.position_step_mm *= random.uniform(0.5, 1.2);
  model.delay_ticks = static_cast<int>(random.uniform(0.0, 9.0));
  model.planted_faults.seed = index;
  if (random.uniform() > 0.33)
    model.lowpass_hz = std::exp(random.uniform(std::log(25.0), std::log(400.0)));
  return model;
}

/// Ticks of delay, and the time constant of the motors, which the certificate counts as delay.
double planted_delay_ms(const DeviceModel& model) {
  const double lag_ms =
      model.lowpass_hz > 0.0 ? 1000.0 / (2.0 * std::acos(-1.0) * model.lowpass_hz) : 0.0;
  return model.delay_ticks + lag_ms;
}

/// Of devices drawn from one model, by their axis x, as all axes of a model are alike.
struct DelayCoverage {
  int devices = 0;
  int measured = 0;
  int held = 0;          ///< the interval holds the truth
  int above_passed = 0;  ///< passed with more than 5 ms
  int below = 0;         ///< devices of at most 4 ms
  int below_passed = 0;
  std::set<std::string> unclear{};  ///< why there was no number
};

DelayCoverage delay_coverage(const std::string& name, int devices) {
  DelayCoverage coverage{.devices = devices};
  device::AcceptanceOptions options{.skip = {"weights", "wall", "steps"}};
  for (int index = 0; index < devices; ++index) {
    const DeviceModel model = drawn_device(name, static_cast<std::uint64_t>(index));
    const auto certificate = device::rehearse_acceptance(model, options).certificate;
    const double truth_ms = planted_delay_ms(model);
    const auto delay = certificate.axes.empty() ? std::nullopt : certificate.axes.front().delay_ms;
    const bool passes = delay && device::verdict_on_delay(*delay) == device::DelayVerdict::below;
    if (truth_ms <= 4.0) ++coverage.below;
    if (truth_ms <= 4.0 && passes) ++coverage.below_passed;
    if (truth_ms > 5.0 && passes) ++coverage.above_passed;
    if (delay) ++coverage.measured;
    if (delay && std::abs(delay->value - truth_ms) <= delay->error) ++coverage.held;
    for (const device::NotMeasured& one : certificate.not_measured) {
      if (one.measurement == "delay on axis x") coverage.unclear.insert(one.reason);
    }
  }
  return coverage;
}

}  // namespace

TEST_CASE("soft arms hide no slow motor: none of more than 5 ms passes, and intervals hold") {
  const DelayCoverage coverage = delay_coverage("touch", 100);
  CAPTURE(coverage.measured, coverage.held, coverage.below, coverage.below_passed);
  CHECK(coverage.above_passed == 0);
  CHECK(coverage.held >= 0.9 * coverage.measured);
  CHECK(coverage.below_passed >= 0.75 * coverage.below);
  CHECK_FALSE(coverage.unclear.empty());
}

TEST_CASE("delay coverage", "[.]") {
  for (const std::string name : {"falcon", "touch", "omega_3", "inverse3"}) {
    const DelayCoverage found = delay_coverage(name, 200);
    std::printf(
        "%s: measured %d of %d, interval holds %.1f %%, more than 5 ms passed %d, at most 4 ms "
        "passed %d of %d\n",
        name.c_str(), found.measured, found.devices, 100.0 * found.held / found.measured,
        found.above_passed, found.below_passed, found.below);
  }
}

}  // namespace touchtrial
