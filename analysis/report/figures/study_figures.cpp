#include "analysis/report/figures/study_figures.hpp"

#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_table.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {

namespace {

constexpr double kLine_cm = 0.42;
constexpr double kBoxLeft_cm = 0.5;
constexpr double kBoxWidth_cm = 5.0;
constexpr double kSideLeft_cm = 7.0;
constexpr double kSideWidth_cm = 8.5;
constexpr double kWidth_cm = 16.0;
constexpr std::size_t kSideColumns = 46;
constexpr std::size_t kMaxReasons = 8;

void add_line(std::vector<std::string>& lines, int count, const std::string& what) {
  if (count > 0) lines.push_back(fmt::format("{} {}", count, what));
}

/// Each reason once, with the number of participants who had it.
void add_reasons(std::vector<std::string>& lines, const ParticipantFlow& flow) {
  std::map<std::string, int> counts;
  for (const std::string& reason : flow.exclusion_reasons) ++counts[reason];
  std::size_t shown = 0;
  for (const auto& [reason, count] : counts) {
    if (++shown > kMaxReasons) {
      lines.push_back(fmt::format("    and {} further reasons", counts.size() - kMaxReasons));
      return;
    }
    lines.push_back(
        "    " + fitted(fmt::format("{}: {}", count, reason.empty() ? "no reason given" : reason),
                        kSideColumns));
  }
}

std::vector<std::string> left_out(const ParticipantFlow& flow) {
  std::vector<std::string> lines;
  add_line(lines, flow.erased, "withdrawn, data erased");
  add_line(lines, flow.replaced, "replaced by somebody else");
  add_line(lines, flow.stopped, "stopped before the end");
  add_line(lines, flow.open, "session not ended");
  add_line(lines, flow.other_kind, "of another kind (pilot or simulated)");
  add_line(lines, flow.unseen, "completed after the interim look");
  add_line(lines, flow.excluded, "excluded");
  add_reasons(lines, flow);
  return lines;
}

struct Box {
  double left_cm;
  double top_cm;
  double width_cm;
  double height_cm;
};

std::string box_of(const Sheet& sheet, const Box& box) {
  return fmt::format(
      "set object rectangle from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} fs "
      "empty border lc rgb '{}' lw 1.2\n",
      box.left_cm / sheet.width_cm, 1.0 - (box.top_cm + box.height_cm) / sheet.height_cm,
      (box.left_cm + box.width_cm) / sheet.width_cm, 1.0 - box.top_cm / sheet.height_cm, kInk);
}

std::string arrow_of(const Sheet& sheet, double x_cm, double y_cm, double to_x_cm, double to_y_cm) {
  return fmt::format(
      "set arrow from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} head filled "
      "size screen 0.012, 20 lw 1.2 lc rgb '{}'\n",
      x_cm / sheet.width_cm, 1.0 - y_cm / sheet.height_cm, to_x_cm / sheet.width_cm,
      1.0 - to_y_cm / sheet.height_cm, kInk);
}

std::string main_box(const Sheet& sheet, double top_cm, const std::string& first,
                     const std::string& second) {
  const double middle_cm = kBoxLeft_cm + 0.5 * kBoxWidth_cm;
  return box_of(sheet, {kBoxLeft_cm, top_cm, kBoxWidth_cm, 1.2}) +
         text_on_sheet(sheet, first, middle_cm, top_cm + (second.empty() ? 0.6 : 0.4), "center") +
         (second.empty() ? "" : text_on_sheet(sheet, second, middle_cm, top_cm + 0.82, "center"));
}

std::string side_box(const Sheet& sheet, double top_cm, const std::vector<std::string>& lines) {
  std::string script = box_of(sheet, {kSideLeft_cm, top_cm, kSideWidth_cm,
                                      0.3 + kLine_cm * static_cast<double>(lines.size())});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    // SVG drops a space at a line's beginning, so the text's place gives the indentation.
    const std::size_t text = lines[i].find_first_not_of(' ');
    script += text_on_sheet(sheet, lines[i].substr(text),
                            kSideLeft_cm + 0.25 + 0.1 * static_cast<double>(text),
                            top_cm + 0.37 + kLine_cm * static_cast<double>(i));
  }
  return script;
}

constexpr std::size_t kMaxPoints = 300;
/// A logarithmic axis has no zero.
constexpr double kLeast_us = 0.1;

