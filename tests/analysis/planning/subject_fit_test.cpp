#include "analysis/planning/subject_fit.hpp"

#include "analysis/planning/planned_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

const PlannedStudy& planned_study() {
  static const PlannedStudy planned(150);
  return planned;
}

simulation::SubjectModel start() {
  simulation::SubjectModel subject = planned_subject();
  subject.feature_noise = 0.3;
  subject.lapse = 0.05;
  return subject;
}

planning::SubjectFit fitted(const planning::FitCounts& counts,
                            const planning::FitOptions& options = {.bootstraps = 99}) {
  return planning::fit_subject(planned_study().model(1), counts, start(), options);
}

const planning::ParameterEstimate& named(const planning::SubjectFit& fit, const std::string& name,
                                         const std::string& label = "") {
  const auto found =
      std::ranges::find_if(fit.estimates, [&](const planning::ParameterEstimate& one) {
        return one.name == name && one.label == label;
      });
  REQUIRE(found != fit.estimates.end());
  return *found;
}

bool holds(const planning::OpenInterval& interval, double value) {
  return (!interval.lower || *interval.lower <= value) &&
         (!interval.upper || *interval.upper >= value);
}

bool warns_of(const planning::SubjectFit& fit, const std::string& places) {
  return std::ranges::any_of(fit.warnings,
                             [&](const std::string& warning) { return names(warning, places); });
}

TEST_CASE("the intervals of a fit hold the true noise, lapses and biases, and it finds the swap") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 0.9;
  truth.lapse = 0.08;
  truth.position_bias = 1.5;
  truth.class_bias = {{"bark", 1.2}, {"straw", -1.2}};
  truth.label_swap = {{"pebbles", "brick"}};
  const planning::SubjectFit fit = fitted(simulated_counts(planned_study(), truth, 24, 8, 3));
  CHECK(fit.subject.label_swap ==
        std::vector<std::pair<std::string, std::string>>{{"pebbles", "brick"}});
  CHECK(holds(named(fit, "feature_noise").profile, truth.feature_noise));
  CHECK(holds(named(fit, "lapse").profile, truth.lapse));
  CHECK(holds(named(fit, "position").profile, truth.position_bias));
  CHECK(holds(named(fit, "class", "bark").profile, 1.2));
  CHECK(holds(named(fit, "class", "cloth").profile, 0.0));
  CHECK(holds(named(fit, "class", "straw").profile, -1.2));
  // With 960 trials, the intervals are informative.
  CHECK(named(fit, "feature_noise").profile.upper.value() < 1.3);
  CHECK(named(fit, "feature_noise").profile.lower.value() > 0.6);
  CHECK(named(fit, "position").profile.lower.value() > 0.3);
  CHECK(named(fit, "lapse").profile.upper.value() < 0.25);
  CHECK(fit.p.value() > 0.01);
  double sum = 0.0;
  for (const simulation::ClassBias& bias : fit.subject.class_bias) sum += bias.log_odds;
  CHECK(sum == Approx(0.0).margin(1e-9));
}

TEST_CASE("intervals of the profile and of simulated studies have similar widths") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 0.9;
  truth.lapse = 0.1;
  const planning::SubjectFit fit =
      fitted(simulated_counts(planned_study(), truth, 20, 5, 8),
             {.free = {.position = false, .classes = false, .swaps = false}, .bootstraps = 199});
  REQUIRE(fit.estimates.size() == 2);
  const planning::ParameterEstimate& feature_noise = named(fit, "feature_noise");
  const double profile = feature_noise.profile.upper.value() - feature_noise.profile.lower.value();
  const double simulated = feature_noise.bootstrap->high - feature_noise.bootstrap->low;
  CHECK(simulated / profile > 0.6);
  CHECK(simulated / profile < 1.6);
  CHECK(feature_noise.monte_carlo_error < *feature_noise.standard_error);
  CHECK(fit.subject.position_bias == 0.0);
}

TEST_CASE("people who differ are fitted as such, and --fix spread says that they are not") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 0.6;
  truth.feature_noise_spread = 1.2;
  const planning::FitCounts counts = simulated_counts(planned_study(), truth, 30, 6, 11);
  const planning::SubjectFit fit = fitted(counts);
  REQUIRE(fit.people.has_value());
  CHECK(fit.people->equal_p < 0.001);
  CHECK(fit.spread_replaced);
  CHECK(holds(fit.people->interval, truth.feature_noise_spread));
  CHECK(fit.subject.feature_noise_spread == fit.people->spread);
  CHECK(std::ranges::any_of(fit.warnings, [](const std::string& warning) {
    return warning.find("0.00") != std::string::npos;
  }));
  CHECK(fit.p.value() > 0.01);
  const planning::SubjectFit alike = fitted(counts, {.free = {.spread = false}, .bootstraps = 20});
  CHECK_FALSE(alike.spread_replaced);
  CHECK(alike.subject.feature_noise_spread == 0.0);
  CHECK(alike.warnings != fit.warnings);
}

TEST_CASE("people who do not differ keep the spread that the subject has") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 0.6;
  const planning::FitCounts counts = simulated_counts(planned_study(), truth, 20, 5, 12);
  const planning::SubjectFit fit = fitted(counts, {.bootstraps = 0});
  REQUIRE(fit.people.has_value());
  CHECK_FALSE(fit.spread_replaced);
  CHECK(fit.people->interval.lower == 0.0);
}

