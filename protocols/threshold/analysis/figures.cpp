#include "protocols/threshold/analysis/figures.hpp"

#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"
#include "protocols/threshold/analysis/figure_axes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

/// With more, participants have no names below the axis.
constexpr std::size_t kMaxNames = 16;
/// The most tracks that are drawn.
constexpr std::size_t kMaxTrackPanels = 12;

/// "-21.3 dB (-23.0 to -19.6 dB)"
std::string decibels_with_interval(const CensoredMean& mean) {
  if (!mean.mean) return "no mean";
  if (!mean.interval) return fmt::format("{:.1f} dB", *mean.mean);
  return fmt::format("{:.1f} dB ({:.1f} to {:.1f} dB)", *mean.mean, mean.interval->low,
                     mean.interval->high);
}

/// ", 3 above the levels, 1 below"; empty if everybody's threshold is known.
std::string beyond_in_words(const StandardReport& one) {
  std::string text;
  const auto add = [&](procedures::Censored censored, const char* where) {
    const int n = one.number_of(censored);
    if (n > 0) text += fmt::format(", {} {}", n, where);
  };
  add(procedures::Censored::above, "above the levels");
  add(procedures::Censored::below, "below the levels");
  add(procedures::Censored::undetermined, "not determined");
  return text;
}

std::string alt_of_thresholds(const ThresholdReport& report) {
  std::string alt = "Each participant's threshold as a dot, the mean and its 95% interval.";
  for (const StandardReport& one : report.standards) {
    if (one.people.empty()) continue;
    alt += fmt::format(" {}: {} participants{}, {}.", one.words, one.people.size(),
                       beyond_in_words(one), decibels_with_interval(one.mean));
  }
  return alt;
}

/// The levels that the first tracks visit.
Axis visited_axis(const ThresholdReport& report, std::size_t tracks) {
  const std::vector<double>& levels = report.options().track.levels;
  std::size_t low = levels.size() - 1;
  std::size_t high = 0;
  for (const TrackReport& track : std::span(report.tracks).first(tracks)) {
    for (const procedures::TrackTrial& trial : track.trials) {
      low = std::min(low, trial.level);
      high = std::max(high, trial.level);
    }
  }
  if (low > high) return {.label = "level, dB"};
  const double room = std::max(0.06 * (levels[high] - levels[low]), 0.5);
  return {.label = "level, dB", .low = levels[low] - room, .high = levels[high] + room};
}

/// The intervals of people's thresholds: of those with one track.
std::map<std::string, procedures::Threshold> intervals_of(const ThresholdReport& report,
                                                          std::size_t standard) {
  std::map<std::string, procedures::Threshold> intervals;
  std::map<std::string, int> tracks;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard || !track.estimate) continue;
    intervals[track.participant] = track.estimate->threshold;
    if (++tracks[track.participant] > 1) intervals[track.participant] = {};
  }
  return intervals;
}

/// Whose value is where, in the order of thresholds: first those below the levels, last those
/// above.
std::vector<std::size_t> by_threshold(const StandardReport& standard) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < standard.thresholds.size(); ++i) {
    if (standard.thresholds[i].censored != procedures::Censored::undetermined) order.push_back(i);
  }
  const auto key = [&](std::size_t i) {
    const PersonThreshold& one = standard.thresholds[i];
    if (one.censored == procedures::Censored::below) return -HUGE_VAL;
    return one.censored == procedures::Censored::above ? HUGE_VAL : one.bounds.low;
  };
  std::ranges::stable_sort(order, {}, key);
  return order;
}

/// An interval that is open on one side reaches to that end.
Datum row_of(double level, const procedures::Threshold& own, const Interval& ends) {
  if (!own.low && !own.high) return {.y = level, .low = level, .high = level};
  return {.y = level, .low = own.low.value_or(ends.low), .high = own.high.value_or(ends.high)};
}

