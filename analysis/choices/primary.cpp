#include "analysis/choices/primary.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::choices {
namespace {

using analysis::StratifiedMean;
using analysis::without_noise;
using study::Estimand;

int method_index_of(const study::Study& study, const std::string& label) {
  const auto found = std::ranges::find(study.methods, label, &study::StudyMethod::label);
  return static_cast<int>(found - study.methods.begin());
}

PrimaryQuestion registered_question(const study::Study& study) {
  const study::RegisteredAnalysis& registered = *study.registration.analysis;
  PrimaryQuestion question;
  question.estimand = registered.estimand;
  if (registered.methods.size() == 2) {
    question.first = method_index_of(study, registered.methods[0]);
    question.second = method_index_of(study, registered.methods[1]);
  }
  question.test = registered.test;
  question.sides = registered.one_sided ? Sides::one : Sides::two;
  question.alpha = registered.alpha;
  question.smallest_effect = registered.smallest_effect;
  question.margin = registered.margin;
  return question;
}

bool is_difference(const PrimaryQuestion& question) {
  return question.estimand == Estimand::difference;
}

struct SelectedPeople {
  std::vector<CrossoverPerson> people;
  std::vector<int> sessions;  ///< the first of each person
  int trials = 0;
};

/// One participant's accuracy with a method of the question.
struct MethodShare {
  Proportion right;
  int first_block = std::numeric_limits<int>::max();
};

/// The accuracies with the first and the second method, by participant.
std::map<int, std::pair<MethodShare, MethodShare>> shares_of(const PrimaryQuestion& question,
                                                             const Outcomes& outcomes,
                                                             const Selection& selection) {
  const FirstSessions people(outcomes);
  const std::set<int> complete = people_with_all_visits(outcomes, selection, people);
  std::map<int, std::pair<MethodShare, MethodShare>> shares;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!selection.includes(trial) || !outcomes.design.enters_analysis(trial.visit)) continue;
    const bool is_first = trial.stimulus.method == question.first;
    const bool is_second = is_difference(question) && trial.stimulus.method == question.second;
    if (!is_first && !is_second) continue;
    const int person = people.first_of(trial.row.session);
    if (!complete.contains(person)) continue;
    auto& [first_method, second_method] = shares[person];
    MethodShare& share = is_first ? first_method : second_method;
    share.right.add(trial.correct());
    share.first_block = std::min(share.first_block, trial.row.block);
  }
  return shares;
}

std::map<int, int> order_blocks_of(const Outcomes& outcomes) {
  std::map<int, int> blocks;
  for (const SessionOutcome& session : outcomes.sessions)
    blocks[session.row.session] = session.order_block;
  return blocks;
}

SelectedPeople people_of(const PrimaryQuestion& question, const Outcomes& outcomes,
                         const Selection& selection) {
  const std::map<int, int> blocks = order_blocks_of(outcomes);
  SelectedPeople selected;
  for (const auto& [session, method_shares] : shares_of(question, outcomes, selection)) {
    const auto& [first, second] = method_shares;
    if (is_difference(question) && (first.right.n == 0 || second.right.n == 0)) continue;
    selected.trials += first.right.n + second.right.n;
    const double first_share = first.right.share().value_or(0.0);
    const double difference = without_noise(first_share - second.right.share().value_or(0.0));
    selected.sessions.push_back(session);
    const auto block = blocks.find(session);
    selected.people.push_back({is_difference(question) ? difference : first_share,
                               first.first_block < second.first_block,
                               block == blocks.end() ? -1 : block->second});
  }
  return selected;
}

Interval range_of(const PrimaryQuestion& question) {
  return is_difference(question) ? Interval{-1.0, 1.0} : Interval{0.0, 1.0};
}

/// The lower limit of a one-sided test: the lower end of the interval at 1 - 2 alpha.
std::optional<double> bound_of(const PrimaryQuestion& question,
                               std::span<const CrossoverPerson> people) {
  if (question.sides == Sides::two || question.alpha >= 0.5) return std::nullopt;
  const auto interval = primary_estimate(question, people, 1.0 - 2.0 * question.alpha).interval;
  return interval ? std::optional(interval->low) : std::nullopt;
}