TEST_CASE("a fit is a function of its arguments, for any number of jobs") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 0.7;
  const planning::FitCounts counts = simulated_counts(planned_study(), truth, 6, 3, 4);
  const auto fit = [&](int jobs) {
    return planning::fit_subject(planned_study().model(1, jobs), counts, start(),
                                 {.bootstraps = 20, .seed = 3, .jobs = jobs});
  };
  const planning::SubjectFit alone = fit(1);
  const planning::SubjectFit crowd = fit(4);
  CHECK(alone.subject.feature_noise == crowd.subject.feature_noise);
  CHECK(alone.log_likelihood == crowd.log_likelihood);
  CHECK(alone.p == crowd.p);
  CHECK(named(alone, "feature_noise").profile.upper == named(crowd, "feature_noise").profile.upper);
}

TEST_CASE("a fit takes no swap that the answers do not call for, and keeps a fixed one") {
  simulation::SubjectModel truth = planned_subject();
  truth.feature_noise = 1.5;
  const planning::FitCounts counts = simulated_counts(planned_study(), truth, 10, 5, 2);
  const planning::SubjectFit fit = fitted(counts, {.bootstraps = 0});
  CHECK(fit.subject.label_swap.empty());
  REQUIRE_FALSE(fit.swaps.empty());
  CHECK(fit.swaps.front().gain < fit.swap_threshold);
  CHECK_FALSE(fit.p);
  simulation::SubjectModel swapped = start();
  swapped.label_swap = {{"bark", "straw"}};
  const planning::SubjectFit kept = planning::fit_subject(
      planned_study().model(1), counts, swapped, {.free = {.swaps = false}, .bootstraps = 0});
  CHECK(kept.subject.label_swap == swapped.label_swap);
  CHECK(kept.log_likelihood < fit.log_likelihood - 10.0);
}

/// Counts with the same answers for every person.
/// \param rows  answers by presented class
planning::FitCounts made_up(const std::vector<std::vector<double>>& rows, int people) {
  planning::FitCounts counts = simulated_counts(planned_study(), start(), people, 0, 1);
  for (planning::CountedPerson& person : counts.people) {
    for (std::size_t i = 0; i < person.counts.size(); ++i) {
      person.counts[i] = rows[i / 5][i % 5];
      counts.trials += static_cast<int>(person.counts[i]);
    }
  }
  return counts;
}

const std::vector<std::vector<double>> kAllRight = {
    {5, 0, 0, 0, 0}, {0, 5, 0, 0, 0}, {0, 0, 5, 0, 0}, {0, 0, 0, 5, 0}, {0, 0, 0, 0, 5}};

TEST_CASE("if all answers are right, noise has an upper limit but no lower one") {
  const planning::SubjectFit fit = fitted(made_up(kAllRight, 8));
  CHECK_FALSE(fit.warnings.empty());
  CHECK_FALSE(named(fit, "feature_noise").profile.lower);
  CHECK(named(fit, "feature_noise").profile.upper.value() > fit.subject.feature_noise);
  CHECK(named(fit, "lapse").profile.lower == 0.0);
  CHECK(named(fit, "lapse").profile.upper.value() < 0.1);
  // Short explorations cause some errors even without noise; the fit is right at least as often.
  const planning::FitCounts counts = made_up(kAllRight, 8);
  simulation::SubjectModel still = planned_subject();
  still.feature_noise = 1e-3;
  const planning::Confusions best = planning::expected_confusions(
      counts, planned_study().model(1).answers(still, counts.layouts));
  double right = 0.0;
  double best_right = 0.0;
  for (int c = 0; c < 5; ++c) {
    right += fit.expected[0][c][c];
    best_right += best[0][c][c];
  }
  CHECK(right >= best_right - 0.1);
  CHECK(right > 0.9 * 200.0);
}

TEST_CASE("if all answers are wrong, the fit ends and warns that it does not fit") {
  auto wrong = kAllRight;
  std::ranges::rotate(wrong, wrong.begin() + 1);
  const planning::SubjectFit fit = fitted(made_up(wrong, 4));
  CHECK(fit.warnings.size() >= 2);
  CHECK(std::isfinite(fit.log_likelihood));
}

TEST_CASE(
    "a fit warns of a single participant, of a class never presented and of one never answered") {
  auto some = kAllRight;
  some[1] = {0, 0, 0, 0, 0};
  some[0] = {3, 0, 1, 1, 0};
  some[2] = {2, 0, 3, 0, 0};
  const planning::SubjectFit fit = fitted(made_up(some, 1), {.bootstraps = 20});
  CHECK(fit.warnings.size() >= 3);
  CHECK(warns_of(fit, "cloth"));
  // With one order of pictures, a preference for positions is one for classes.
  CHECK(fit.subject.position_bias == 0.0);
  for (const planning::ParameterEstimate& one : fit.estimates) CHECK(one.name != "position");
}

TEST_CASE(
    "answers at chance are fitted with much noise or many lapses, which cannot be told apart") {
  const std::vector<std::vector<double>> chance(5, std::vector<double>(5, 2.0));
  const planning::SubjectFit fit = fitted(made_up(chance, 6), {.bootstraps = 20});
  const double right = fit.expected[0][0][0] / 60.0;
  CHECK(right == Approx(0.2).margin(0.05));
  const bool open =
      !named(fit, "feature_noise").profile.lower || !named(fit, "feature_noise").profile.upper;
  CHECK(open);
  CHECK(fit.warnings.size() >= 2);
}

}  // namespace
}  // namespace touchtrial
