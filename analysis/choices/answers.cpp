#include "analysis/choices/answers.hpp"

#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/common.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>

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

/// The one-sided p of 0, 1, .. right answers of n.
std::vector<double> p_by_count(int n, double guess) {
  std::vector<double> p;
  for (int right = 0; right <= n; ++right) p.push_back(*p_of_guessing({n, right}, guess));
  return p;
}

/// The number of right answers by guessing for a uniform number in (0, 1].
int count_of(const std::vector<double>& p, double uniform) {
  const auto above = std::ranges::partition_point(p, [&](double one) { return one >= uniform; });
  return static_cast<int>(above - p.begin()) - 1;
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

/// One answer of a participant and the previous one.
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
  GroupTest test{unbounded_mean(values), analysis::t_test_p(values, 0.0, analysis::Sides::two)};
  test.alike = test.p && analysis::without_noise(test.mean.sd.value_or(1.0)) == 0.0;
  return test;
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

GlobalNullResult test_anyone_above_chance(const AgainstGuessing& answers, double guess, int deals) {
  analysis::GlobalNullTest test(static_cast<int>(answers.people.size()), deals);
  std::vector<double> together(static_cast<std::size_t>(deals) + 1);
  for (std::size_t i = 0; i < answers.people.size(); ++i) {
    const Proportion& own = answers.people[i].answers;
    const std::vector<double> p_of = p_by_count(own.n, guess);
    RandomStream random(0, "anybody better than guessing", i);
    std::vector<double> p;
    for (double& sum : together) {
      const int right = p.empty() ? own.correct : count_of(p_of, 1.0 - random.uniform());
      p.push_back(p_of[static_cast<std::size_t>(right)]);
      sum += right;
    }
    test.add(p);
  }
  return test.result(together);
}

std::vector<std::string> people_above_chance(const AgainstGuessing& answers,
                                             const GlobalNullResult& anybody) {
  std::vector<std::string> names;
  if (!anybody.found()) return names;
  for (const RightAnswers& one : answers.people) {
    if (one.p.value_or(1.0) <= analysis::kSignificanceLevel) names.push_back(one.participant);
  }
  return names;
}

Detectable detectable_in(const AgainstGuessing& answers, double guess) {
  Detectable found;
  if (answers.people.empty()) return found;
  found.trials = std::ranges::min(answers.people, {}, [](const RightAnswers& one) {
                   return one.answers.n;
                 }).answers.n;
  const double level = analysis::kSignificanceLevel / static_cast<double>(answers.people.size());
  const std::vector<double> p = p_by_count(found.trials, guess);
  const auto enough = std::ranges::find_if(p, [&](double one) { return one <= level; });
  if (enough == p.end()) return found;
  found.right = static_cast<int>(enough - p.begin());
  found.share =
      boost::math::ibeta_inv(static_cast<double>(found.right),
                             static_cast<double>(found.trials - found.right + 1), kFoundWith);
  return found;
}

bool Attention::is_doubtful() const noexcept {
  return p_holm <= analysis::kSignificanceLevel;
}

std::vector<Attention> attention_of(const AgainstGuessing& catches) {
  std::vector<Attention> all;
  std::vector<double> p;
  for (const RightAnswers& one : catches.people) {
    const boost::math::binomial attending(one.answers.n, kAttentive);
    p.push_back(boost::math::cdf(attending, one.answers.correct));
    all.push_back({one.participant, p.back()});
  }
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_holm = adjusted[i];
  return all;
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
