#include "analysis/planning/noise_lines.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

TEST_CASE(
    "a length along a line is normal in one dimension, and has the known distribution in four") {
  const planning::RadialDistribution one(1);
  for (const double t : {-3.0, -0.7, 0.0, 0.2, 1.96, 5.0}) {
    CHECK(one.at(t).below == Approx(0.5 * std::erfc(-t / std::sqrt(2.0))).margin(1e-9));
    CHECK(one.at(t).density ==
          Approx(std::exp(-0.5 * t * t) / std::sqrt(2.0 * 3.14159265358979)).margin(1e-6));
  }
  // Four dimensions: P(length > r) = exp(-r^2 / 2) (1 + r^2 / 2).
  const planning::RadialDistribution four(4);
  for (const double r : {0.3, 1.0, 2.5, 4.0}) {
    const double more = std::exp(-0.5 * r * r) * (1.0 + 0.5 * r * r);
    CHECK(four.at(r).below == Approx(1.0 - 0.5 * more).margin(1e-9));
    CHECK(four.at(-r).below == Approx(0.5 * more).margin(1e-9));
  }
  CHECK(four.at(1e300).below == 1.0);
  CHECK(four.at(-1e300).below == 0.0);
}

/// Slow reference: the largest support at every point of a fine grid.
std::vector<double> by_grid(const std::vector<double>& at, const std::vector<double>& slope,
                            const std::vector<int>& picture, int pictures,
                            const planning::RadialDistribution& noise) {
  constexpr double kStep = 1e-3;
  std::vector<double> answers(pictures, 0.0);
  for (double t = -12.0; t < 12.0; t += kStep) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < at.size(); ++k) {
      if (at[k] + (t + 0.5 * kStep) * slope[k] > at[best] + (t + 0.5 * kStep) * slope[best]) {
        best = k;
      }
    }
    answers[picture[best]] += noise.at(t + kStep).below - noise.at(t).below;
  }
  return answers;
}

TEST_CASE("winners along lines agree with a fine grid") {
  const planning::RadialDistribution noise(4);
  RandomStream random(1, "noise_lines_test");
  const std::vector<int> picture = {0, 1, 2, 1, 3, 0, 2};
  for (int round = 0; round < 30; ++round) {
    std::vector<double> at(picture.size());
    std::vector<double> slope(picture.size());
    for (double& value : at) value = random.normal();
    for (double& value : slope) value = random.normal();
    std::array<double, 4> answers{};
    planning::add_winners(at, slope, picture, noise, 1.0, answers, {});
    const std::vector<double> expected = by_grid(at, slope, picture, 4, noise);
    for (int i = 0; i < 4; ++i) CHECK(answers[i] == Approx(expected[i]).margin(1e-3));
  }
}

TEST_CASE("equal lines share their probability by pictures and not by prototypes") {
  const planning::RadialDistribution noise(2);
  std::array<double, 3> answers{};
  const std::vector<double> at = {1.0, 1.0, 1.0, 0.5};
  const std::vector<double> slope = {0.0, 0.0, 0.0, 0.0};
  planning::add_winners(at, slope, std::vector<int>{0, 0, 1, 2}, noise, 1.0, answers, {});
  CHECK(answers == std::array<double, 3>{0.5, 0.5, 0.0});
}

}  // namespace
}  // namespace touchtrial
