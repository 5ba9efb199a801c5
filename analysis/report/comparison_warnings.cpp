#include "analysis/report/figure_warnings.hpp"
#include "analysis/statistics/sign_flip.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using Warnings = std::vector<std::string>;

constexpr int kFewParticipants = 10;
constexpr double kLevel = 0.05;

/// Of n participants all 2^n sign patterns are as likely, and Holm multiplies the least p of
/// several pairs by their number. Powers of two print exactly.
void warn_of_floor(int n, std::size_t pairs, Warnings& warnings) {
  const double floor = std::ldexp(2.0, -n);
  const double adjusted = std::min(1.0, floor * static_cast<double>(pairs));
  if (adjusted <= kLevel) return;
  std::string text =
      fmt::format("With {} the sign-flip p cannot fall below {}", counted(n, "participant"), floor);
  if (pairs > 1) text += fmt::format(", nor the least p adjusted by Holm below {}", adjusted);
  warnings.push_back(text + ", whatever the methods do.");
}

/// Of the pair with the fewest participants: the floor under its p.
void warn_of_sign_flips(const StudyReport& report, Warnings& warnings) {
  int n = 0;
  for (const MethodPair& pair : report.pairs) {
    const int own = pair.overall.participants;
    if (own > 0 && (n == 0 || own < n)) n = own;
  }
  if (n > 0) warn_of_floor(n, report.pairs.size(), warnings);
  const auto at_floor = [](const MethodPair& pair) {
    constexpr double kFloor = 1.5e-5;  // of 99,999 random patterns
    return pair.overall.participants > kExactSignFlips && pair.overall.p.value_or(1.0) < kFloor;
  };
  if (std::ranges::any_of(report.pairs, at_floor)) {
    warnings.emplace_back(
        "A sign-flip p of 1e-05 is the smallest that 99,999 random patterns can give; the true one "
        "may be smaller.");
  }
}

void warn_of_several(const StudyReport& report, Warnings& warnings) {
  if (report.methods.size() < 3) return;
  warnings.push_back(
      fmt::format("{} methods make {} pairs: quote the p adjusted by Holm; the p of single classes "
                  "are not adjusted.",
                  report.methods.size(), report.pairs.size()));
  if (report.together) {
    warnings.emplace_back(
        "Cochran's Q: its p under chi-square takes a participant's trials as independent; the p to "
        "quote is the permuted one.");
  }
}

void warn_of_images(const Outcomes& outcomes, const StudyReport& report, Warnings& warnings) {
  const bool one_image_each = std::ranges::all_of(
      outcomes.exemplars, [](const auto& images) { return images.size() == 1; });
  if (report.pairs.empty() || !one_image_each) return;
  warnings.push_back(
      fmt::format("The comparison holds for these {} images; it does not generalise over images.",
                  outcomes.exemplars.size()));
}

void warn_of_few_participants(const StudyReport& report, Warnings& warnings) {
  if (report.participants < 2 || report.participants >= kFewParticipants) return;
  warnings.push_back(
      fmt::format("{} participants are few: the design can show large effects alone, how people "
                  "differ hardly at all, and the t interval leans on normality.",
                  report.participants));
}

}  // namespace

std::vector<std::string> comparison_warnings(const Outcomes& outcomes, const StudyReport& report) {
  Warnings warnings;
  warn_of_few_participants(report, warnings);
  warn_of_several(report, warnings);
  warn_of_sign_flips(report, warnings);
  warn_of_images(outcomes, report, warnings);
  return warnings;
}

}  // namespace touchtrial::analysis
