#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::ThresholdOptions;

/// How the quoted thresholds were estimated.
std::string quoted_words(const ThresholdReport& report) {
  return report.by_posterior ? "posterior means" : "maximum likelihood";
}

Table standards_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  const std::string quantity = quantity_name(options);
  Table table{"thresholds-by-standard",
              fmt::format("Thresholds in {}, {}; means over participants with t intervals",
                          study::threshold::unit_of_level(options), quoted_words(report)),
              {{"standard", Align::left},
               {"n"},
               {"threshold and 95% (dB)"},
               {"SD (dB)"},
               {"tracks"},
               {"below"},
               {"above"}}};
  if (!quantity.empty()) table.columns.push_back({quantity + " and 95%"});
  for (const StandardReport& one : report.standards) {
    const procedures::Threshold mean = mean_threshold(one.mean);
    std::vector<Cell>& row = table.rows.emplace_back(std::vector<Cell>{
        one.words, std::to_string(one.mean.participants), threshold_text(mean, one.levels),
        plain_figure(one.mean.sd, 1), std::to_string(one.tracks),
        std::to_string(one.censored_below), std::to_string(one.censored_above)});
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, one.of, mean), options));
    }
  }
  table.notes = {
      {"n: participants with a threshold, each the mean of the own tracks. Below, above: tracks "
       "that reached a bound of the levels; they give no number and are left out of the mean."},
      {"Levels are logarithms, so their mean is that of a geometric mean. The interval is "
       "Student's, over participants.",
       {Source::student}}};
  return table;
}

Table differences_table(const ThresholdReport& report) {
  Table table{"differences-of-standards",
              "Differences of thresholds, first minus second, of participants who have both",
              {{"first", Align::left},
               {"second", Align::left},
               {"n"},
               {"difference (dB)"},
               {"t 95% (dB)"},
               {"p"},
               {"p by Holm"}}};
  for (const DifferenceReport& one : report.differences) {
    const MeanEstimate& mean = one.difference.mean;
    table.rows.push_back({report.standards[one.first].words, report.standards[one.second].words,
                          std::to_string(mean.participants), signed_plain_figure(mean.mean, 1),
                          plain_range(mean.known_interval(), 1), p_figure(one.difference.p),
                          p_figure(one.p_holm)});
  }
  table.notes = {{"p: Student's t test, two-sided; by Holm: adjusted over all pairs.",
                  {Source::student, Source::holm}}};
  return table;
}

bool any_track(const ThresholdReport& report, bool (*has)(const TrackReport&)) {
  return std::ranges::any_of(report.tracks, has);
}

std::string estimate_text(const std::optional<TrackEstimate>& estimate,
                          const std::vector<double>& levels) {
  return estimate ? threshold_text(estimate->threshold, levels) : kNoFigure;
}

Table tracks_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  Table table{
      "tracks",
      fmt::format("Every track: thresholds in {}", study::threshold::unit_of_level(options)),
      {{"participant", Align::left},
       {"track"},
       {"standard", Align::left},
       {"n"},
       {"right"},
       {report.by_posterior ? "posterior, to quote" : "posterior"},
       {report.by_posterior ? "likelihood" : "likelihood, to quote"},
       {"slope"},
       {"lapses"}}};
  const bool turns =
      any_track(report, [](const TrackReport& t) { return t.reversals.has_value(); });
  const bool fits = any_track(report, [](const TrackReport& t) { return t.fit.has_value(); });
  const std::string quantity = quantity_name(options);
  if (turns) table.columns.push_back({"reversals"});
  if (fits) table.columns.push_back({"p of the fit"});
  if (!quantity.empty()) table.columns.push_back({quantity});
  for (const TrackReport& track : report.tracks) {
    const StandardReport& standard = report.standards[track.standard];
    const TrackEstimate quoted = report.quoted(track).value_or(TrackEstimate{});
    std::vector<Cell>& row = table.rows.emplace_back(
        std::vector<Cell>{track.participant, std::to_string(track.track), standard.words,
                          std::to_string(track.answers.n), share_figure(track.answers.share()),
                          estimate_text(track.posterior, standard.levels),
                          estimate_text(track.likelihood, standard.levels),
                          plain_figure(quoted.slope, 2), share_figure(quoted.lapse)});
    if (turns) {
      row.emplace_back(track.reversals ? threshold_text(*track.reversals, standard.levels)
                                       : kNoFigure);
    }
    if (fits) row.emplace_back(track.fit ? p_figure(track.fit->p) : kNoFigure);
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, standard.of, quoted.threshold), options));
    }
  }
  return table;
}

/// What the columns of the tracks mean.
std::vector<Cited> tracks_notes(const ThresholdReport& report) {
  const procedures::TrackSettings& track = report.options().track;
  std::vector<Cited> notes = {
      {"Posterior: mean and 95 % credible interval, over the study's grid. Likelihood: the most "
       "likely observer and the 95 % profile interval, the guess rate held. Slope and lapses are "
       "those of the estimate to quote. Below, above: the track reached a bound of the levels and "
       "has no threshold; open: the interval has no end on this side."}};
  if (track.procedure.ends_with("up-down")) {
    notes.push_back({fmt::format(
        "Reversals: mean of the last turns of the staircase. It estimates the level with {} right, "
        "not the threshold's {}, so the two are not to be compared; it has no interval.",
        share_figure(procedures::convergence_of(track.up_down)), share_figure(report.criterion))});
  }
  if (!report.by_posterior) {
    notes.push_back(
        {"p of the fit: the share of data sets of the fitted observer itself that deviate as much "
         "from their own fits, of 399 (Wichmann and Hill 2001). With few trials a level it finds "
         "coarse departures alone."});
  }
  return notes;
}

}  // namespace

Section thresholds_section(const ThresholdReport& report) {
  Section section{"thresholds", "Thresholds", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  section.blocks.emplace_back(standards_table(report));
  if (!report.differences.empty()) section.blocks.emplace_back(differences_table(report));
  return section;
}

Section tracks_section(const ThresholdReport& report) {
  Section section{"tracks-of-participants", "Tracks", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  Table table = tracks_table(report);
  table.notes = tracks_notes(report);
  section.blocks.emplace_back(std::move(table));
  return section;
}

}  // namespace touchtrial::analysis::threshold
