/// \file The registered question and its answer. Docs: docs/statistics.md, "The registered
/// question".
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/crossover.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/strata.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

enum class Verdict {
  supported,       ///< the registered test rejects in the registered direction
  not_supported,   ///< it does not, and the smallest relevant effect is excluded or not stated
  undecided,       ///< the registered test cannot decide
  estimated,       ///< only an estimate was registered
  not_registered,  ///< no question was registered
};

/// "supported", "not supported", "undecided", "estimated", "not registered"
[[nodiscard]] std::string name_of(Verdict verdict);

/// The estimate for one selection of sessions and trials.
struct PrimaryChoice {
  std::string name;   ///< Selection::name
  std::string words;  ///< what it excludes
  int participants = 0;
  int trials = 0;
  std::optional<double> estimate{};
  std::optional<Interval> interval{};  ///< at PrimaryResult::interval_level
  std::string pair{};  ///< of an equality: the difference with the largest estimate, in words
};

/// A difference of an equality.
struct PrimaryPair {
  std::string words;  ///< "bark, standard -18 dB, less bark, standard -12 dB"
  int participants = 0;
  std::optional<double> estimate{};
  std::optional<Interval> interval{};
  std::optional<double> p{};  ///< the larger of two one-sided p
};

struct AboveChance {
  std::string method;
  std::optional<double> mean{};  ///< mean accuracy
  std::optional<double> p{};     ///< of the one-sided t test against chance
};

/// The question that decides a study, and its answer. Values are shares of right answers, or dB of
/// thresholds (study::is_threshold_estimand).
struct PrimaryResult {
  study::Estimand estimand = study::Estimand::mean_accuracy;
  std::string words;  ///< the estimand with the study's labels
  std::string test;   ///< in words
  double null = 0.0;  ///< the estimand under the null hypothesis
  Sides sides = Sides::one;
  double alpha = 0.05;
  double level = 0.05;           ///< the maximum p; below alpha at and after an interim look
  double interval_level = 0.95;  ///< 1 - alpha, or 1 - 2 alpha with a margin
  std::optional<double> smallest_effect{};
  std::optional<double> margin{};         ///< of non-inferiority (null: -margin) or equality
  std::optional<double> p{};              ///< of the registered choice
  std::optional<TStatistic> statistic{};  ///< of the registered choice
  std::optional<double> bound{};          ///< the lower limit of a one-sided test
  std::vector<PrimaryChoice> choices{};   ///< the registered one first
  /// The period-adjusted test of the registered choice.
  std::optional<CrossoverEstimate> crossover{};
  std::optional<CrossoverPermutation> permutation{};
  std::vector<PrimaryPair> pairs{};  ///< of an equality: all differences, for the registered choice
  /// Tests of the registered choice against chance, for non-inferiority: two methods at chance are
  /// not equally good.
  std::vector<AboveChance> above_chance{};
  /// Why no conclusion is possible regardless of the test, as a sentence; may be empty.
  std::string obstacle{};
  std::string note{};  ///< a sentence on the estimate; may be empty
  Verdict verdict = Verdict::not_registered;
  std::string reason{};        ///< for the verdict, in one or more sentences
  bool ended_at_look = false;  ///< collection ended at a registered look
  /// The registered choice with stations as strata, at interval_level; nothing with one station.
  std::optional<StratifiedMean> stations{};

  [[nodiscard]] const PrimaryChoice& registered() const { return choices.front(); }
  [[nodiscard]] bool is_difference() const { return estimand == study::Estimand::difference; }
  [[nodiscard]] bool is_estimate() const { return estimand == study::Estimand::mean_threshold; }
  [[nodiscard]] bool is_equality() const { return estimand == study::Estimand::threshold_equality; }
  [[nodiscard]] bool has_thresholds() const { return study::is_threshold_estimand(estimand); }
};

/// The numbers of people and looks on which a verdict depends.
struct StudyCourse {
  int planned = 0;    ///< participants; 0: not stated
  int completed = 0;  ///< participants with a completed session, even if excluded later
  int analysed = 0;   ///< participants of the registered choice
  bool closed = false;
  bool pilot = false;
  bool has_registration = false;
  int unregistered_looks = 0;
  int excluded_afterwards = 0;          ///< sessions excluded after outcomes were seen
  bool at_registered_look = false;      ///< the report is of a registered interim look
  std::vector<int> registered_looks{};  ///< numbers of participants at the looks so far, ascending
  /// If all completed sessions were excluded: "4 by a registered rule (more than 5 missed catch
  /// trials)". Otherwise empty.
  std::string exclusion_of_all{};
};

[[nodiscard]] StudyCourse course_of(const Outcomes& outcomes, int analysed);

/// The maximum p: alpha, or the nominal Lan-DeMets level if registered looks were made; then at
/// least 1e-9, so that an interval of this level exists.
[[nodiscard]] double level_of(const PrimaryResult& result, const StudyCourse& course,
                              study::Spending spending);

/// Sets `verdict` and `reason`. The verdict is undecided
/// - if all participants were left out, or had one order of two methods in blocks;
/// - if the result has an obstacle, or too few participants for test or interval;
/// - if the study is open, or ended before its planned number of participants;
/// - if p <= level after an unregistered look, or after a registered look with more
///   participants than planned;
/// - if p > level, and the interval contains the smallest relevant effect, is not below -margin, or
///   does not exist;
/// - if an equality is not shown, and no difference is beyond the margin;
/// - if non-inferiority would follow, but a method is not shown to be above chance.
/// \pre result has at least one choice
void set_verdict(PrimaryResult& result, const StudyCourse& course);

}  // namespace touchtrial::analysis
