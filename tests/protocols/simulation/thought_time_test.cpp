#include "protocols/simulation/thought_time.hpp"

#include "protocols/simulation/felt_decision.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial {
namespace {

constexpr int kDraws = 20'001;

std::vector<double> times_s(const simulation::ThoughtTime& thought, double margin) {
  RandomStream random(6, "thought_time_test");
  std::vector<double> times;
  for (int i = 0; i < kDraws; ++i) {
    times.push_back(simulation::thought_time_s(thought, margin, random));
  }
  std::ranges::sort(times);
  return times;
}

TEST_CASE("the margin is the difference between the two strongest supports") {
  using simulation::margin_of;
  CHECK(margin_of(std::vector<double>{1.0, 4.0, 2.5}) == 1.5);
  CHECK(margin_of(std::vector<double>{4.0, 2.5, 1.0}) == 1.5);
  CHECK(margin_of(std::vector<double>{3.0, 3.0}) == 0.0);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  CHECK(margin_of(std::vector<double>{-kInfinite, 2.0}) == kInfinite);
  CHECK(margin_of(std::vector<double>{2.0}) == kInfinite);
}

TEST_CASE("median thought falls with the margin from the hard to the easy one") {
  const simulation::ThoughtTime thought{
      .shift_s = 0.3, .easy_s = 0.6, .hard_s = 2.0, .margin = 2.0, .spread = 0.5};
  const auto median = [&](double margin) { return times_s(thought, margin)[kDraws / 2]; };
  // A median's standard error is 1.25 * 0.5 / sqrt(20,001) of the part above the shift: 0.45 %.
  CHECK(median(0.0) == Approx(0.3 + 2.0).epsilon(0.02));
  CHECK(median(2.0) == Approx(0.3 + 0.6 + 1.4 * std::exp(-1.0)).epsilon(0.02));
  CHECK(median(1e9) == Approx(0.3 + 0.6).epsilon(0.02));
  CHECK(median(std::numeric_limits<double>::infinity()) == median(1e9));
}

TEST_CASE("thought above its shift is lognormal") {
  const simulation::ThoughtTime thought{.shift_s = 0.3, .hard_s = 2.0, .spread = 0.4};
  const std::vector<double> times = times_s(thought, 0.0);
  // Quantiles of a standard normal number.
  for (const auto& [share, z] : {std::pair(0.1, -1.2816), {0.25, -0.6745}, {0.9, 1.2816}}) {
    const double expected = 2.0 * std::exp(0.4 * z);
    CHECK(times[static_cast<std::size_t>(share * kDraws)] - 0.3 == Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("no thought is shorter than its shift or longer than the longest") {
  const simulation::ThoughtTime thought{
      .shift_s = 0.5, .easy_s = 1.0, .hard_s = 4.0, .spread = 2.0, .max_s = 6.0};
  const std::vector<double> times = times_s(thought, 0.0);
  CHECK(times.front() >= 0.5);
  CHECK(times.front() < 0.6);
  CHECK(times.back() == 6.0);
}

TEST_CASE("difficulty changes how long people think and not what they answer") {
  simulation::FeltKnowledge known;
  known.label_of_prototype = {"bark", "straw"};
  for (int label = 0; label < 2; ++label) {
    known.examples.push_back({label, std::vector<double>(engine::kFeltFeatures, 0.3 * label)});
  }
  simulation::SubjectModel subject{.feature_noise = 0.6};
  const simulation::Individual individual(subject, 1, 1);
  const simulation::FeltDecision decision(individual, known);
  const simulation::MatchedPictures pictures =
      simulation::match_pictures({"bark", "straw"}, subject, individual, known);
  const simulation::ThoughtTime thought;
  const auto answer_to = [&](double felt, std::uint64_t nth, bool is_flat) {
    engine::FeltFeatures features;
    features.fill(felt);
    RandomStream random = simulation::stream_of_trial(3, simulation::kAnswerPurpose, 1, nth);
    simulation::ConditionEffects moment;
    if (!is_flat) moment.thought = &thought;
    return decision.answer(features, pictures, random, moment);
  };
  double hard_s = 0.0;
  double easy_s = 0.0;
  for (std::uint64_t nth = 1; nth <= 500; ++nth) {
    const simulation::ParticipantAnswer hard = answer_to(0.15, nth, false);
    CHECK(hard.position == answer_to(0.15, nth, true).position);
    hard_s += std::chrono::duration<double>(hard.thought).count() / 500.0;
    easy_s += std::chrono::duration<double>(answer_to(1.5, nth, false).thought).count() / 500.0;
  }
  CHECK(hard_s > 1.3 * easy_s);
}

}  // namespace
}  // namespace touchtrial
