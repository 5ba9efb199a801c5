#include "study/registration_words.hpp"

#include "core/text.hpp"
#include "study/study_sections.hpp"

#include <array>
#include <cmath>

namespace touchtrial::study {
namespace {

using Field = std::pair<std::string, std::string>;

/// The share in per cent, rounded so that 7.000000000000001 is written as 7.
std::string per_cent_text(double share) {
  return number_text(std::round(1e10 * share) / 1e8);
}

/// "bark at -18", or the part of it that the registration names.
std::string standard_words(const RegisteredStandard& standard) {
  if (!standard.value) return standard.label;
  return standard.label + (standard.label.empty() ? "" : " at ") + number_text(*standard.value);
}

std::string threshold_words(const RegisteredAnalysis& analysis) {
  std::vector<std::string> standards;
  for (const RegisteredStandard& standard : analysis.standards) {
    standards.push_back(standard_words(standard));
  }
  const std::string mean = "mean over participants of the threshold";
  switch (analysis.estimand) {
    case Estimand::mean_threshold:
      return mean + (standards.empty() ? "" : ", standard " + standards.front());
    case Estimand::threshold_difference:
      if (standards.empty()) return mean + " at the first standard minus that at the second";
      return mean + ", standard " + standards.front() + " minus standard " + standards.back();
    default:
      break;
  }
  return "equality of the thresholds of " +
         (standards.empty() ? "all standards" : "the standards " + listed(standards, " and ")) +
         ": means over participants of all pairwise differences";
}

std::string name_in_words(RegisteredTest test) {
  using enum RegisteredTest;
  static constexpr auto kNames = std::to_array<Named<RegisteredTest>>(
      {{"exact sign flips over participants", sign_flip},
       {"period-adjusted t test over participants (period differences compared between the two "
        "orders of methods), checked by a permutation of orders within the blocks in which they "
        "were assigned",
        crossover},
       {"Student's t test over participants", t}});
  return std::string(name_in(kNames, test));
}

Field margin_field(const RegisteredAnalysis& analysis) {
  const std::string level = per_cent_text(1.0 - 2.0 * analysis.alpha) + " %";
  if (is_threshold_estimand(analysis.estimand)) {
    return {"margin", "equal if every difference is less than " + number_text(*analysis.margin) +
                          " dB either way; decided by the " + level +
                          " intervals; no conclusion is drawn if more than half of the "
                          "participants have no threshold at one of the standards"};
  }
  return {"margin", "as good if worse by less than " + per_cent_text(*analysis.margin) +
                        " points; decided by the " + level +
                        " t interval, and only if both methods are above chance"};
}

}  // namespace

std::string estimand_words(const RegisteredAnalysis& analysis) {
  if (is_threshold_estimand(analysis.estimand)) return threshold_words(analysis);
  if (analysis.estimand == Estimand::mean_accuracy) {
    return "mean over participants of the proportion of right answers, against chance";
  }
  const std::string methods =
      analysis.methods.empty()
          ? " with the first method minus that with the second"
          : " with " + analysis.methods[0] + " minus that with " + analysis.methods[1];
  return "mean over participants of the accuracy" + methods;
}

std::string test_words(const RegisteredAnalysis& analysis) {
  if (analysis.estimand == Estimand::mean_threshold) return "none: an estimate with its interval";
  if (analysis.estimand == Estimand::threshold_equality) {
    return name_in_words(analysis.test) +
           ", two one-sided for every difference, all of which must reject";
  }
  return name_in_words(analysis.test) + (analysis.one_sided ? ", one-sided" : ", two-sided");
}

std::string looks_words(const RegisteredAnalysis& analysis) {
  if (analysis.looks.empty()) return "none";
  std::vector<std::string> looks;
  for (const int look : analysis.looks) looks.push_back(std::to_string(look));
  return "at " + listed(looks, " and ") + " participants; levels by Lan and DeMets, spending of " +
         (analysis.spending == Spending::pocock ? "Pocock's" : "O'Brien and Fleming's") + " kind";
}

std::string rules_words(const ExclusionRules& rules) {
  std::vector<std::string> words = rules.deviations;
  for (std::string& code : words) code = "a deviation " + in_quotes(code);
  if (rules.invalid_trials) {
    words.push_back("more than " + per_cent_text(*rules.invalid_trials) + " % of trials not valid");
  }
  if (rules.missed_catch) {
    words.push_back("more than " + counted(*rules.missed_catch, "missed catch trial"));
  }
  if (words.empty()) return "none, except sessions stopped early and participants who withdrew";
  return "a session with " + listed(words, " or ") +
         "; in addition, sessions stopped early and participants who withdrew";
}

std::pair<std::string, std::string> size_field(const RegisteredAnalysis& analysis) {
  if (analysis.margin) return margin_field(analysis);
  const auto size = [&]() -> std::string {
    if (!analysis.smallest_effect) return "not stated";
    if (is_threshold_estimand(analysis.estimand))
      return number_text(*analysis.smallest_effect) + " dB";
    const bool is_accuracy = analysis.estimand == Estimand::mean_accuracy;
    return per_cent_text(*analysis.smallest_effect) + (is_accuracy ? " % right" : " points");
  };
  return {"smallest worth having", size()};
}

std::vector<std::pair<std::string, std::string>> fields_of(const Registration& registration) {
  if (!registration.analysis) return {};
  const RegisteredAnalysis& analysis = *registration.analysis;
  const Field size = size_field(analysis);
  std::vector<std::pair<std::string, std::string>> fields = {
      {"estimand", estimand_words(analysis)},
      {"test", test_words(analysis)},
      {"alpha", number_text(analysis.alpha)},
      size,
      {"interim looks", looks_words(analysis)},
      {"exclusion rules",
       analysis.exclusion_rules ? rules_words(*analysis.exclusion_rules) : "not stated"}};
  if (analysis.visits != RegisteredVisits::all) {
    const bool first = analysis.visits == RegisteredVisits::first;
    fields.emplace_back("visits", first ? "only the first" : "only the last");
  }
  return fields;
}

}  // namespace touchtrial::study
