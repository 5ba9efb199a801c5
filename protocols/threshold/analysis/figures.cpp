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

/// The maximum number of participants with names below the axis.
constexpr std::size_t kMaxNames = 16;
constexpr std::size_t kMaxTrackPanels = 12;

/// "-21.3 dB (-23.0 to -19.6 dB)"
std::string decibels_with_interval(const CensoredMean& mean) {
  if (!mean.mean) return "no mean";
  if (!mean.interval) return fmt::format("{:.1f} dB", *mean.mean);
  return fmt::format("{:.1f} dB ({:.1f} to {:.1f} dB)", *mean.mean, mean.interval->low,
                     mean.interval->high);
}

/// ", 3 above the levels, 1 below the levels"; empty if all thresholds are known.
std::string censored_words(const StandardReport& standard) {
  std::string text;
  const auto add = [&](procedures::Censored censored, const char* words) {
    const int n = standard.number_of(censored);
    if (n > 0) text += fmt::format(", {} {}", n, words);
  };
  add(procedures::Censored::above, "above the levels");
  add(procedures::Censored::below, "below the levels");
  add(procedures::Censored::undetermined, "not determined");
  return text;
}

std::string alt_of_thresholds(const ThresholdReport& report) {
  std::string alt = "Each participant's threshold as a dot, the mean and its 95% interval.";
  for (const StandardReport& standard : report.standards) {
    if (standard.people.empty()) continue;
    alt += fmt::format(" {}: {} participants{}, {}.", standard.words, standard.people.size(),
                       censored_words(standard), decibels_with_interval(standard.mean));
  }
  return alt;
}

/// The levels of the first tracks.
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

/// The intervals of thresholds by participant; empty for participants with several tracks.
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

/// The determined thresholds' indices in ascending order, from those below to those above the
/// levels.
std::vector<std::size_t> order_by_threshold(const StandardReport& standard) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < standard.thresholds.size(); ++i) {
    if (standard.thresholds[i].censored != procedures::Censored::undetermined) order.push_back(i);
  }
  const auto key = [&](std::size_t i) {
    const PersonThreshold& person = standard.thresholds[i];
    if (person.censored == procedures::Censored::below) return -HUGE_VAL;
    return person.censored == procedures::Censored::above ? HUGE_VAL : person.bounds.low;
  };
  std::ranges::stable_sort(order, {}, key);
  return order;
}

/// An interval that is open on one side extends to that end.
Datum row_of(double level, const procedures::Threshold& interval, const Interval& ends) {
  if (!interval.low && !interval.high) return {.y = level, .low = level, .high = level};
  return {.y = level,
          .low = interval.low.value_or(ends.low),
          .high = interval.high.value_or(ends.high)};
}

/// The range of the rows, extended to an end if somebody is beyond it.
Axis fitted_axis(const ThresholdReport& report, std::span<const Datum> rows, const Interval& ends,
                 bool has_below, bool has_above) {
  Axis axis{.label = unit_label(report)};
  if (rows.empty()) return {.label = axis.label, .low = ends.low, .high = ends.high};
  double low = rows.front().low;
  double high = rows.front().high;
  for (const Datum& row : rows) {
    low = std::min(low, row.low);
    high = std::max(high, row.high);
  }
  const double room = std::max(0.06 * (high - low), 0.5);
  axis.low = has_below ? std::min(ends.low, low - room) : low - room;
  axis.high = has_above ? std::max(ends.high, high + room) : high + room;
  return axis;
}

