#include "analysis/statistics/paired_tests.hpp"
#include "protocols/threshold/analysis/report_parts.hpp"

#include <functional>
#include <map>

#include <boost/math/distributions/binomial.hpp>

namespace touchtrial::analysis::threshold {
namespace {

void count_answer(Proportion& answers, bool right) {
  ++answers.n;
  answers.correct += right ? 1 : 0;
}

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
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < people.size(); ++i) people[i].p_holm = adjusted[i];
}

std::optional<OutsideTracks> outside_tracks(
    std::span<const Person> people, double guess,
    const std::function<bool(const TrialOutcome&)>& is_one) {
  OutsideTracks outside;
  Proportion all;
  for (const Person& person : people) {
    Proportion own;
    for (const TrialOutcome* trial : person.trials) {
      if (is_one(*trial)) count_answer(own, trial->correct());
    }
    if (own.n == 0) continue;
    outside.people.push_back(right_answers(person.name, own, guess));
    all.n += own.n;
    all.correct += own.correct;
  }
  if (all.n == 0) return std::nullopt;
  outside.pooled = right_answers("", all, guess);
  adjust_by_holm(outside.people);
  return outside;
}

/// How often each choice was named and was right, in the trials of one participant's tracks.
struct OwnUse {
  std::vector<int> named;
  std::vector<int> targets;
  int n = 0;
};

bool is_choice(std::optional<int> choice, std::size_t choices) {
  return choice && *choice >= 0 && static_cast<std::size_t>(*choice) < choices;
}

OwnUse own_use(const Person& person, std::size_t choices) {
  OwnUse use{std::vector<int>(choices), std::vector<int>(choices)};
  for (const TrialOutcome* trial : person.trials) {
    if (!in_track(*trial) || !is_choice(trial->response, choices) ||
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

/// Trials of the tracks after any trial but those of the control block, which has no hand.
std::vector<AnswerPair> pairs_of_answers(const Person& person) {
  std::vector<AnswerPair> pairs;
  const TrialOutcome* before = nullptr;
  for (const TrialOutcome* trial : person.trials) {
    const bool follows =
        before != nullptr && before->row.session == trial->row.session && in_track(*trial);
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

OwnRepetition own_repetition(const Person& person, bool after) {
  std::map<int, int> named;
  int n = 0;
  for (const TrialOutcome* trial : person.trials) {
    if (in_control(*trial)) continue;
    ++named[*trial->response];
    ++n;
  }
  OwnRepetition own;
  for (const AnswerPair& pair : pairs_of_answers(person)) {
    if (pair.before->correct() != after) continue;
    count_answer(own.repeats, pair.trial->response == pair.before->response);
    own.expected += static_cast<double>(named[*pair.before->response] - 1) / (n - 1);
  }
  return own;
}

}  // namespace

std::optional<OutsideTracks> control_of(std::span<const Person> people, double guess) {
  return outside_tracks(people, guess, in_control);
}

std::optional<OutsideTracks> catches_of(std::span<const Person> people, double guess) {
  return outside_tracks(people, guess, [](const TrialOutcome& trial) {
    return trial.role == study::Role::catch_trial;
  });
}

std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                     const std::vector<std::string>& choices) {
  std::vector<ChoiceUse> all(choices.size());
  std::vector<std::vector<double>> excess(choices.size());
  for (const Person& person : people) {
    const OwnUse own = own_use(person, choices.size());
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

Repetition repetition_of(std::span<const Person> people, bool after) {
  Repetition all;
  double expected = 0.0;
  std::vector<double> excess;
  for (const Person& person : people) {
    const OwnRepetition own = own_repetition(person, after);
    if (own.repeats.n == 0) continue;
    all.repeats.n += own.repeats.n;
    all.repeats.correct += own.repeats.correct;
    expected += own.expected;
    excess.push_back((own.repeats.correct - own.expected) / own.repeats.n);
  }
  if (all.repeats.n > 0) all.expected = expected / all.repeats.n;
  all.excess = group_test(excess);
  return all;
}

}  // namespace touchtrial::analysis::threshold
