// What compensation delivers and costs, against closed forms and the theory of sampled walls.
#include "device/compensation/compensation_figures.hpp"

#include "device/model/held_devices.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using device::CompensationFigures;
using device::DeviceModel;
using device::HandKind;

/// A rigid mass that holds its force, and nothing else.
DeviceModel heavy_model(double mass_kg) {
  DeviceModel model = model_of(mass_kg);
  model.zero_order_hold = true;
  return model;
}

TEST_CASE("an ideal device has nothing to gain and no cost") {
  const CompensationFigures figures = device::measure_compensation(
      device::device_model("ideal"), hand_by(HandKind::stylus_grip), 12.0);
  for (const device::TipResponse& at : figures.responses) {
    CHECK(at.without_m_s2_per_n == Approx(at.ideal_m_s2_per_n).epsilon(1e-9));
    CHECK(at.with_m_s2_per_n == Approx(at.ideal_m_s2_per_n).epsilon(1e-6));
    CHECK(at.gain_db == Approx(0.0).margin(1e-6));
  }
  CHECK(figures.without.noise_motors_n == 0.0);
  CHECK(figures.with.noise_tip_n == 0.0);
}

TEST_CASE(
    "the accelerations of a mass in a light pen grip are Newton's, and shaping restores them") {
  const CompensationFigures figures = device::measure_compensation(heavy_model(0.15), {}, 40.0);
  CHECK(figures.responses.front().frequency_hz == 10.0);
  CHECK(figures.responses.back().frequency_hz == 320.0);
  for (const device::TipResponse& at : figures.responses) {
    INFO(at.frequency_hz << " Hz");
    const std::complex<double> s(0.0, 2.0 * kPi * at.frequency_hz);
    const std::complex<double> hand = 0.1 * s * s + 8.0 * s + 200.0;  // SI units
    // Sampling bends the frequencies near its own.
    const double margin = at.frequency_hz > 100.0 ? 0.15 : 0.05;
    CHECK(at.ideal_m_s2_per_n == Approx(std::abs(s * s / hand)).epsilon(margin));
    CHECK(at.without_m_s2_per_n == Approx(std::abs(s * s / (hand + 0.15 * s * s))).epsilon(margin));
    CHECK(at.with_m_s2_per_n == Approx(at.ideal_m_s2_per_n).epsilon(0.05));
  }
}

TEST_CASE("the bound of the gain bounds what the tip gets, and is used up on a soft structure") {
  const CompensationFigures figures = device::measure_compensation(
      device::device_model("touch"), hand_by(HandKind::stylus_grip), 12.0);
  for (const device::TipResponse& at : figures.responses) {
    INFO(at.frequency_hz << " Hz");
    CHECK(std::abs(at.gain_db) < 12.4);
    CHECK(20.0 * std::log10(at.with_m_s2_per_n / at.without_m_s2_per_n) ==
          Approx(at.gain_db).margin(0.3));
    if (at.frequency_hz <= 100.0) {
      CHECK(at.with_m_s2_per_n == Approx(at.ideal_m_s2_per_n).epsilon(0.12));
    }
  }
  CHECK(figures.responses.back().gain_db == Approx(12.0).margin(0.3));
  CHECK(figures.responses.back().with_m_s2_per_n < 0.2 * figures.responses.back().ideal_m_s2_per_n);
}

TEST_CASE("encoder steps on a wall make the noise of their rounding, and shaping makes more") {
  const DeviceModel model = device::device_model(GENERATE("touch", "touch_x", "premium_1_5"));
  const CompensationFigures figures =
      device::measure_compensation(model, hand_by(HandKind::stylus_grip), 12.0);
  const double rounding_n = 0.4 * model.position_step_mm / std::sqrt(12.0);
  CHECK(figures.without.noise_motors_n == Approx(rounding_n).epsilon(0.3));
  CHECK(figures.with.noise_motors_n > 1.5 * figures.without.noise_motors_n);
}

TEST_CASE("the stiffest wall is that of the theory, K (T / 2 + delay) = b") {
  DeviceModel model = heavy_model(0.4);
  model.delay_ticks = GENERATE(0, 1, 3);
  const CompensationFigures figures = device::measure_compensation(model, {}, 0.0);
  const double bound = 0.008 / (kT * (0.5 + model.delay_ticks));
  // A wall a little softer settles too slowly for the search, and it goes in steps of 5 %.
  CHECK(figures.without.stiffest_n_per_mm < 1.05 * bound);
  CHECK(figures.without.stiffest_n_per_mm > 0.7 * bound);
  CHECK(figures.with.stiffest_n_per_mm == figures.without.stiffest_n_per_mm);
}

}  // namespace
}  // namespace touchtrial
