/// Answers that lean on the trial before, against a closed form.
#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

namespace touchtrial {
namespace {

/// Two classes that differ in one feature alone, by 1.2 standard deviations of the noise.
constexpr double kApart = 1.2;

simulation::FeltKnowledge two_classes() {
  simulation::FeltKnowledge known;
  known.label_of_prototype = {"rough", "smooth"};
  for (int label = 0; label < 2; ++label) {
    std::vector<double> features(engine::kFeltFeatures, -3.0);
    features[2] += label == 0 ? kApart : 0.0;
    known.examples.push_back({label, features});
    known.examples.push_back({label, features});
  }
  return known;
}

simulation::SubjectModel leaning_subject() {
  return {.feature_noise = 1.0, .serial = {.answer = 0.6, .stimulus = -0.4}};
}

/// Answers "rough" and all answers, by what was presented, what was presented before and what was
/// answered before.
struct Cell {
  double rough = 0.0;
  double all = 0.0;
};
using Cells = std::array<std::array<std::array<Cell, 2>, 2>, 2>;

Cells answers_of(const simulation::SubjectModel& subject, int trials) {
  const simulation::FeltKnowledge known = two_classes();
  const simulation::Individual individual(subject, 4, 1);
  const simulation::FeltDecision decision(individual, known);
  // The pictures lie the other way round than the classes.
  const simulation::MatchedPictures pictures =
      simulation::match_pictures({"smooth", "rough"}, subject, individual, known);
  simulation::Condition condition(subject, 4, 1);
  RandomStream order(4, "serial_dependence_test");
  Cells cells{};
  int last = 0;
  int answered = 0;
  for (int nth = 1; nth <= trials; ++nth) {
    const int presented = static_cast<int>(order.below(2));
    const std::string& label = known.label_of_prototype[static_cast<std::size_t>(presented)];
    engine::FeltFeatures felt{};
    const auto& features = known.examples[static_cast<std::size_t>(2 * presented)].features;
    std::copy(features.begin(), features.end(), felt.begin());
    RandomStream random = simulation::stream_of_trial(4, simulation::kAnswerPurpose, 1,
                                                      static_cast<std::uint64_t>(nth));
    const int position =
        decision.answer(felt, pictures, random, condition.effects_on(nth, 0)).position;
    simulation::end_trial(condition, {0, true, label}, position, pictures, known);
    const int said = position == 1 ? 0 : 1;
    if (nth > 1) {
      Cell& cell = cells[presented][last][answered];
      cell.rough += said == 0 ? 1.0 : 0.0;
      ++cell.all;
    }
    last = presented;
    answered = said;
  }
  return cells;
}

double probit(const Cell& cell) {
  return boost::math::quantile(boost::math::normal(), cell.rough / cell.all);
}

TEST_CASE("leanings on the answer and the stimulus before are found again in many answers") {
  // The support of "rough" over "smooth" is normal, of mean +-d^2/2 and deviation d, plus the
  // leanings: in units of d, answers are a probit regression, whose terms the cells' contrasts
  // give.
  const Cells cells = answers_of(leaning_subject(), 60'000);
  double stimulus_now = 0.0, stimulus_before = 0.0, answer_before = 0.0;
  for (int now = 0; now < 2; ++now) {
    for (int last = 0; last < 2; ++last) {
      for (int answered = 0; answered < 2; ++answered) {
        REQUIRE(cells[now][last][answered].all > 1000.0);
        const double z = probit(cells[now][last][answered]) / 8.0;
        stimulus_now += now == 0 ? z : -z;
        stimulus_before += last == 0 ? z : -z;
        answer_before += answered == 0 ? z : -z;
      }
    }
  }
  // The largest standard error is that of eight cells of 4,000 answers and more: 0.01 after
  // scaling.
  CHECK(stimulus_now == Approx(0.5 * kApart).margin(0.03));
  CHECK(kApart * answer_before == Approx(0.6).margin(0.04));
  CHECK(kApart * stimulus_before == Approx(-0.4).margin(0.04));
}

TEST_CASE("without serial dependence the trial before tells nothing of an answer") {
  simulation::SubjectModel subject = leaning_subject();
  subject.serial = {};
  const Cells cells = answers_of(subject, 30'000);
  for (int now = 0; now < 2; ++now) {
    Cell after_rough, after_smooth;
    for (int last = 0; last < 2; ++last) {
      after_rough.rough += cells[now][last][0].rough;
      after_rough.all += cells[now][last][0].all;
      after_smooth.rough += cells[now][last][1].rough;
      after_smooth.all += cells[now][last][1].all;
    }
    const double odds = after_rough.rough * (after_smooth.all - after_smooth.rough) /
                        (after_smooth.rough * (after_rough.all - after_rough.rough));
    CHECK(std::abs(std::log(odds)) < 0.25);  // four standard errors
  }
}

/// The share of right answers to a rough texture in one condition.
double share_right(const simulation::SubjectModel& subject,
                   const simulation::ConditionEffects& moment) {
  const simulation::FeltKnowledge known = two_classes();
  const simulation::Individual individual(subject, 4, 1);
  const simulation::FeltDecision decision(individual, known);
  const simulation::MatchedPictures pictures =
      simulation::match_pictures({"rough", "smooth"}, subject, individual, known);
  engine::FeltFeatures felt{};
  std::copy_n(known.examples[0].features.begin(), felt.size(), felt.begin());
  constexpr int kTrials = 20'000;
  int right = 0;
  for (int nth = 1; nth <= kTrials; ++nth) {
    RandomStream random = simulation::stream_of_trial(8, simulation::kAnswerPurpose, 1,
                                                      static_cast<std::uint64_t>(nth));
    right += decision.answer(felt, pictures, random, moment).position == 0 ? 1 : 0;
  }
  return static_cast<double>(right) / kTrials;
}

TEST_CASE("more noise than the participant is used to makes more errors, less makes fewer") {
  const simulation::SubjectModel subject = leaning_subject();
  // The criterion lies half-way: the share is that of a normal number below kApart / (2 noise).
  const boost::math::normal standard;
  for (const double factor : {1.0, 2.0, 0.25}) {
    CHECK(share_right(subject, {.noise_factor = factor}) ==
          Approx(boost::math::cdf(standard, kApart / (2.0 * factor))).margin(0.014));
  }
}

TEST_CASE("log odds of a moment move those of a lapse, and none can move a lapse of 0") {
  const auto lapses = [](double lapse, double log_odds) {
    simulation::SubjectModel subject{.feature_noise = 1e-3, .lapse = lapse};
    // Half of the random answers are right.
    return 2.0 * (1.0 - share_right(subject, {.lapse_log_odds = log_odds}));
  };
  CHECK(lapses(0.1, 0.0) == Approx(0.1).margin(0.015));
  CHECK(lapses(0.1, 1.5) == Approx(1.0 / (1.0 + 9.0 * std::exp(-1.5))).margin(0.02));
  CHECK(lapses(0.0, 5.0) == 0.0);
}

}  // namespace
}  // namespace touchtrial
