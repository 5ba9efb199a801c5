#include "protocols/identification/analysis/felt_fixtures.hpp"

#include "core/random.hpp"

#include <cmath>
#include <numbers>

namespace touchtrial {
namespace {

using namespace analysis::identification;

engine::FeltFeatures features_of(Difference difference, int class_index) {
  engine::FeltFeatures felt{};
  felt.fill(-3.0);
  if (difference == Difference::strength) {
    for (double& feature : felt) feature += 0.5 * class_index;
  }
  if (difference == Difference::shape) {
    // One band of equal strength, another one for each class: all five together stay the same.
    felt[engine::kLateralBandsAt + class_index % engine::kFeltBands] += 0.5;
    felt[engine::kNormalBandsAt + class_index % engine::kFeltBands] += 0.5;
  }
  if (difference == Difference::direction)
    felt[engine::kDirectionsAt + class_index % engine::kFeltDirections] += 0.5;
  return felt;
}

}  // namespace

std::vector<ObservedTrial> felt_trials(Difference difference, int classes, int repeats,
                                       double noise, std::uint64_t index) {
  RandomStream random(7, "felt_fixtures", index);
  std::vector<ObservedTrial> trials;
  for (int i = 0; i < classes * repeats; ++i) {
    const int class_index = i % classes;
    trials.push_back({class_index, 0, features_of(difference, class_index)});
    for (double& feature : trials.back().felt) feature += noise * random.normal();
  }
  return trials;
}

record::Trace stroking_over_wave(double wavelength_mm, double amplitude_n) {
  constexpr int kSamples = 3000;
  constexpr double kStepMm = 0.1;
  constexpr int kStroke = 400;
  record::Trace trace;
  for (int i = 0; i < kSamples; ++i) {
    const int along = i % (2 * kStroke);
    const double x_mm = kStepMm * (along < kStroke ? along : 2 * kStroke - along);
    const double wave = amplitude_n * std::sin(2.0 * std::numbers::pi * x_mm / wavelength_mm);
    trace.samples.push_back({{5.0 + x_mm, 20.0, -0.5}, {wave, 0.0, 0.5}});
  }
  return trace;
}

}  // namespace touchtrial
