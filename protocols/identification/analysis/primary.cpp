#include "protocols/identification/analysis/primary.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/subsets.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using design::Estimand;

int method_labelled(const design::Study& study, const std::string& label) {
  const auto found = std::ranges::find(study.methods, label, &design::StudyMethod::label);
  return static_cast<int>(found - study.methods.begin());
}

PrimaryQuestion registered_question(const design::Study& study) {
  const design::RegisteredAnalysis& registered = *study.registration.analysis;
  PrimaryQuestion question;
  question.estimand = registered.estimand;
  if (registered.methods.size() == 2) {
    question.first = method_labelled(study, registered.methods[0]);
    question.second = method_labelled(study, registered.methods[1]);
  }
  question.test = registered.test;
  question.sides = registered.one_sided ? Sides::one : Sides::two;
  question.alpha = registered.alpha;
  question.smallest_effect = registered.smallest_effect;
  return question;
}

bool is_difference(const PrimaryQuestion& question) {
  return question.estimand == Estimand::difference;
}

/// Which sessions and which of their trials enter an estimate.
struct Selection {
  std::string name;
  std::string words;
  std::set<int> sessions;
  bool valid_alone = false;
  bool answered_alone = false;

  [[nodiscard]] bool has(const TrialOutcome& trial) const {
    return trial.scored && has_ended(trial) && sessions.contains(trial.row.session) &&
           (!valid_alone || trial.valid()) && (!answered_alone || trial.response);
  }
};

std::set<int> joined(std::set<int> sessions, const std::set<int>& more) {
  sessions.insert(more.begin(), more.end());
  return sessions;
}

std::vector<Selection> selections(const Outcomes& outcomes) {
  std::set<int> taken;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) taken.insert(session.row.session);
  }
  const std::set<int> excluded = excluded_sessions(outcomes);
  std::set<int> put_back = taken;
  std::ranges::set_intersection(excluded, outcomes.looked.excluded_afterwards,
                                std::inserter(put_back, put_back.end()));
  std::set<int> registered = put_back;
  for (const auto& [session, rule] : rules_met(outcomes)) registered.erase(session);
  const std::string seen = "no exclusion that was made after outcomes were seen";
  const bool is_registered = outcomes.design.registration.analysis.has_value();
  return {{"registered", (is_registered ? "as registered; " : "") + seen, std::move(registered)},
          {"taken", "all exclusions as made", taken},
          {"put_back", "exclusions made after outcomes were seen put back", std::move(put_back)},
          {"all", "all excluded sessions put back", joined(taken, excluded)},
          {"valid", "exclusions as made, valid trials alone", taken, true},
          {"answered", "exclusions as made, trials with a response alone", taken, false, true}};
}

struct SelectedValues {
  std::vector<double> values;  ///< one per participant
  int trials = 0;
};

/// The selected trials of each session with each method.
std::map<int, std::pair<Proportion, Proportion>> proportions_of(const PrimaryQuestion& question,
                                                                const Outcomes& outcomes,
                                                                const Selection& selection) {
  std::map<int, std::pair<Proportion, Proportion>> sessions;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!selection.has(trial)) continue;
    const bool first = trial.stimulus.method == question.first;
    const bool second = is_difference(question) && trial.stimulus.method == question.second;
    if (!first && !second) continue;
    auto& [of_first, of_second] = sessions[trial.row.session];
    Proportion& own = first ? of_first : of_second;
    ++own.n;
    if (trial.correct()) ++own.correct;
  }
  return sessions;
}

SelectedValues values_of(const PrimaryQuestion& question, const Outcomes& outcomes,
                         const Selection& selection) {
  SelectedValues selected;
  for (const auto& [session, own] : proportions_of(question, outcomes, selection)) {
    const auto& [first, second] = own;
    if (is_difference(question) && (first.n == 0 || second.n == 0)) continue;
    selected.trials += first.n + second.n;
    selected.values.push_back(is_difference(question) ? without_noise(first.share().value_or(0.0) -
                                                                      second.share().value_or(0.0))
                                                      : first.share().value_or(0.0));
  }
  return selected;
}

Interval range_of(const PrimaryQuestion& question) {
  return is_difference(question) ? Interval{-1.0, 1.0} : Interval{0.0, 1.0};
}

PrimaryChoice primary_choice(const PrimaryQuestion& question, const Selection& selection,
                             const SelectedValues& selected) {
  const MeanEstimate mean =
      participant_mean(selected.values, range_of(question), 1.0 - question.alpha);
  return {selection.name,  selection.words, mean.participants,
          selected.trials, mean.mean,       mean.known_interval()};
}

/// The lower limit that goes with a one-sided test: the lower end of the interval at 1 - 2 alpha.
std::optional<double> bound_of(const PrimaryQuestion& question, const std::vector<double>& values) {
  if (question.sides == Sides::two || question.alpha >= 0.5) return std::nullopt;
  const auto interval =
      participant_mean(values, range_of(question), 1.0 - 2.0 * question.alpha).known_interval();
  return interval ? std::optional(interval->low) : std::nullopt;
}

std::string question_words(const PrimaryQuestion& question, const Outcomes& outcomes) {
  const std::string& first = outcomes.methods[question.first];
  if (is_difference(question)) {
    return fmt::format("mean over participants of the accuracy with {} less that with {}", first,
                       outcomes.methods[question.second]);
  }
  return fmt::format("mean over participants of the accuracy with {}, against chance ({:.1f}%)",
                     first, 100.0 / static_cast<double>(outcomes.classes.size()));
}

}  // namespace

std::optional<PrimaryQuestion> primary_question(const design::Study& study, int methods) {
  if (study.registration.analysis) return registered_question(study);
  if (methods > 2) return std::nullopt;
  PrimaryQuestion question;
  if (methods == 2) {
    question.estimand = Estimand::difference;
    question.test = design::RegisteredTest::sign_flip;
    question.sides = Sides::two;
  }
  return question;
}

double null_of(const PrimaryQuestion& question, int classes) {
  return is_difference(question) ? 0.0 : 1.0 / classes;
}

std::string test_words(const PrimaryQuestion& question) {
  const char* const test = question.test == design::RegisteredTest::sign_flip
                               ? "sign flips over participants"
                           : is_difference(question) ? "paired t test over participants"
                                                     : "one-sample t test over participants";
  return fmt::format("{}, {}", test, question.sides == Sides::one ? "one-sided" : "two-sided");
}

std::optional<double> primary_p(const PrimaryQuestion& question, int classes,
                                std::span<const double> values) {
  if (question.test == design::RegisteredTest::sign_flip) {
    return sign_flip_p(values, question.sides);
  }
  return t_test_p(values, null_of(question, classes), question.sides);
}

std::vector<double> primary_values(const PrimaryQuestion& question, const Outcomes& outcomes) {
  Selection counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) counted.sessions.insert(session.row.session);
  }
  return values_of(question, outcomes, counted).values;
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
                       .smallest_effect = question->smallest_effect};
  for (const Selection& selection : selections(outcomes)) {
    const SelectedValues selected = values_of(*question, outcomes, selection);
    if (result.choices.empty()) {
      result.p = primary_p(*question, classes, selected.values);
      result.bound = bound_of(*question, selected.values);
    }
    result.choices.push_back(primary_choice(*question, selection, selected));
  }
  const StudyCourse course = course_of(outcomes, result.registered().participants);
  if (const auto& registered = outcomes.design.registration.analysis) {
    result.level = level_of(result, course, registered->spending);
  }
  judge(result, course);
  return result;
}

}  // namespace touchtrial::analysis::identification
