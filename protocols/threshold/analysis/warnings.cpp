#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::Along;
using study::threshold::Question;

/// Catch trials are at the highest level, where hardly anybody who attends is wrong.
constexpr double kPoorCatches = 0.8;

using Sentences = std::vector<std::string>;

void warn_of_sound(const ThresholdReport& report, Sentences& all) {
  if (!report.control) {
    all.emplace_back(
        "There was no control block with the hand off the device, so nothing tells whether "
        "participants could hear what they were meant to feel.");
    return;
  }
  const RightAnswers& pooled = report.control->pooled;
  if (!pooled.p || *pooled.p > kUsualLevel) return;
  all.push_back(fmt::format(
      "With the hand off the device {} of {} answers were right, more than guessing gives ({}): "
      "participants could hear something, and the thresholds may be of the ear.",
      pooled.answers.correct, pooled.answers.n, p_phrase(*pooled.p)));
}

void warn_of_censored(const ThresholdReport& report, Sentences& all) {
  for (const StandardReport& one : report.standards) {
    const int censored = one.censored_below + one.censored_above;
    if (censored == 0) continue;
    all.push_back(fmt::format(
        "{}: {} of {} reached a bound of the levels ({} below, {} above) and gave no threshold; "
        "the mean is without them, and so too near to the middle of the levels.",
        one.words, censored, counted(one.tracks, "track"), one.censored_below, one.censored_above));
  }
}

void warn_of_attention(const ThresholdReport& report, Sentences& all) {
  if (!report.catches) return;
  std::vector<std::string> names;
  for (const RightAnswers& one : report.catches->people) {
    if (one.answers.share().value_or(1.0) < kPoorCatches) names.push_back(one.participant);
  }
  if (names.empty()) return;
  all.push_back(fmt::format(
      "Fewer than four of five catch trials, which are at the highest level, were answered right "
      "by {}: not attending, not understanding, or levels that are too low.",
      listed(names, " and ")));
}

void warn_of_fit(const ThresholdReport& report, Sentences& all) {
  int tracks = 0;
  int rejected = 0;
  for (const TrackReport& track : report.tracks) {
    if (!track.fit) continue;
    ++tracks;
    rejected += track.fit->p <= kUsualLevel ? 1 : 0;
  }
  if (tracks == 0 || rejected * 10 <= tracks) return;
  all.push_back(fmt::format(
      "{} of {} fit worse than 95 of 100 tracks of the fitted observers themselves do; by chance "
      "5 % would. The function or the independence of trials may not hold.",
      rejected, counted(tracks, "track")));
}

void warn_of_habits(const ThresholdReport& report, Sentences& all) {
  const GroupTest& learning = report.learning_db;
  if (learning.p && *learning.p <= kUsualLevel) {
    all.push_back(fmt::format(
        "Participants became {} in the course of their tracks ({}), so one threshold does not "
        "describe a track.",
        learning.mean.mean.value_or(0.0) < 0.0 ? "better" : "worse", p_phrase(*learning.p)));
  }
  if (report.options().question == Question::same_different) return;
  // Of several answers, by Bonferroni.
  const double level = kUsualLevel / std::max(1.0, static_cast<double>(report.choice_use.size()));
  const bool prefers = std::ranges::any_of(report.choice_use, [level](const ChoiceUse& one) {
    return one.excess.p && *one.excess.p <= level;
  });
  if (prefers) {
    all.emplace_back(
        "Participants preferred an interval. Their thresholds are too high, because answers that "
        "follow the preference are right only by chance.");
  }
}

void warn_of_design(const ThresholdReport& report, Sentences& all) {
  const auto& options = report.options();
  if (options.along == Along::order && options.rove_db == 0.0) {
    all.emplace_back(
        "Another order also has another strength, and gains were not roved: participants may have "
        "compared strengths.");
  }
  if (report.has_thresholds() && report.by_posterior && !report.tracks.empty()) {
    all.emplace_back(
        "Slopes and lapse rates of adaptive tracks are by-products: few trials are where they "
        "show, and fitted slopes are too steep.");
  }
}

}  // namespace

std::vector<std::string> threshold_warnings(const ThresholdReport& report) {
  Sentences all;
  if (report.tracks.empty()) return all;
  warn_of_sound(report, all);
  warn_of_censored(report, all);
  warn_of_attention(report, all);
  warn_of_fit(report, all);
  warn_of_habits(report, all);
  warn_of_design(report, all);
  return all;
}

}  // namespace touchtrial::analysis::threshold
