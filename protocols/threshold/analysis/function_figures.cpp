#include "analysis/report/figures/style.hpp"
#include "protocols/threshold/analysis/figure_axes.hpp"
#include "protocols/threshold/analysis/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {

double room_at_ends(const ThresholdReport& report) {
  const std::vector<double>& levels = report.options().track.levels;
  return std::max(0.05 * (levels.back() - levels.front()), 1.0);
}

std::string unit_label(const ThresholdReport& report) {
  return report.options().task == study::threshold::Task::detection
             ? "level, dB re the pack's gain"
             : "level, 20 log10 of the difference";
}

Axis level_axis(const ThresholdReport& report) {
  const std::vector<double>& levels = report.options().track.levels;
  const double room = room_at_ends(report);
  return {.label = unit_label(report), .low = levels.front() - room, .high = levels.back() + room};
}

std::string short_name(const StandardReport& standard) {
  constexpr std::string_view kWord = "standard ";
  std::string name = standard.words;
  const std::size_t position = name.find(kWord);
  if (position != std::string::npos) name.erase(position, kWord.size());
  return name;
}

namespace {

/// The maximum number of drawn functions; if there are more, only every n-th is drawn.
constexpr std::size_t kMaxFunctions = 100;

/// The functions of tracks, by participant.
using Observers = std::map<std::string, std::vector<const procedures::Observer*>>;

Observers observers_of(const ThresholdReport& report, std::size_t standard) {
  Observers observers;
  for (const TrackReport& track : report.tracks) {
    if (track.standard == standard && track.estimate) {
      observers[track.participant].push_back(&track.estimate->observer);
    }
  }
  return observers;
}

double share_at(const std::vector<const procedures::Observer*>& observers, double level) {
  double sum = 0.0;
  for (const procedures::Observer* observer : observers) {
    sum += procedures::shares_at(*observer, level).correct;
  }
  return sum / static_cast<double>(observers.size());
}

/// An axis of right answers, from chance or from the lowest row.
Axis right_axis(const ThresholdReport& report, std::string label,
                const std::vector<Datum>& rows = {}) {
  double low = 100.0 * report.guess;
  for (const Datum& row : rows) low = std::min(low, row.y);
  return {.label = std::move(label), .low = low - 2.0, .high = 102.0, .step = 10.0};
}

Panel functions_panel(const ThresholdReport& report, std::size_t standard) {
  constexpr int kPoints = 60;
  const Observers observers = observers_of(report, standard);
  const std::vector<double>& levels = report.options().track.levels;
  Layer lines{.kind = LayerKind::line,
              .name = "participants",
              .colour = std::string(kPale),
              .size = 0.6,
              .in_key = true};
  Layer mean{.kind = LayerKind::line,
             .name = "mean",
             .colour = series_colour(0),
             .size = 1.8,
             .in_key = true};
  Layer band{.kind = LayerKind::band, .name = "mean, 95% interval", .colour = series_colour(0)};
  const std::size_t step = (observers.size() + kMaxFunctions - 1) / kMaxFunctions;
  std::size_t number = 0;
  const auto level_at = [&](int i) {
    return std::lerp(levels.front(), levels.back(), static_cast<double>(i) / kPoints);
  };
  for (const auto& [participant, functions] : observers) {
    if (number++ % step != 0) continue;
    for (int i = 0; i <= kPoints; ++i) {
      lines.rows.push_back(
          {.x = level_at(i), .y = 100.0 * share_at(functions, level_at(i)), .text = participant});
    }
  }
  for (int i = 0; i <= kPoints && !observers.empty(); ++i) {
    std::vector<double> shares;
    for (const auto& [participant, functions] : observers) {
      shares.push_back(share_at(functions, level_at(i)));
    }
    const MeanEstimate mean_share = participant_mean(shares);
    mean.rows.push_back({.x = level_at(i), .y = 100.0 * *mean_share.mean});
    band.rows.push_back(bar(level_at(i), *mean_share.mean, mean_share.known_interval(), 100.0));
  }
  Panel panel;
  panel.x = level_axis(report);
  panel.y = right_axis(report, "right, %");
  const double criterion = 100.0 * *report.criterion;
  Layer threshold = dashed_rule(criterion, "threshold");
  threshold.rows.front().text.clear();  // the label is where the functions are low
  panel.layers = {std::move(threshold), std::move(lines), std::move(band), std::move(mean),
                  direct_label(level_at(0), criterion + 3.0, "threshold", std::string(kInk))};
  return panel;
}

/// Adds the track's trials in three parts, by expected share right.
void add_parts(Layer& parts, const ThresholdReport& report, const TrackReport& track) {
  constexpr std::size_t kParts = 3;
  struct ExpectedAnswer {
    double share;
    bool is_right;
  };
  std::vector<ExpectedAnswer> trials;
  for (const procedures::TrackTrial& trial : track.trials) {
    const double level = report.options().track.levels[trial.level];
    trials.push_back(
        {procedures::shares_at(track.estimate->observer, level).correct, trial.correct});
  }
  std::ranges::stable_sort(trials, {}, &ExpectedAnswer::share);
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t begin = trials.size() * part / kParts;
    const std::size_t end = trials.size() * (part + 1) / kParts;
    if (begin == end) continue;
    double expected = 0.0;
    double right = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      expected += trials[i].share;
      right += trials[i].is_right ? 1.0 : 0.0;
    }
    const double percent = 100.0 / static_cast<double>(end - begin);
    parts.rows.push_back(
        {.x = percent * expected, .y = percent * right, .text = track.participant});
  }
}

Panel expected_panel(const ThresholdReport& report) {
  Layer parts{
      .name = "parts of tracks", .colour = series_colour(0), .size = 1.2, .glyph = Glyph::ring};
  for (const TrackReport& track : report.tracks) {
    if (track.estimate) add_parts(parts, report, track);
  }
  const double chance = 100.0 * report.guess;
  Layer diagonal{.kind = LayerKind::line,
                 .name = "as expected",
                 .rows = {{.x = chance, .y = chance}, {.x = 100.0, .y = 100.0}}};
  Panel panel;
  panel.x = right_axis(report, "expected right, %");
  panel.y = right_axis(report, "observed right, %", parts.rows);
  panel.layers = {std::move(diagonal), std::move(parts)};
  return panel;
}

}  // namespace

std::optional<Figure> functions_figure(const ThresholdReport& report) {
  if (!report.has_thresholds() || report.tracks.empty()) return {};
  Figure figure = empty_figure("functions", "thresholds", report.simulated, kPage_cm);
  figure.alt = "Estimated functions of right answers by level, of each participant and their mean.";
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    Panel panel = functions_panel(report, i);
    const std::vector<Datum>& mean = panel.layers.back().rows;
    if (mean.empty()) continue;
    figure.alt += fmt::format(" {}: mean {:.0f}% right at {:.1f} dB, {:.0f}% at {:.1f} dB.",
                              report.standards[i].words, mean.front().y, mean.front().x,
                              mean.back().y, mean.back().x);
    if (report.standards.size() > 1) panel.title = short_name(report.standards[i]);
    figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) return {};
  figure.panels.push_back(expected_panel(report));
  if (figure.panels.size() > 2) figure.panels.back().title = "observed against expected";
  figure.panels_per_row = figure.panels.size() % 3 == 0 ? 3 : 2;
  figure.caption = stamped(
      report.simulated,
      "functions estimated from participants' tracks (thin), and their mean with its pointwise 95% "
      "t interval over participants. Last panel: trials of each track in three parts, by the "
      "expected share of right answers, against the observed share.");
  return figure;
}

}  // namespace touchtrial::analysis::threshold
