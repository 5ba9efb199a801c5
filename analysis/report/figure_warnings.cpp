#include "analysis/report/figure_warnings.hpp"

#include "analysis/text_figures.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

using Warnings = std::vector<std::string>;

constexpr int kSmallCell = 5;
constexpr std::size_t kMostNames = 5;
/// Of trials at random the best of 5! exchanges of labels is some 18 points above accuracy.
constexpr double kSuspectGain = 0.3;
constexpr double kSuspectShare = 0.5;
constexpr double kCeiling = 0.95;

/// The first few names of many.
std::string few(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kMostNames);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

void warn_of_small_classes(const MethodReport& method, const std::vector<std::string>& classes,
                           Warnings& warnings) {
  std::vector<std::string> small;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const int n = method.accuracy[i].accuracy.n;
    if (n > 0 && n <= kSmallCell) small.push_back(classes[i]);
  }
  if (small.empty()) return;
  warnings.push_back(
      fmt::format("{}: the interval of {} rests on {} trials or fewer and is nearly uninformative: "
                  "even 5 of 5 has 56.6 to 100 % (Wilson).",
                  method.method, few(small), kSmallCell));
}

void warn_of_unanswered_classes(const MethodReport& method, const std::vector<std::string>& classes,
                                Warnings& warnings) {
  if (method.confusion.answered() == 0) return;
  std::vector<std::string> never;
  for (int j = 0; j < method.confusion.classes(); ++j) {
    int column = 0;
    for (int i = 0; i < method.confusion.classes(); ++i) column += method.confusion.count(i, j);
    if (column == 0) never.push_back(classes[j]);
  }
  if (never.empty()) return;
  warnings.push_back(
      fmt::format("{}: {} was never answered; accuracy with it tells of a preference as much as of "
                  "sensitivity, and the choice model does not exist.",
                  method.method, few(never)));
}

bool suspect_swap(const ParticipantAccuracy& one) {
  const double accuracy = one.accuracy.share().value_or(0.0);
  const double matched = one.matching.accuracy.share().value_or(0.0);
  return matched >= kSuspectShare && matched - accuracy >= kSuspectGain;
}

void warn_of_swapped_labels(const MethodReport& method, Warnings& warnings) {
  std::vector<std::string> suspects;
  for (const ParticipantAccuracy& one : method.per_participant) {
    if (!suspect_swap(one)) continue;
    suspects.push_back(fmt::format("{} ({}, but {} under the best exchange)", one.participant,
                                   percent_of(one.accuracy), percent_of(one.matching.accuracy)));
  }
  if (suspects.empty()) return;
  warnings.push_back(
      fmt::format("{}: labels may have been swapped by {}; accuracy says less than consistency "
                  "there.",
                  method.method, few(suspects)));
}

void warn_of_chance(const MethodReport& method, Warnings& warnings) {
  if (!method.chance || method.chance->exact) return;
  const double floor = 1.0 / (method.chance->deals + 1.0);
  if (method.chance->p > 1.5 * floor) return;
  warnings.push_back(
      fmt::format("{}: the chance test's p = {} is the smallest that {} deals can give; the true "
                  "one may be smaller.",
                  method.method, p_value(method.chance->p), method.chance->deals));
}

void warn_of_ceiling(const MethodReport& method, Warnings& warnings) {
  const Proportion all = method.overall;
  if (all.n == 0) return;
  if (all.correct == all.n) {
    warnings.push_back(
        method.method +
        ": everything was right, so that d' has a lower bound alone and differences cannot show.");
  } else if (all.share().value_or(0.0) >= kCeiling) {
    warnings.push_back(fmt::format(
        "{}: {} right is close to the ceiling; d' and differences there hang on few trials.",
        method.method, percent_of(all)));
  }
}

void warn_of_choice_model(const MethodReport& method, Warnings& warnings) {
  if (!method.choice || method.choice->converged) return;
  warnings.push_back(method.method +
                     ": the choice model's estimates did not settle; do not quote them.");
}

/// Whether the headline hangs on trials that do not meet the study's own rule.
void warn_of_validity(const MethodReport& method, Warnings& warnings) {
  const auto of = [&](TrialSubset subset) {
    return std::ranges::find(method.robustness, subset, &SubsetAccuracy::subset);
  };
  const auto all = of(TrialSubset::counted);
  const auto valid = of(TrialSubset::valid);
  if (all == method.robustness.end() || valid == method.robustness.end()) return;
  const int invalid = all->pooled.n - valid->pooled.n;
  if (invalid == 0) return;
  if (!valid->mean.mean) {
    warnings.push_back(method.method + ": no trial at all is valid by the study's rule.");
    return;
  }
  warnings.push_back(fmt::format(
      "{}: without {} not valid by the study's rule the mean over participants is {} in place of "
      "{}.",
      method.method, counted(invalid, "trial"), percent_of_share(valid->mean.mean),
      percent_of_share(all->mean.mean)));
}

void warn_of_order(const Outcomes& outcomes, Warnings& warnings) {
  if (outcomes.design.trials.order != design::TrialOrder::uniform) return;
  warnings.emplace_back(
      "Classes were drawn independently, so that they came unequally often; pooled accuracy weighs "
      "them as they came.");
}

}  // namespace

std::vector<std::string> figure_warnings(const Outcomes& outcomes, const StudyReport& report) {
  Warnings warnings;
  for (const MethodReport& method : report.methods) {
    warn_of_validity(method, warnings);
    warn_of_swapped_labels(method, warnings);
    warn_of_small_classes(method, report.classes, warnings);
    warn_of_unanswered_classes(method, report.classes, warnings);
    warn_of_choice_model(method, warnings);
    warn_of_ceiling(method, warnings);
    warn_of_chance(method, warnings);
  }
  warn_of_order(outcomes, warnings);
  return warnings;
}

}  // namespace touchtrial::analysis