/// One column of the data.
struct LatenessSeries {
  const char* name;
  int mark;
  const char* look;
  std::size_t colour;
};
constexpr std::array<LatenessSeries, 3> kSeries{{{"median", 7, "ps 0.35", 0},
                                                 {"99th percentile", 9, "ps 0.45", 2},
                                                 {"worst", 2, "ps 0.45 lw 1.2", 1}}};

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5).value_or(kLeast_us);
}

/// One point from several trials: the medians of their percentiles, and the worst of all.
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
  return (trials + kMaxPoints - 1) / kMaxPoints;
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

/// Lines where a session begins, except the first.
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
  return dashed_line(period_us) +
         text_at("one tick",
                 fmt::format("graph 0.99, first {:.6g} right offset 0, 0.5", period_us));
}

}  // namespace

std::optional<Figure> flow_figure(const StudyHead& report) {
  const ParticipantFlow& flow = report.collection.flow;
  if (flow.enrolled == 0) return {};
  std::vector<std::string> lines = left_out(flow);
  const int missing = flow.enrolled - flow.analysed;
  if (!lines.empty()) lines.insert(lines.begin(), fmt::format("not analysed (n = {})", missing));
  const double side_cm = lines.empty() ? 0.0 : 0.3 + kLine_cm * static_cast<double>(lines.size());
  const double between_cm = std::max(1.0, side_cm + 0.5);
  const double top_cm = 0.6;
  const Sheet sheet{kWidth_cm, top_cm + 1.2 + between_cm + 1.2 + 0.3, report.simulated};
  const double middle_cm = kBoxLeft_cm + 0.5 * kBoxWidth_cm;
  const double turn_cm = top_cm + 1.2 + 0.5 * between_cm;

  Figure figure = figure_on(sheet, "participant-flow");
  figure.caption = stamped(report.simulated, "participants from enrolment to analysis.");
  figure.alt = fmt::format("{} participants enrolled, {} analysed with {} trials.", flow.enrolled,
                           flow.analysed, report.trials);
  for (const std::string& line : lines)
    figure.alt += " " + line.substr(line.find_first_not_of(' ')) + ";";
  figure.script =
      sheet_head(sheet) + panel_at(sheet, {0.0, 0.0, 0.0, 0.0}) +
      "unset border\nunset tics\nunset grid\nset xrange [0:1]\nset yrange [0:1]\n" +
      main_box(sheet, top_cm, fmt::format("enrolled (n = {})", flow.enrolled), "") +
      arrow_of(sheet, middle_cm, top_cm + 1.2, middle_cm, top_cm + 1.2 + between_cm) +
      main_box(sheet, top_cm + 1.2 + between_cm, fmt::format("analysed (n = {})", flow.analysed),
               fmt::format("{} trials", report.trials));
  if (!lines.empty()) {
    figure.script += arrow_of(sheet, middle_cm, turn_cm, kSideLeft_cm, turn_cm) +
                     side_box(sheet, turn_cm - 0.5 * side_cm, lines);
  }
  figure.script += "plot NaN notitle\n";
  return figure;
}

std::optional<Figure> servo_figure(const StudyHead& report, const std::string& section) {
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
  std::string plot;
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < kSeries.size(); ++i) {
    const auto& [name, mark, look, colour] = kSeries[i];
    plot += fmt::format("{}$servo using 1:{} with points pt {} {} lc rgb '{}' notitle",
                        i == 0 ? "plot " : ", ", i + 2, mark, look, series_colour(colour));
    entries.push_back(mark_entry(mark, series_colour(colour), name));
  }
  const Legend legend(sheet, margins.left_cm, entries);
  Figure figure = figure_on(sheet, "servo-lateness", {}, section);
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

void stamp_figures(const std::string& stamp, std::vector<Figure>& figures) {
  if (stamp.empty()) return;
  for (Figure& figure : figures) {
    const Sheet sheet{figure.width_cm, figure.height_cm, false};
    figure.script = text_on_sheet(sheet, stamp, sheet.width_cm - 0.17, 0.6,
                                  "left rotate by -90 textcolor rgb '#b3261e'") +
                    figure.script;
    figure.alt = stamp + ". " + figure.alt;
  }
}

}  // namespace touchtrial::analysis
