#include "analysis/cues/cue_warnings.hpp"

#include "analysis/outcomes.hpp"
#include "analysis/text_figures.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using Warnings = std::vector<std::string>;

constexpr int kFewestTrials = 2;

void warn_of_study(const Outcomes& outcomes, const CueReport& report, Warnings& warnings) {
  if (outcomes.visual) {
    warnings.emplace_back(
        "Seen on a screen, not felt: the observers use forces that no hand of this study had.");
  }
  if (report.plane_source == kPlaneFromTraces) {
    warnings.emplace_back(
        "Neither the study's pack nor its images were found: the parts of the plane are told from "
        "where hands had contact, and what `everything` has from them is a little less sure.");
  }
}

void warn_of_trials(const MethodCues& cues, Warnings& warnings) {
  if (cues.without_trace > 0) {
    warnings.push_back(
        fmt::format("{}: {} without a trace left out; accuracy here is of the others alone.",
                    cues.method, counted(cues.without_trace, "trial")));
  }
  if (cues.unjudged > 0) {
    warnings.push_back(
        fmt::format("{}: {} left out, because no other trial of the class tells an observer what "
                    "it feels like.",
                    cues.method, counted(cues.unjudged, "trial")));
  }
}

void warn_of_numbers(const MethodCues& cues, Warnings& warnings) {
  if (cues.trials == 0) {
    warnings.push_back(cues.method + ": no trial can be judged by the observers.");
    return;
  }
  if (cues.fewest_of_a_class < kFewestTrials) {
    warnings.push_back(
        fmt::format("{}: somebody has fewer than {} trials of a class, so the observers know that "
                    "hand's way of "
                    "feeling it from others' alone, and what they call available is too low.",
                    cues.method, kFewestTrials));
  }
  const auto participants = static_cast<int>(cues.participants.size());
  if (participants < kFewestForVerdict) {
    warnings.push_back(
        fmt::format("{}: {} cannot decide which cue was used: from {} on there is a verdict, and "
                    "intervals over fewer are too narrow.",
                    cues.method, counted(participants, "participant"), kFewestForVerdict));
  } else if (cues.match && !cues.match->difference.interval) {
    warnings.push_back(cues.method +
                       ": the observers' difference has no interval, so there is no verdict on "
                       "which cue was used.");
  }
}

void warn_of_figures(const MethodCues& cues, double chance, Warnings& warnings) {
  for (const ObserverFigures& one : cues.observers) {
    const std::string_view title = title_of(one.cue);
    if (one.mean.mean.value_or(0.0) <= chance) {
      warnings.push_back(
          fmt::format("{}: {} tells the classes apart no better than chance, so nothing can be "
                      "said of how well it was used.",
                      cues.method, title));
    } else if (one.efficiency.value.value_or(0.0) > 1.0) {
      warnings.push_back(
          fmt::format("{}: participants did better than {} alone allows: they used something else "
                      "as well, or the observer has too few trials to learn from.",
                      cues.method, title));
    }
  }
}

}  // namespace

std::vector<std::string> cue_warnings(const Outcomes& outcomes, const CueReport& report) {
  Warnings warnings;
  warn_of_study(outcomes, report, warnings);
  for (const MethodCues& cues : report.methods) {
    warn_of_trials(cues, warnings);
    warn_of_numbers(cues, warnings);
    warn_of_figures(cues, report.chance, warnings);
  }
  return warnings;
}

}  // namespace touchtrial::analysis
