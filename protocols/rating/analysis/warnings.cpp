#include "analysis/report/page/wording.hpp"
#include "analysis/statistics/common.hpp"
#include "core/text.hpp"
#include "protocols/rating/analysis/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

/// The maximum ratio of a participant's scatter to the median scatter. If all participants scatter
/// equally, one study in 200 exceeds it. Source: docs/rating.md, "Agreement".
constexpr double kUnevenScatter = 2.5;

using WarningTexts = std::vector<std::string>;

void warn_of_catches(const RatingReport& report, const ScaleReport& scale, WarningTexts& all) {
  std::vector<std::string> names;
  for (const CatchRating& rating : scale.catches.participants) {
    if (without_noise(rating.scored - rating.catches) > 0.0) continue;
    names.push_back(report.people[static_cast<std::size_t>(rating.participant)]);
  }
  const int n = static_cast<int>(scale.catches.participants.size());
  const auto interval = scale.catches.difference.known_interval();
  if (n > 0 && (scale.catches.difference.mean <= 0.0 || (interval && interval->low <= 0.0))) {
    all.push_back(fmt::format(
        "Catch trials, which have no texture, are not rated reliably lower than textures "
        "({}): ratings may reflect only the pictures.",
        counted(n, "participant")));
  }
  if (names.empty()) return;
  all.push_back(fmt::format("Catch trials are rated at least as high as textures by {}.",
                            listed(names, " and ")));
}

/// Warns if the smallest sign-flip p, adjusted for all pairs, is above the usual level.
void warn_of_few_participants(const ScaleReport& scale, WarningTexts& all) {
  if (scale.differences.empty()) return;
  const auto pairs = static_cast<double>(scale.differences.size());
  int fewest = scale.differences.front().difference.participants;
  for (const MethodDifference& pair : scale.differences) {
    fewest = std::min(fewest, pair.difference.participants);
  }
  if (fewest == 0 || pairs * std::ldexp(1.0, 1 - fewest) <= kUsualLevel) return;
  all.push_back(fmt::format(
      "With {}, sign flips cannot give a p of {} or less{}, regardless of the difference.",
      counted(fewest, "participant"), kUsualLevel,
      pairs > 1.0 ? fmt::format(" for the first of {} pairs", scale.differences.size()) : ""));
}

void warn_of_narrow_use(const RatingReport& report, const ScaleReport& scale, WarningTexts& all) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < report.people.size(); ++i) {
    if (scale.use.participants[i].is_narrow) names.push_back(report.people[i]);
  }
  if (names.empty()) return;
  all.push_back(
      fmt::format("Very little of the scale is used by {} (standard deviation below {:.0f}% of its "
                  "length): such ratings hardly distinguish textures or methods.",
                  listed(names, " and "), 100.0 * kNarrowUse));
}

void warn_of_scatter(const ScaleReport& scale, WarningTexts& all) {
  std::vector<double> scatters;
  for (const auto& scatter : scale.scatter) {
    if (scatter) scatters.push_back(*scatter);
  }
  const Quartiles spread = quartiles(scatters);
  if (scatters.size() < 3 || !scale.agreement.single) return;
  const double largest = *std::ranges::max_element(scatters);
  if (largest <= kUnevenScatter * *spread.median) return;
  all.push_back(
      "Participants' variances around the common pattern differ strongly. The intervals of "
      "ICC(2,1) and ICC(2,k) assume equal variances, and are too narrow.");
}

void warn_of_left_out(const ScaleReport& scale, WarningTexts& all) {
  if (scale.agreement.left_out == 0) return;
  all.push_back(
      fmt::format("{} without a rating of every texture with every method; means over textures and "
                  "agreement exclude them.",
                  scale.agreement.left_out == 1
                      ? "One participant is"
                      : fmt::format("{} participants are", scale.agreement.left_out)));
}

}  // namespace

std::vector<std::string> rating_warnings(const RatingReport& report) {
  WarningTexts all;
  if (report.people.empty()) return all;
  for (const ScaleReport& scale : report.scales) {
    WarningTexts scale_warnings;
    warn_of_catches(report, scale, scale_warnings);
    warn_of_few_participants(scale, scale_warnings);
    warn_of_narrow_use(report, scale, scale_warnings);
    warn_of_scatter(scale, scale_warnings);
    warn_of_left_out(scale, scale_warnings);
    for (std::string& sentence : scale_warnings) {
      all.push_back(report.scales.size() > 1 ? fmt::format("Scale {}: {}", scale.scale.id, sentence)
                                             : std::move(sentence));
    }
  }
  return all;
}

}  // namespace touchtrial::analysis::rating
