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

TEST_CASE("with one example per class, likelihoods are those of the noise alone") {
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
    "two classes at a distance d in units of noise are distinguished with probability Phi(d/2)") {
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

constexpr int kLabels = 4;
constexpr std::size_t kFeatures = 6;

/// Examples far from zero, like logarithms of small forces, with features that vary together.
std::vector<engine::FeltExample> examples_of(int count, std::uint64_t index) {
  RandomStream random(3, "felt_statistics_test", index);
  std::vector<engine::FeltExample> examples;
  for (int i = 0; i < count; ++i) {
    const double common = 0.1 * random.normal();
    engine::FeltExample& example = examples.emplace_back();
    example.label = i % kLabels;
    for (std::size_t k = 0; k < kFeatures; ++k) {
      const double own = static_cast<double>(k) * example.label;
      example.features.push_back(-5.0 + common + 0.02 * own + 0.05 * random.normal());
    }
  }
  return examples;
}

engine::FeltStatistics learnt(const std::vector<engine::FeltExample>& examples) {
  engine::FeltStatistics statistics(kLabels, kFeatures);
  for (const engine::FeltExample& example : examples)
    statistics.learn(example.label, example.features);
  return statistics;
}

void check_same(const engine::FeltClassifier& one, const engine::FeltClassifier& other,
                const std::vector<double>& features) {
  const auto a = one.log_likelihoods(features);
  const auto b = other.log_likelihoods(features);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).margin(1e-9));
}

TEST_CASE("a classifier from statistics is the classifier from examples") {
  const std::vector<engine::FeltExample> examples = examples_of(40, 0);
  const double noise = GENERATE(0.0, 0.1);
  const engine::FeltClassifier slow(examples, noise);
  const engine::FeltClassifier fast(learnt(examples), noise);
  for (const engine::FeltExample& example : examples) check_same(fast, slow, example.features);
}

TEST_CASE("forgetting an example is learning the others alone") {
  const std::vector<engine::FeltExample> examples = examples_of(40, 1);
  const engine::FeltStatistics all = learnt(examples);
  for (std::size_t out = 0; out < examples.size(); ++out) {
    std::vector<engine::FeltExample> others = examples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    engine::FeltStatistics without = all;
    without.forget(examples[out].label, examples[out].features);
    check_same(engine::FeltClassifier(without, 0.0), engine::FeltClassifier(others, 0.0),
               examples[out].features);
  }
}

TEST_CASE("a label whose only example is forgotten is never likely") {
  engine::FeltStatistics statistics(2, 1);
  statistics.learn(0, std::vector<double>{1.0});
  statistics.learn(1, std::vector<double>{2.0});
  statistics.learn(1, std::vector<double>{2.5});
  statistics.forget(0, std::vector<double>{1.0});
  CHECK(statistics.count(0) == 0);
  CHECK(statistics.degrees_of_freedom() == 1);
  const auto logs =
      engine::FeltClassifier(statistics, 0.1).log_likelihoods(std::vector<double>{1.0});
  CHECK(logs[0] == -std::numeric_limits<double>::infinity());
  CHECK(std::isfinite(logs[1]));
}

TEST_CASE("statistics hold means and scatter that one can work out by hand") {
  engine::FeltStatistics statistics(1, 2);
  statistics.learn(0, std::vector<double>{0.0, 0.0});
  statistics.learn(0, std::vector<double>{2.0, 4.0});
  statistics.learn(0, std::vector<double>{4.0, 2.0});
  CHECK(statistics.mean(0)[0] == Approx(2.0));
  CHECK(statistics.mean(0)[1] == Approx(2.0));
  CHECK(statistics.scatter()[0] == Approx(8.0));
  CHECK(statistics.scatter()[1] == Approx(4.0));
  CHECK(statistics.scatter()[2] == Approx(4.0));
  CHECK(statistics.scatter()[3] == Approx(8.0));
}

TEST_CASE("statistics refuse what cannot be learnt or forgotten") {
  REQUIRE_THROWS_AS(engine::FeltStatistics(0, 1), std::invalid_argument);
  REQUIRE_THROWS_AS(engine::FeltStatistics(1, 0), std::invalid_argument);
  engine::FeltStatistics statistics(2, 1);
  REQUIRE_THROWS_AS(statistics.learn(2, std::vector<double>{1.0}), std::invalid_argument);
  REQUIRE_THROWS_AS(statistics.learn(-1, std::vector<double>{1.0}), std::invalid_argument);
  REQUIRE_THROWS_AS(statistics.learn(0, std::vector<double>{1.0, 2.0}), std::invalid_argument);
  REQUIRE_THROWS_AS(statistics.learn(0, std::vector<double>{std::nan("")}), std::invalid_argument);
  REQUIRE_THROWS_AS(statistics.forget(0, std::vector<double>{1.0}), std::invalid_argument);
  REQUIRE_THROWS_AS(engine::FeltClassifier(statistics, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