/// From the lowest to the highest of what is drawn, and to the ends where somebody is beyond them.
Axis seen_axis(const ThresholdReport& report, std::span<const Datum> known, const Interval& ends,
               bool below, bool above) {
  Axis axis{.label = unit_label(report)};
  if (known.empty()) return {.label = axis.label, .low = ends.low, .high = ends.high};
  double low = known.front().low;
  double high = known.front().high;
  for (const Datum& row : known) {
    low = std::min(low, row.low);
    high = std::max(high, row.high);
  }
  const double room = std::max(0.06 * (high - low), 0.5);
  axis.low = below ? std::min(ends.low, low - room) : low - room;
  axis.high = above ? std::max(ends.high, high + room) : high + room;
  return axis;
}

Panel thresholds_panel(const ThresholdReport& report, std::size_t number) {
  const StandardReport& standard = report.standards[number];
  Layer known{.kind = LayerKind::interval, .name = "participants", .colour = series_colour(0)};
  Layer above{.name = "above the levels",
              .colour = series_colour(1),
              .size = 1.3,
              .glyph = Glyph::triangle,
              .in_key = true};
  Layer below{.name = "below the levels",
              .colour = series_colour(1),
              .size = 1.3,
              .glyph = Glyph::down,
              .in_key = true};
  const double room = room_at_ends(report);
  const auto intervals = intervals_of(report, number);
  const Interval ends{standard.levels.front() - room, standard.levels.back() + room};
  Panel panel;
  panel.x.label = "participants, by threshold";
  double x = 0.0;
  for (const std::size_t i : by_threshold(standard)) {
    x += 1.0;
    const std::string& who = standard.people[i];
    const PersonThreshold& one = standard.thresholds[i];
    panel.x.names.push_back(who);
    if (one.censored == procedures::Censored::above) {
      above.rows.push_back({.x = x, .y = standard.levels.back() + 0.5 * room, .text = who});
    } else if (one.censored == procedures::Censored::below) {
      below.rows.push_back({.x = x, .y = standard.levels.front() - 0.5 * room, .text = who});
    } else {
      const auto found = intervals.find(who);
      known.rows.push_back(
          row_of(one.bounds.low, found == intervals.end() ? procedures::Threshold{} : found->second,
                 ends));
      known.rows.back().x = x;
      known.rows.back().text = who;
    }
  }
  if (panel.x.names.size() > kMaxNames) {
    panel.x = {.label = panel.x.label, .low = 0.0, .high = x + 1.0};
    known.size = x > 40.0 ? 0.55 : 0.8;
  }
  Layer mean{.kind = LayerKind::rule, .name = "mean", .anchor = Anchor::start};
  if (standard.mean.mean) {
    const Interval band = standard.mean.interval.value_or(Interval{kNoNumber, kNoNumber});
    mean.rows = {{.y = *standard.mean.mean,
                  .low = band.low,
                  .high = band.high,
                  .text = fmt::format("{:.1f}", *standard.mean.mean)}};
    panel.room_right_cm = 0.7;
  }
  std::vector<Datum> seen = known.rows;
  if (standard.mean.interval) seen.push_back(mean.rows.front());
  panel.y = seen_axis(report, seen, ends, !below.rows.empty(), !above.rows.empty());
  panel.layers = {std::move(mean), std::move(known), std::move(above), std::move(below)};
  return panel;
}

Panel track_panel(const ThresholdReport& report, const TrackReport& track, Axis levels) {
  Layer right{.name = "right", .colour = series_colour(0), .size = 0.8, .in_key = true};
  Layer wrong{.name = "wrong",
              .colour = series_colour(1),
              .size = 1.4,
              .glyph = Glyph::cross,
              .in_key = true};
  for (std::size_t i = 0; i < track.trials.size(); ++i) {
    (track.trials[i].correct ? right : wrong)
        .rows.push_back({.x = static_cast<double>(i + 1),
                         .y = report.options().track.levels[track.trials[i].level]});
  }
  Layer threshold{.kind = LayerKind::rule, .name = "threshold", .dashed = true, .in_key = true};
  if (track.threshold()) threshold.rows = {{.y = *track.threshold()}};
  Panel panel;
  panel.title =
      fmt::format("{}, {}", track.participant, short_name(report.standards[track.standard]));
  panel.x = {.label = "trial", .low = 0.0, .high = static_cast<double>(track.trials.size() + 1)};
  panel.y = std::move(levels);
  panel.height_cm = 2.8;
  panel.layers = {std::move(threshold), std::move(right), std::move(wrong)};
  return panel;
}