Panel thresholds_panel(const ThresholdReport& report, std::size_t number) {
  const StandardReport& standard = report.standards[number];
  Layer determined{.kind = LayerKind::interval, .name = "participants", .colour = series_colour(0)};
  Layer above_marks{.name = "above the levels",
                    .colour = series_colour(1),
                    .size = 1.3,
                    .glyph = Glyph::triangle,
                    .in_key = true};
  Layer below_marks = above_marks;
  below_marks.name = "below the levels";
  below_marks.glyph = Glyph::down;
  const double room = room_at_ends(report);
  const auto intervals = intervals_of(report, number);
  const Interval ends{standard.levels.front() - room, standard.levels.back() + room};
  Panel panel;
  panel.x.label = "participants, by threshold";
  double x = 0.0;
  for (const std::size_t i : order_by_threshold(standard)) {
    x += 1.0;
    const std::string& name = standard.people[i];
    const PersonThreshold& person = standard.thresholds[i];
    panel.x.names.push_back(name);
    if (person.censored == procedures::Censored::above) {
      above_marks.rows.push_back({.x = x, .y = standard.levels.back() + 0.5 * room, .text = name});
    } else if (person.censored == procedures::Censored::below) {
      below_marks.rows.push_back({.x = x, .y = standard.levels.front() - 0.5 * room, .text = name});
    } else {
      const auto found = intervals.find(name);
      determined.rows.push_back(
          row_of(person.bounds.low,
                 found == intervals.end() ? procedures::Threshold{} : found->second, ends));
      determined.rows.back().x = x;
      determined.rows.back().text = name;
    }
  }
  if (panel.x.names.size() > kMaxNames) {
    panel.x = {.label = panel.x.label, .low = 0.0, .high = x + 1.0};
    determined.size = x > 40.0 ? 0.55 : 0.8;
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
  std::vector<Datum> rows = determined.rows;
  if (standard.mean.interval) rows.push_back(mean.rows.front());
  panel.y = fitted_axis(report, rows, ends, !below_marks.rows.empty(), !above_marks.rows.empty());
  panel.layers = {std::move(mean), std::move(determined), std::move(above_marks),
                  std::move(below_marks)};
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
  Figure figure = empty_figure("thresholds-by-person", "result", report.simulated);
  std::size_t people = 0;
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    if (report.standards[i].levels.empty() || report.standards[i].thresholds.empty()) continue;
    Panel panel = thresholds_panel(report, i);
    if (report.standards.size() > 1) panel.title = short_name(report.standards[i]);
    people = std::max(people, order_by_threshold(report.standards[i]).size());
    figure.panels.push_back(std::move(panel));
  }
  if (people == 0) return {};
  figure.panels_per_row = std::min<std::size_t>(figure.panels.size(), 3);
  if (figure.panels.size() > 1 || people > 24) figure.width_cm = kPage_cm;
  figure.alt = alt_of_thresholds(report);
  figure.caption = stamped(
      report.simulated,
      "participants' thresholds in ascending order with their 95% intervals, triangles for those "
      "beyond the levels; line, band and number: the mean with its 95% interval.");
  return figure;
}

std::optional<Figure> tracks_figure(const ThresholdReport& report) {
  if (!report.has_thresholds() || report.tracks.empty()) return {};
  const std::size_t count = std::min(report.tracks.size(), kMaxTrackPanels);
  Figure figure = empty_figure("tracks", "tracks-of-participants", report.simulated, kPage_cm);
  figure.panels_per_row = 3;
  figure.alt = "Levels by trial, one panel per track.";
  for (std::size_t i = 0; i < count; ++i) {
    figure.panels.push_back(track_panel(report, report.tracks[i], visited_axis(report, count)));
    figure.alt += alt_of_track(report, report.tracks[i]);
  }
  figure.caption = stamped(
      report.simulated,
      "the levels that the procedure chose; dots are right answers, crosses wrong ones, and the "
      "dashed line is the threshold, if there is one." +
          (count < report.tracks.size()
               ? fmt::format(" The first {} of {} tracks.", count, report.tracks.size())
               : std::string()));
  return figure;
}

std::optional<Figure> d_prime_figure(const ThresholdReport& report) {
  Figure figure = empty_figure("d-prime-by-level", "same-or-different", report.simulated);
  figure.alt = "d' of same or different by level, by differencing.";
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    Layer means{.kind = LayerKind::interval, .name = "d'", .colour = series_colour(0)};
    for (const SameDifferentGroup& group : report.same_different_groups) {
      if (group.standard != i || !group.differencing.d_prime) continue;
      means.rows.push_back(
          bar(group.level, *group.differencing.d_prime, group.differencing.interval));
      figure.alt += fmt::format(" {}, {:.1f} dB: {:.2f}.", report.standards[i].words, group.level,
                                *group.differencing.d_prime);
    }
    if (means.rows.empty()) continue;
    Panel panel;
    if (report.standards.size() > 1) panel.title = short_name(report.standards[i]);
    panel.x = level_axis(report);
    panel.y = {.label = "d'"};
    panel.layers = {Layer{.kind = LayerKind::rule, .name = "chance", .rows = {{.y = 0.0}}},
                    std::move(means)};
    figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) return {};
  figure.panels_per_row = 2;
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
