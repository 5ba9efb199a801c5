#include "engine/perception/felt_classifier.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace touchtrial {
namespace {

int likeliest(const std::vector<double>& logs) {
  return static_cast<int>(std::ranges::max_element(logs) - logs.begin());
}

TEST_CASE("with one example a class, likelihoods are those of the noise alone") {
  const std::vector<engine::FeltExample> examples = {{0, {0.0, 0.0}}, {1, {3.0, 4.0}}};
  const engine::FeltClassifier classifier(examples, 0.5);
  const std::vector<double> logs = classifier.log_likelihoods(std::vector<double>{0.0, 0.0});
  const double variance = 0.25 + 1e-6;
  const double peak = -std::log(2.0 * std::numbers::pi * variance);
  CHECK(logs[0] == Approx(peak).epsilon(1e-12));
  CHECK(logs[1] == Approx(peak - 0.5 * 25.0 / variance).epsilon(1e-12));
}

TEST_CASE("the covariance within classes decides which differences matter") {
  // Two features that vary together within a class: their difference tells the classes apart.
  RandomStream random(5, "felt_classifier_test");
  std::vector<engine::FeltExample> examples;
  for (int i = 0; i < 400; ++i) {
    const double common = random.normal();
    const int label = i % 2;
    examples.push_back({label, {common + 0.2 * label, common + 0.05 * random.normal()}});
  }
  const engine::FeltClassifier classifier(examples, 0.0);
  CHECK(likeliest(classifier.log_likelihoods(std::vector<double>{2.0, 2.0})) == 0);
  CHECK(likeliest(classifier.log_likelihoods(std::vector<double>{2.2, 2.0})) == 1);
  CHECK(likeliest(classifier.log_likelihoods(std::vector<double>{-2.0, -2.2})) == 1);
}

TEST_CASE(
    "two classes at a distance d in units of noise are told apart with probability Phi(d/2)") {
  constexpr double kNoise = 0.3;
  const std::vector<engine::FeltExample> examples = {{0, {0.0}}, {1, {2.0 * kNoise}}};
  const engine::FeltClassifier classifier(examples, kNoise);
  RandomStream random(9, "felt_classifier_test");
  constexpr int kTrials = 20'000;
  int correct = 0;
  for (int i = 0; i < kTrials; ++i) {
    const int label = i % 2;
    const std::vector<double> felt = {2.0 * kNoise * label + kNoise * random.normal()};
    correct += likeliest(classifier.log_likelihoods(felt)) == label ? 1 : 0;
  }
  CHECK(static_cast<double>(correct) / kTrials == Approx(0.8413).margin(0.01));
}

TEST_CASE("a shift of all features by a constant changes no likelihood") {
  const std::vector<engine::FeltExample> here = {{0, {0.0, 1.0}}, {0, {0.2, 1.4}}, {1, {2.0, 0.0}}};
  std::vector<engine::FeltExample> there = here;
  for (engine::FeltExample& example : there) {
    for (double& feature : example.features) feature -= 7.0;
  }
  const auto a = engine::FeltClassifier(here, 0.1).log_likelihoods(std::vector<double>{0.5, 0.5});
  const auto b =
      engine::FeltClassifier(there, 0.1).log_likelihoods(std::vector<double>{-6.5, -6.5});
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).margin(1e-9));
}

TEST_CASE("equal examples without noise still give finite likelihoods") {
  const std::vector<engine::FeltExample> examples = {{0, {1.0}}, {0, {1.0}}, {1, {1.0}}};
  const auto logs = engine::FeltClassifier(examples, 0.0).log_likelihoods(std::vector<double>{1.0});
  CHECK(std::isfinite(logs[0]));
  CHECK(logs[0] == logs[1]);
}

TEST_CASE("a classifier refuses examples that no one can learn from") {
  const std::vector<engine::FeltExample> none;
  const std::vector<engine::FeltExample> gap = {{0, {1.0}}, {2, {1.0}}, {2, {1.0}}};
  const std::vector<engine::FeltExample> uneven = {{0, {1.0}}, {1, {1.0, 2.0}}};
  const std::vector<engine::FeltExample> negative = {{-1, {1.0}}};
  const std::vector<engine::FeltExample> undefined = {
      {0, {std::numeric_limits<double>::quiet_NaN()}}};
  for (const auto& examples : {none, gap, uneven, negative, undefined}) {
    CHECK_THROWS_AS(engine::FeltClassifier(examples, 0.1), std::invalid_argument);
  }
  const std::vector<engine::FeltExample> good = {{0, {1.0}}};
  CHECK_THROWS_AS(engine::FeltClassifier(good, -0.1), std::invalid_argument);
  CHECK_THROWS_AS(engine::FeltClassifier(good, 0.1).log_likelihoods(std::vector<double>{1.0, 2.0}),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