/// Adds the results that only the registered selection has.
void add_registered_results(const PrimaryQuestion& question, int classes,
                            std::span<const CrossoverPerson> people, PrimaryResult& result) {
  result.p = primary_p(question, classes, people);
  result.bound = bound_of(question, people);
  if (question.test != study::RegisteredTest::crossover) {
    result.statistic = analysis::t_statistic(differences_of(people), result.null);
    return;
  }
  result.crossover =
      crossover_estimate(people, result.null, question.sides, question.interval_level());
  result.permutation = crossover_permutation(people, result.null, question.sides);
}

/// Whether t is undefined, so that p is from another test.
bool has_no_t(const PrimaryQuestion& question, std::span<const CrossoverPerson> people,
              const PrimaryResult& result) {
  switch (question.test) {
    case study::RegisteredTest::t:
      return analysis::all_alike(differences_of(people));
    case study::RegisteredTest::crossover:
      return result.p && !result.crossover->interval;
    case study::RegisteredTest::sign_flip:
      break;
  }
  return false;
}

/// The mean with stations as strata; nothing with one station.
std::optional<StratifiedMean> station_mean(const PrimaryQuestion& question,
                                           const Outcomes& outcomes,
                                           const SelectedPeople& selected) {
  // The period effect is estimated over all stations together.
  if (question.test == study::RegisteredTest::crossover) return std::nullopt;
  std::map<int, int> station_of;
  for (const SessionOutcome& session : outcomes.sessions) {
    station_of[session.row.session] = session.row.station;
  }
  std::map<int, std::vector<double>> by_station;
  for (std::size_t i = 0; i < selected.people.size(); ++i) {
    by_station[station_of.at(selected.sessions[i])].push_back(selected.people[i].difference);
  }
  std::vector<std::vector<double>> strata;
  for (auto& [station, values] : by_station) strata.push_back(std::move(values));
  return stratified_mean(strata, range_of(question), question.interval_level());
}

std::string question_words(const PrimaryQuestion& question, const Outcomes& outcomes) {
  const std::string& first = outcomes.methods[question.first];
  const std::string visits = visit_words(outcomes.design);
  if (!is_difference(question)) {
    return fmt::format("mean over participants of the accuracy with {}, against chance ({:.1f}%){}",
                       first, 100.0 / static_cast<double>(outcomes.classes.size()), visits);
  }
  const std::string against =
      question.margin ? fmt::format(", against −{:.3g} points", 100.0 * *question.margin) : "";
  return fmt::format("mean over participants of the accuracy with {} less that with {}{}{}", first,
                     outcomes.methods[question.second], against, visits);
}

/// The estimand under the null hypothesis.
double null_of(const PrimaryQuestion& question, int classes) {
  return is_difference(question) ? -question.margin.value_or(0.0) : 1.0 / classes;
}

}  // namespace

std::optional<PrimaryQuestion> primary_question(const study::Study& study, int methods) {
  if (study.registration.analysis) return registered_question(study);
  if (methods > 2) return std::nullopt;
  PrimaryQuestion question;
  if (methods == 2) {
    question.estimand = Estimand::difference;
    question.test = study::default_test_of(study);
    question.sides = Sides::two;
  }
  return question;
}

std::string test_words(const PrimaryQuestion& question) {
  const auto test = [&]() -> std::string {
    switch (question.test) {
      case study::RegisteredTest::sign_flip:
        return "sign flips over participants";
      case study::RegisteredTest::crossover:
        return "period-adjusted t test over participants";
      case study::RegisteredTest::t:
        break;
    }
    return is_difference(question) ? "paired t test over participants"
                                   : "one-sample t test over participants";
  };
  return fmt::format("{}, {}", test(), question.sides == Sides::one ? "one-sided" : "two-sided");
}

std::string test_words_without_t(const PrimaryQuestion& question) {
  const bool is_crossover = question.test == study::RegisteredTest::crossover;
  return fmt::format("{} and there is no t, {}",
                     is_crossover
                         ? "orders dealt anew, because people do not differ within an order"
                         : "sign flips over participants, because these do not differ",
                     question.sides == Sides::one ? "one-sided" : "two-sided");
}

std::vector<double> differences_of(std::span<const CrossoverPerson> people) {
  std::vector<double> differences;
  for (const CrossoverPerson& person : people) differences.push_back(person.difference);
  return differences;
}

