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

/// The probability that guessing gives at least as many right answers.
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
  for (const RightAnswers& person : people) p.push_back(person.p.value_or(1.0));
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < people.size(); ++i) people[i].p_holm = adjusted[i];
}

/// The one-sided p of 0, 1, .. n right answers.
std::vector<double> p_by_count(int n, double guess) {
  std::vector<double> p;
  for (int right = 0; right <= n; ++right) p.push_back(*p_of_guessing({n, right}, guess));
  return p;
}

/// Draws a number of right answers of a guesser.
/// \param uniform  in (0, 1]
int guessed_count(const std::vector<double>& p, double uniform) {
  const auto above =
      std::ranges::partition_point(p, [&](double value) { return value >= uniform; });
  return static_cast<int>(above - p.begin()) - 1;
}

/// How often each choice was named and was right, in trials of one participant.
struct ChoiceCounts {
  std::vector<int> answer_counts;
  std::vector<int> target_counts;
  int n = 0;
};

bool is_choice(std::optional<int> choice, std::size_t choices) {
  return choice && *choice >= 0 && static_cast<std::size_t>(*choice) < choices;
}

ChoiceCounts choice_counts(const Person& person, std::size_t choices,
                           const TrialFilter& is_included) {
  ChoiceCounts counts{std::vector<int>(choices), std::vector<int>(choices)};
  for (const TrialOutcome* trial : person.trials) {
    if (!is_included(*trial) || !is_choice(trial->response, choices) ||
        !is_choice(trial->right, choices)) {
      continue;
    }
    ++counts.answer_counts[static_cast<std::size_t>(*trial->response)];
    ++counts.target_counts[static_cast<std::size_t>(*trial->right)];
    ++counts.n;
  }
  return counts;
}

/// One answer of a participant and the previous one.
struct AnswerPair {
  const TrialOutcome* previous = nullptr;
  const TrialOutcome* trial = nullptr;
};

bool is_control_trial(const TrialOutcome& trial) {
  return trial.role == study::Role::control;
}

std::vector<AnswerPair> answer_pairs(const Person& person, const TrialFilter& is_included) {
  std::vector<AnswerPair> pairs;
  const TrialOutcome* previous_trial = nullptr;
  for (const TrialOutcome* trial : person.trials) {
    const bool is_pair = previous_trial != nullptr &&
                         previous_trial->row.session == trial->row.session && is_included(*trial);
    if (is_pair) pairs.push_back({previous_trial, trial});
    previous_trial = is_control_trial(*trial) ? nullptr : trial;
  }
  return pairs;
}

/// The repetitions of one participant.
struct RepetitionCount {
  Proportion repeats;
  double expected = 0.0;  ///< number of repetitions if answers were shuffled
};

RepetitionCount repetitions_of(const Person& person, bool after_right,
                               const TrialFilter& is_included) {
  std::map<int, int> answer_counts;
  int n = 0;
  for (const TrialOutcome* trial : person.trials) {
    if (is_control_trial(*trial)) continue;
    ++answer_counts[*trial->response];
    ++n;
  }
  RepetitionCount count;
  for (const AnswerPair& pair : answer_pairs(person, is_included)) {
    if (pair.previous->correct() != after_right) continue;
    count.repeats.add(pair.trial->response == pair.previous->response);
    count.expected += static_cast<double>(answer_counts[*pair.previous->response] - 1) / (n - 1);
  }
  return count;
}

}  // namespace

MeanEstimate unbounded_mean(std::span<const double> values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return analysis::participant_mean(values, {-kInfinity, kInfinity});
}

GroupTest group_test(std::span<const double> values) {
  GroupTest test{unbounded_mean(values), analysis::t_test_p(values, 0.0, analysis::Sides::two)};
  test.all_equal = test.p && analysis::without_noise(test.mean.sd.value_or(1.0)) == 0.0;
  return test;
}

std::optional<GuessingTests> test_against_guessing(std::span<const Person> people, double guess,
                                                   const TrialFilter& is_included) {
  GuessingTests tests;
  Proportion all;
  for (const Person& person : people) {
    Proportion answers;
    for (const TrialOutcome* trial : person.trials) {
      if (is_included(*trial)) answers.add(trial->correct());
    }
    if (answers.n == 0) continue;
    tests.people.push_back(right_answers(person.name, answers, guess));
    all += answers;
  }
  if (all.n == 0) return std::nullopt;
  tests.pooled = right_answers("", all, guess);
  adjust_by_holm(tests.people);
  return tests;
}

