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
  supported,       ///< the registered test rejects, in the registered direction
  not_supported,   ///< it does not, and the smallest relevant effect is excluded, or was not stated
  undecided,       ///< the study cannot tell, or not by the registered test
  estimated,       ///< an estimate was registered, without a test
  not_registered,  ///< nothing was registered that could be decided
};

/// "supported", "not supported", "undecided", "estimated", "not registered"
[[nodiscard]] std::string name_of(Verdict verdict);

/// The estimate under one choice of sessions and trials.
struct PrimaryChoice {
  std::string name;   ///< Selection::name
  std::string words;  ///< what it leaves out
  int participants = 0;
  int trials = 0;
  std::optional<double> estimate{};
  std::optional<Interval> interval{};  ///< at PrimaryResult::interval_level
  /// Of an equality: the difference that reaches furthest from 0, in words; the estimate is its.
  std::string pair{};
};

/// One of the differences of an equality.
struct PrimaryPair {
  std::string words;  ///< "bark, standard -18 dB, less bark, standard -12 dB"
  int participants = 0;
  std::optional<double> estimate{};
  std::optional<Interval> interval{};
  std::optional<double> p{};  ///< the larger one of the two one-sided tests
};

/// Whether people are above chance with a method.
struct AboveChance {
  std::string method;
  std::optional<double> mean{};  ///< accuracy
  std::optional<double> p{};     ///< of the one-sided t test against chance
};

/// The question that decides a study, and its answer. Values are shares of right answers, or dB of
/// thresholds (study::is_of_thresholds).
struct PrimaryResult {
  study::Estimand estimand = study::Estimand::mean_accuracy;
  std::string words;  ///< the estimand with the study's labels
  std::string test;   ///< in words
  double null = 0.0;  ///< the estimand under the null hypothesis
  Sides sides = Sides::one;
  double alpha = 0.05;
  double level = 0.05;  ///< that p must not exceed; less than alpha at an interim look or after one
  double interval_level = 0.95;  ///< 1 - alpha, or 1 - 2 alpha with a margin
  std::optional<double> smallest_effect{};
  std::optional<double> margin{};  ///< of non-inferiority, whose null is -margin, or equality
  std::optional<double> p{};       ///< of the registered choice
  std::optional<TStatistic> statistic{};  ///< of the registered choice, if there is a t
  std::optional<double> bound{};          ///< one-sided: the lower limit that goes with the test
  std::vector<PrimaryChoice> choices{};   ///< the registered one first
  /// Of the registered choice, if the test is the period-adjusted one.
  std::optional<CrossoverEstimate> crossover{};
  std::optional<CrossoverPermutation> permutation{};
  std::vector<PrimaryPair> pairs{};  ///< of an equality: all differences, of the registered choice
  /// Of non-inferiority, by the registered choice: two methods at chance are not equally good.
  std::vector<AboveChance> above_chance{};
  /// Why no conclusion is possible, whatever the test, in a sentence; may be empty.
  std::string nothing_follows{};
  std::string note{};  ///< what belongs to the estimate, in a sentence; may be empty
  Verdict verdict = Verdict::not_registered;
  std::string because{};       ///< why, in one sentence or more
  bool ended_at_look = false;  ///< collecting ended at a registered look, as registered
  /// The registered choice with stations as strata, at interval_level; nothing unless the study
  /// was collected from two stations or more.
  std::optional<StratifiedMean> stations{};

  [[nodiscard]] const PrimaryChoice& registered() const { return choices.front(); }
};

/// The numbers of people and looks on which a verdict depends, besides the estimate.
struct StudyCourse {
  int planned = 0;    ///< participants; 0: not stated
  int completed = 0;  ///< participants with a completed session, left out later or not
  int analysed = 0;   ///< participants of the registered choice
  bool closed = false;
  bool pilot = false;
  bool has_registration = false;
  int unregistered_looks = 0;
  int excluded_afterwards = 0;          ///< sessions excluded after outcomes were seen
  bool at_registered_look = false;      ///< the report is of an interim look that was registered
  std::vector<int> registered_looks{};  ///< participants at those that were made, ascending
  /// By what every completed session was left out: "4 by a registered rule (more than 5 missed
  /// catch trials)"; empty unless all were.
  std::string all_left_out{};
};

[[nodiscard]] StudyCourse course_of(const Outcomes& outcomes, int analysed);

/// The level that p must not exceed: alpha, or the nominal level by Lan and DeMets if registered
/// looks were made; then at least 1e-9, so that there is an interval of this level.
[[nodiscard]] double level_of(const PrimaryResult& result, const StudyCourse& course,
                              study::Spending spending);

/// Decides on the registered question: sets `verdict` and `because`.
///
/// It is undecided if all participants were left out or had one order of two methods in blocks, if
/// nothing follows
/// from the data, if the test or the interval needs more participants, if the study is open, ended
/// before its planned number of participants, or has a p that is within its level after an
/// unregistered look, or after a registered one with more participants than planned; and if p is
/// above its level while the interval contains the smallest relevant effect, does not lie below
/// minus the margin, or does not exist; or if an equality is not shown, and no difference lies
/// beyond its margin; or if a method seems as good that is not shown to be above chance, or whose
/// rival is not.
/// \pre result has at least one choice
void judge(PrimaryResult& result, const StudyCourse& course);

}  // namespace touchtrial::analysis