std::string alt_of_track(const ThresholdReport& report, const TrackReport& track) {
  const std::string begin =
      fmt::format(" {}, {}: {} of {} right,", track.participant,
                  report.standards[track.standard].words, track.answers.correct, track.answers.n);
  if (!track.threshold()) return begin + " no threshold.";
  return begin + fmt::format(" threshold {:.1f} dB.", *track.threshold());
}

}  // namespace

std::optional<Figure> thresholds_figure(const ThresholdReport& report) {
  Figure figure = figure_named("thresholds-by-person", "result", report.simulated);
  std::size_t people = 0;
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    if (report.standards[i].levels.empty() || report.standards[i].thresholds.empty()) continue;
    Panel panel = thresholds_panel(report, i);
    if (report.standards.size() > 1) panel.title = short_name(report.standards[i]);
    people = std::max(people, by_threshold(report.standards[i]).size());
    figure.panels.push_back(std::move(panel));
  }
  if (people == 0) return {};
  figure.across = std::min<std::size_t>(figure.panels.size(), 3);
  if (figure.panels.size() > 1 || people > 24) figure.width_cm = kPage_cm;
  figure.alt = alt_of_thresholds(report);
  figure.caption = stamped(
      report.simulated,
      "participants' thresholds in ascending order with their 95% intervals, triangles for those "
      "beyond the levels; line, band and number: the mean of all with its 95% interval.");
  return figure;
}

std::optional<Figure> tracks_figure(const ThresholdReport& report) {
  if (!report.has_thresholds() || report.tracks.empty()) return {};
  const std::size_t count = std::min(report.tracks.size(), kMaxTrackPanels);
  Figure figure = figure_named("tracks", "tracks-of-participants", report.simulated, kPage_cm);
  figure.across = 3;
  figure.alt = "Levels by trial, one panel a track.";
  for (std::size_t i = 0; i < count; ++i) {
    figure.panels.push_back(track_panel(report, report.tracks[i], visited_axis(report, count)));
    figure.alt += alt_of_track(report, report.tracks[i]);
  }
  figure.caption = stamped(
      report.simulated,
      "the levels that the procedure chose by trial; dots are right answers, crosses wrong ones, "
      "and the dashed line is the threshold, if there is one." +
          (count < report.tracks.size()
               ? fmt::format(" The first {} of {} tracks.", count, report.tracks.size())
               : std::string()));
  return figure;
}

std::optional<Figure> d_prime_figure(const ThresholdReport& report) {
  Figure figure = figure_named("d-prime-by-level", "same-or-different", report.simulated);
  figure.alt = "d' of same or different by level, by differencing.";
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    Layer means{.kind = LayerKind::interval, .name = "d'", .colour = series_colour(0)};
    for (const SameDifferentGroup& one : report.same_different_groups) {
      if (one.standard != i || !one.differencing.d_prime) continue;
      means.rows.push_back(bar(one.level, *one.differencing.d_prime, one.differencing.interval));
      figure.alt += fmt::format(" {}, {:.1f} dB: {:.2f}.", report.standards[i].words, one.level,
                                *one.differencing.d_prime);
    }
    if (means.rows.empty()) continue;
    Panel panel;
    if (report.standards.size() > 1) panel.title = short_name(report.standards[i]);
    panel.x = level_axis(report);
    panel.y = {.label = "d'"};
    panel.layers = {
        Layer{.kind = LayerKind::rule, .name = "nothing told apart", .rows = {{.y = 0.0}}},
        std::move(means)};
    figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) return {};
  figure.across = 2;
  if (figure.panels.size() > 1) figure.width_cm = kPage_cm;
  figure.caption = stamped(report.simulated,
                           "d' of same or different by level, by differencing: all participants' "
                           "answers pooled, with 95% bootstrap intervals over participants.");
  return figure;
}

std::vector<Figure> report_figures(const ThresholdReport& report, const std::string& stamp) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(thresholds_figure(report));
  add(flow_figure(report));
  add(functions_figure(report));
  add(d_prime_figure(report));
  add(tracks_figure(report));
  add(servo_figure(report, "analysis"));
  stamp_figures(stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::threshold