PrimaryEstimate primary_estimate(const PrimaryQuestion& question,
                                 std::span<const CrossoverPerson> people, double level) {
  if (question.test == study::RegisteredTest::crossover) {
    const auto estimate = crossover_estimate(people, 0.0, question.sides, level);
    return {estimate.effect, estimate.interval};
  }
  const MeanEstimate mean = participant_mean(differences_of(people), range_of(question), level);
  return {mean.mean, mean.known_interval()};
}

std::optional<double> primary_p(const PrimaryQuestion& question, int classes,
                                std::span<const CrossoverPerson> people) {
  const double null = null_of(question, classes);
  switch (question.test) {
    case study::RegisteredTest::crossover:
      return crossover_estimate(people, null, question.sides).p;
    case study::RegisteredTest::sign_flip:
      return sign_flip_p(differences_of(people), question.sides);
    case study::RegisteredTest::t:
      break;
  }
  return t_test_p(differences_of(people), null, question.sides);
}

std::vector<CrossoverPerson> primary_values(const PrimaryQuestion& question,
                                            const Outcomes& outcomes) {
  return people_of(question, outcomes, {{}, {}, counted_sessions(outcomes)}).people;
}

std::vector<analysis::AboveChance> above_chance(const PrimaryQuestion& question,
                                                const Outcomes& outcomes,
                                                const Selection& selection) {
  std::vector<double> first;
  std::vector<double> second;
  for (const auto& [session, method_shares] : shares_of(question, outcomes, selection)) {
    const auto& [first_method, second_method] = method_shares;
    if (first_method.right.n == 0 || second_method.right.n == 0) continue;
    first.push_back(*first_method.right.share());
    second.push_back(*second_method.right.share());
  }
  const double chance = 1.0 / static_cast<double>(outcomes.classes.size());
  const auto above_chance_of = [&](int method, const std::vector<double>& shares) {
    return analysis::AboveChance{outcomes.methods[method], analysis::participant_mean(shares).mean,
                                 t_test_p(shares, chance, Sides::one)};
  };
  return {above_chance_of(question.first, first), above_chance_of(question.second, second)};
}

std::optional<PrimaryResult> primary_result(const Outcomes& outcomes) {
  const std::optional<PrimaryQuestion> question =
      primary_question(outcomes.design, static_cast<int>(outcomes.methods.size()));
  if (!question) return std::nullopt;
  const auto classes = static_cast<int>(outcomes.classes.size());
  PrimaryResult result{.estimand = question->estimand,
                       .words = question_words(*question, outcomes),
                       .test = test_words(*question),
                       .null = null_of(*question, classes),
                       .sides = question->sides,
                       .alpha = question->alpha,
                       .level = question->alpha,
                       .interval_level = question->interval_level(),
                       .smallest_effect = question->smallest_effect,
                       .margin = question->margin};
  const std::vector<Selection> all_selections = selections(outcomes);
  std::vector<SelectedPeople> people;
  for (const Selection& selection : all_selections) {
    people.push_back(people_of(*question, outcomes, selection));
  }
  const analysis::StudyCourse course =
      course_of(outcomes, static_cast<int>(people.front().people.size()));
  // After registered looks, intervals and limits have the level of the test.
  PrimaryQuestion adjusted_question = *question;
  if (const auto& registered = outcomes.design.registration.analysis) {
    adjusted_question.alpha = level_of(result, course, registered->spending);
    result.level = adjusted_question.alpha;
    result.interval_level = adjusted_question.interval_level();
  }
  add_registered_results(adjusted_question, classes, people.front().people, result);
  if (has_no_t(adjusted_question, people.front().people, result)) {
    result.test = test_words_without_t(adjusted_question);
  }
  if (question->margin) {
    result.above_chance = above_chance(*question, outcomes, all_selections.front());
  }
  result.stations = station_mean(adjusted_question, outcomes, people.front());
  for (std::size_t i = 0; i < all_selections.size(); ++i) {
    const PrimaryEstimate estimate =
        primary_estimate(adjusted_question, people[i].people, result.interval_level);
    result.choices.push_back({all_selections[i].name, all_selections[i].words,
                              static_cast<int>(people[i].people.size()), people[i].trials,
                              estimate.estimate, estimate.interval});
  }
  set_verdict(result, course);
  return result;
}

}  // namespace touchtrial::choices