GlobalNullResult test_anyone_above_chance(const GuessingTests& answers, double guess, int deals) {
  analysis::GlobalNullTest test(static_cast<int>(answers.people.size()), deals);
  std::vector<double> right_answers_by_deal(static_cast<std::size_t>(deals) + 1);
  for (std::size_t i = 0; i < answers.people.size(); ++i) {
    const Proportion& observed = answers.people[i].answers;
    const std::vector<double> p_by_right = p_by_count(observed.n, guess);
    RandomStream random(0, "anybody better than guessing", i);
    std::vector<double> p;
    for (double& sum : right_answers_by_deal) {
      const int right =
          p.empty() ? observed.correct : guessed_count(p_by_right, 1.0 - random.uniform());
      p.push_back(p_by_right[static_cast<std::size_t>(right)]);
      sum += right;
    }
    test.add(p);
  }
  return test.result(right_answers_by_deal);
}

std::vector<std::string> people_above_chance(const GuessingTests& answers,
                                             const GlobalNullResult& global_null) {
  std::vector<std::string> names;
  if (!global_null.found()) return names;
  for (const RightAnswers& person : answers.people) {
    if (person.p.value_or(1.0) <= analysis::kSignificanceLevel) names.push_back(person.participant);
  }
  return names;
}

DetectableAccuracy detectable_accuracy(const GuessingTests& answers, double guess) {
  DetectableAccuracy detectable;
  if (answers.people.empty()) return detectable;
  detectable.trials = std::ranges::min(answers.people, {}, [](const RightAnswers& person) {
                        return person.answers.n;
                      }).answers.n;
  const double level = analysis::kSignificanceLevel / static_cast<double>(answers.people.size());
  const std::vector<double> p = p_by_count(detectable.trials, guess);
  const auto first_sufficient =
      std::ranges::find_if(p, [&](double value) { return value <= level; });
  if (first_sufficient == p.end()) return detectable;
  detectable.right = static_cast<int>(first_sufficient - p.begin());
  detectable.share = boost::math::ibeta_inv(
      static_cast<double>(detectable.right),
      static_cast<double>(detectable.trials - detectable.right + 1), kDetectionPower);
  return detectable;
}

bool Attention::is_doubtful() const noexcept {
  return p_holm <= analysis::kSignificanceLevel;
}

std::vector<Attention> attention_of(const GuessingTests& catches) {
  std::vector<Attention> all;
  std::vector<double> p;
  for (const RightAnswers& person : catches.people) {
    const boost::math::binomial attending(person.answers.n, kMinCatchAccuracy);
    p.push_back(boost::math::cdf(attending, person.answers.correct));
    all.push_back({person.participant, p.back()});
  }
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_holm = adjusted[i];
  return all;
}

std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                     const std::vector<std::string>& choices,
                                     const TrialFilter& is_included) {
  std::vector<ChoiceUse> all(choices.size());
  std::vector<std::vector<double>> excess(choices.size());
  for (const Person& person : people) {
    const ChoiceCounts counts = choice_counts(person, choices.size(), is_included);
    if (counts.n == 0) continue;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      all[i].named_count += counts.answer_counts[i];
      all[i].target_count += counts.target_counts[i];
      excess[i].push_back(static_cast<double>(counts.answer_counts[i] - counts.target_counts[i]) /
                          counts.n);
    }
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    all[i].choice = choices[i];
    all[i].excess = group_test(excess[i]);
  }
  return all;
}

Repetition repetition_of(std::span<const Person> people, bool after_right,
                         const TrialFilter& is_included) {
  Repetition all;
  double expected = 0.0;
  std::vector<double> excess;
  for (const Person& person : people) {
    const RepetitionCount count = repetitions_of(person, after_right, is_included);
    if (count.repeats.n == 0) continue;
    all.repeats += count.repeats;
    expected += count.expected;
    excess.push_back((count.repeats.correct - count.expected) / count.repeats.n);
  }
  if (all.repeats.n > 0) all.expected = expected / all.repeats.n;
  all.excess = group_test(excess);
  return all;
}

}  // namespace touchtrial::choices
