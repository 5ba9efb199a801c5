#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"
#include "analysis/statistics/quantiles.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kMostPoints = 300;
/// A logarithmic axis has no zero.
constexpr double kLeast_us = 0.1;

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5).value_or(kLeast_us);
}

/// Trials that make one point: the medians of their percentiles, and the worst of all.
std::vector<double> row_of(std::span<const ServoTrial> trials, double middle) {
  std::vector<double> p50;
  std::vector<double> p99;
  double worst = kLeast_us;
  for (const ServoTrial& trial : trials) {
    p50.push_back(std::max(trial.health.lateness_p50_us, kLeast_us));
    p99.push_back(std::max(trial.health.lateness_p99_us, kLeast_us));
    worst = std::max(worst, trial.health.lateness_worst_us);
  }
  return {middle, median_of(std::move(p50)), median_of(std::move(p99)), worst};
}

std::size_t trials_together(std::size_t trials) {
  return (trials + kMostPoints - 1) / kMostPoints;
}

std::vector<std::vector<double>> rows_of(std::span<const ServoTrial> trials) {
  const std::size_t together = trials_together(trials.size());
  std::vector<std::vector<double>> rows;
  for (std::size_t first = 0; first < trials.size(); first += together) {
    const std::size_t count = std::min(together, trials.size() - first);
    rows.push_back(row_of(trials.subspan(first, count),
                          static_cast<double>(first) + 0.5 * static_cast<double>(count + 1)));
  }
  return rows;
}

/// Where a session's first trial stands, but of the first session.
std::string session_lines(std::span<const ServoTrial> trials) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    if (trials[i].session != trials[i - 1].session) starts.push_back(i);
  }
  if (starts.size() > 60) return {};
  std::string script;
  for (const std::size_t start : starts) {
    const double x = static_cast<double>(start) + 0.5;
    script += fmt::format(
        "set arrow from first {0}, graph 0 to first {0}, graph 1 nohead lw 0.7 lc rgb '#e0e0e0' "
        "back\n",
        x);
  }
  return script;
}

std::string period_line(std::span<const ServoTrial> trials) {
  double rate_hz = 0.0;
  for (const ServoTrial& trial : trials) rate_hz = std::max(rate_hz, trial.health.rate_hz);
  if (rate_hz <= 0.0) return {};
  const double period_us = 1e6 / rate_hz;
  return fmt::format(
             "set arrow from graph 0, first {0:.6g} to graph 1, first {0:.6g} nohead dt (6, 5) lw "
             "1.2 lc rgb '{1}' back\n",
             period_us, kInk) +
         text_at("one tick",
                 fmt::format("graph 0.99, first {:.6g} right offset 0, 0.5", period_us));
}

}  // namespace

std::optional<Figure> servo_figure(const StudyReport& report) {
  const std::vector<ServoTrial>& trials = report.collection.servo_trials;
  if (trials.empty()) return {};
  const std::vector<std::vector<double>> rows = rows_of(trials);
  double worst = 1.0;
  for (const std::vector<double>& row : rows) worst = std::max(worst, row[3]);
  const Sheet sheet{16.0, 7.0, report.simulated};
  Margins margins;
  margins.left_cm = 1.7;
  margins.top_cm = 1.1;
  margins.bottom_cm = 1.25;
  const std::vector<std::string> looks = {
      fmt::format("with points pt 7 ps 0.35 lc rgb '{}'", series_colour(0)),
      fmt::format("with points pt 9 ps 0.45 lc rgb '{}'", series_colour(2)),
      fmt::format("with points pt 2 ps 0.45 lw 1.2 lc rgb '{}'", series_colour(1))};
  const std::vector<std::string> names = {"median", "99th percentile", "worst"};
  std::string plot;
  std::vector<LegendEntry> entries;
  constexpr int kLooks[] = {7, 9, 2};
  constexpr std::size_t kSeries[] = {0, 2, 1};
  for (std::size_t i = 0; i < looks.size(); ++i) {
    plot += fmt::format("{}$servo using 1:{} {} notitle", i == 0 ? "plot " : ", ", i + 2, looks[i]);
    entries.push_back(mark_entry(kLooks[i], series_colour(kSeries[i]), names[i]));
  }
  const Legend legend(sheet, margins.left_cm, entries);
  Figure figure{.id = "servo-lateness", .caption = {}, .alt = {}, .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
  const std::size_t together = trials_together(trials.size());
  figure.caption = stamped(
      report.simulated,
      "lateness of the servo's ticks, by trial in the order of sessions" +
          (together > 1 ? fmt::format("; a point is {} trials: the medians of their percentiles, "
                                      "and the latest tick of all",
                                      together)
                        : std::string(" (grey lines: a new session)")) +
          ". The dashed line is the time between two ticks.");
  figure.alt = fmt::format(
      "Lateness of the servo over {} trials: latest tick of all {:.0f} microseconds; median of the "
      "trials' 99th percentiles {:.0f} microseconds.",
      trials.size(), worst, row_of(trials, 0.0)[2]);
  figure.script = data_block("servo", rows) + sheet_head(sheet) + panel_at(sheet, margins) +
                  fmt::format(
                      "set logscale y\nset format y '%g'\nset ylabel 'lateness, µs'\nset "
                      "xlabel 'trial' offset 0, 0.4\nset xrange [0:{}]\nset yrange "
                      "[*:{:.6g}]\n",
                      trials.size() + 1, std::max(2.0 * worst, 1500.0)) +
                  session_lines(trials) + period_line(trials) + legend.script() + plot + "\n";
  return figure;
}

}  // namespace touchtrial::analysis
