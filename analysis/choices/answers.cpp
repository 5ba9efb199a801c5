#include "analysis/choices/answers.hpp"

#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <limits>
#include <map>

#include <boost/math/distributions/binomial.hpp>

namespace touchtrial::choices {
namespace {

/// The probability of as many right answers or more by guessing.
std::optional<double> p_of_guessing(const Proportion& answers, double guess) {
  if (answers.n == 0) return std::nullopt;
  if (answers.correct == 0) return 1.0;
  const boost::math::binomial guessing(answers.n, guess);
  return boost::math::cdf(boost::math::complement(guessing, answers.correct - 1));
}

RightAnswers right_answers(const std::string& participant, const Proportion& answers,
                           double guess) {
  return {
      participant, answers, clopper_pearson_interval(answers), p_of_guessing(answers, guess), {}};
}

void adjust_by_holm(std::vector<RightAnswers>& people) {
  std::vector<double> p;
  for (const RightAnswers& one : people) p.push_back(one.p.value_or(1.0));
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < people.size(); ++i) people[i].p_holm = adjusted[i];
}

/// How often each choice was named and was right, in some trials of one participant.
struct OwnUse {
  std::vector<int> named;
  std::vector<int> targets;
  int n = 0;
};

bool is_choice(std::optional<int> choice, std::size_t choices) {
  return choice && *choice >= 0 && static_cast<std::size_t>(*choice) < choices;
}

OwnUse own_use(const Person& person, std::size_t choices, const Which& which) {
  OwnUse use{std::vector<int>(choices), std::vector<int>(choices)};
  for (const TrialOutcome* trial : person.trials) {
    if (!which(*trial) || !is_choice(trial->response, choices) ||
        !is_choice(trial->right, choices)) {
      continue;
    }
    ++use.named[static_cast<std::size_t>(*trial->response)];
    ++use.targets[static_cast<std::size_t>(*trial->right)];
    ++use.n;
  }
  return use;
}

/// One answer of a participant and the one just before it.
struct AnswerPair {
  const TrialOutcome* before = nullptr;
  const TrialOutcome* trial = nullptr;
};

bool in_control(const TrialOutcome& trial) {
  return trial.role == study::Role::control;
}

std::vector<AnswerPair> pairs_of_answers(const Person& person, const Which& which) {
  std::vector<AnswerPair> pairs;
  const TrialOutcome* before = nullptr;
  for (const TrialOutcome* trial : person.trials) {
    const bool follows =
        before != nullptr && before->row.session == trial->row.session && which(*trial);
    if (follows) pairs.push_back({before, trial});
    before = in_control(*trial) ? nullptr : trial;
  }
  return pairs;
}

/// The repetitions of one participant, and the share that shuffled answers would give.
struct OwnRepetition {
  Proportion repeats;
  double expected = 0.0;  ///< sum over trials
};

OwnRepetition own_repetition(const Person& person, bool after, const Which& which) {
  std::map<int, int> named;
  int n = 0;
  for (const TrialOutcome* trial : person.trials) {
    if (in_control(*trial)) continue;
    ++named[*trial->response];
    ++n;
  }
  OwnRepetition own;
  for (const AnswerPair& pair : pairs_of_answers(person, which)) {
    if (pair.before->correct() != after) continue;
    own.repeats.add(pair.trial->response == pair.before->response);
    own.expected += static_cast<double>(named[*pair.before->response] - 1) / (n - 1);
  }
  return own;
}

}  // namespace

MeanEstimate unbounded_mean(std::span<const double> values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return analysis::participant_mean(values, {-kInfinity, kInfinity});
}

GroupTest group_test(std::span<const double> values) {
  return {unbounded_mean(values), analysis::t_test_p(values, 0.0, analysis::Sides::two)};
}

std::optional<AgainstGuessing> against_guessing(std::span<const Person> people, double guess,
                                                const Which& which) {
  AgainstGuessing found;
  Proportion all;
  for (const Person& person : people) {
    Proportion own;
    for (const TrialOutcome* trial : person.trials) {
      if (which(*trial)) own.add(trial->correct());
    }
    if (own.n == 0) continue;
    found.people.push_back(right_answers(person.name, own, guess));
    all += own;
  }
  if (all.n == 0) return std::nullopt;
  found.pooled = right_answers("", all, guess);
  adjust_by_holm(found.people);
  return found;
}

std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                     const std::vector<std::string>& choices, const Which& which) {
  std::vector<ChoiceUse> all(choices.size());
  std::vector<std::vector<double>> excess(choices.size());
  for (const Person& person : people) {
    const OwnUse own = own_use(person, choices.size(), which);
    if (own.n == 0) continue;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      all[i].named += own.named[i];
      all[i].targets += own.targets[i];
      excess[i].push_back(static_cast<double>(own.named[i] - own.targets[i]) / own.n);
    }
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    all[i].choice = choices[i];
    all[i].excess = group_test(excess[i]);
  }
  return all;
}

Repetition repetition_of(std::span<const Person> people, bool after, const Which& which) {
  Repetition all;
  double expected = 0.0;
  std::vector<double> excess;
  for (const Person& person : people) {
    const OwnRepetition own = own_repetition(person, after, which);
    if (own.repeats.n == 0) continue;
    all.repeats += own.repeats;
    expected += own.expected;
    excess.push_back((own.repeats.correct - own.expected) / own.repeats.n);
  }
  if (all.repeats.n > 0) all.expected = expected / all.repeats.n;
  all.excess = group_test(excess);
  return all;
}

}  // namespace touchtrial::choices
