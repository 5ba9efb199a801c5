#include "protocols/simulation/stimulus_levels.hpp"

#include "core/errors.hpp"
#include "engine/perception/texture_sense.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/threshold_tracks.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace touchtrial {
namespace {

using engine::ThresholdCurve;
using simulation::StimulusLevels;

StimulusLevels levels(const TinyStudy& study, const std::vector<std::string>& devices,
                      std::uint64_t seed = 1, int jobs = 2) {
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  std::vector<device::DeviceModel> models;
  for (const std::string& name : devices) models.push_back(device::device_model(name));
  return simulation::levels_of(study.key(), source, models, jobs, seed);
}

}  // namespace

TEST_CASE("law 9: twice the gain is 6.02 dB more by either curve") {
  const StimulusLevels single = levels(TinyStudy(), {"ideal"});
  const StimulusLevels twice = levels(TinyStudy({.first_gain = 2.0}), {"ideal"});
  REQUIRE(single.stimuli.size() == 5);
  REQUIRE(single.levels[0].size() == 2);
  for (std::size_t curve = 0; curve < 2; ++curve) {
    CHECK(twice.levels[0][curve].db - single.levels[0][curve].db == Approx(6.02).margin(0.4));
    CHECK(twice.levels[1][curve].db == single.levels[1][curve].db);
  }
}

TEST_CASE("a plane without texture is as strong as the blank one") {
  const StimulusLevels found = levels(TinyStudy({.smooth = true}), {"ideal", "touch"});
  for (const simulation::PlaneLevels& stimulus : found.levels) {
    REQUIRE(stimulus.size() == 4);
    for (std::size_t i = 0; i < stimulus.size(); ++i) {
      CHECK(stimulus[i].device == (i < 2 ? "ideal" : "touch"));
      CHECK(stimulus[i].db == simulation::kNoLevelDb);
    }
  }
  // No device, no texture: what is left of the landing; encoder steps and friction are felt where
  // there are any.
  CHECK(found.blank[0].db < -40.0);
  CHECK(found.blank[2].db > -20.0);
}

TEST_CASE("levels depend on the paths by some 1 dB, and not on the jobs") {
  const TinyStudy study({.side_px = 400});
  constexpr int kSeeds = 8;
  std::array<double, kSeeds> db{};
  for (int seed = 0; seed < kSeeds; ++seed) {
    db[seed] = levels(study, {"touch"}, static_cast<std::uint64_t>(seed) + 1).levels[2][0].db;
  }
  double mean = 0.0;
  for (const double one : db) mean += one / kSeeds;
  double variance = 0.0;
  for (const double one : db) variance += (one - mean) * (one - mean) / (kSeeds - 1);
  INFO(std::sqrt(variance));
  CHECK(variance < 1.5 * 1.5);
  CHECK(levels(study, {"touch"}, 1, 1).levels[2][0].db == db[0]);
}

TEST_CASE("a vibration's power at the tip is that of mass, spring and damper") {
  const double frequency_hz = GENERATE(20.0, 60.0, 150.0, 300.0);
  constexpr double kForceN = 0.1;
  constexpr double kMassKg = 0.1;  // HandOptions
  constexpr double kSpringNPerM = 200.0;
  constexpr double kDamperNSPerM = 8.0;
  const double power = vibration_power(frequency_hz, kForceN);
  // Of samples: differences of places in place of derivatives.
  const double turn = 2000.0 * std::sin(2.0 * std::numbers::pi * frequency_hz / 2000.0);
  const std::complex<double> stiffness(kSpringNPerM - kMassKg * turn * turn, kDamperNSPerM * turn);
  const double peak = kForceN / std::abs(stiffness) * turn * turn;
  INFO(frequency_hz << " Hz: " << 10.0 * std::log10(power / (0.5 * peak * peak)) << " dB");
  CHECK(std::abs(10.0 * std::log10(power / (0.5 * peak * peak))) < 0.5);
}

TEST_CASE("a study's device is a shipped model or a file beside it, and what is missing is named") {
  study::Study study;
  study.source = "mine.json";
  CHECK(simulation::level_devices(study).size() == device::shipped_device_models().size());
  study.device = "falcon";
  REQUIRE(simulation::level_devices(study).size() == 1);
  CHECK(simulation::level_devices(study).front().name == "falcon");
  study.device = "omega";
  CHECK(simulation::level_devices(study).front().name == "omega_3");
  study.device = "falcom";
  CHECK_THROWS_WITH(simulation::level_devices(study),
                    holds_text("mine.json: /rendering/device: ") && holds_text("falcon"));
  study.device = "gone/mine.json";
  CHECK_THROWS_AS(simulation::level_devices(study), StudyError);
}

}  // namespace touchtrial
