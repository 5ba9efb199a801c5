#include "analysis/report/figures/study_figures.hpp"

#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr double kLine_cm = 0.42;
constexpr double kBoxWidth_cm = 3.6;
constexpr double kBoxHeight_cm = 1.2;
constexpr double kSideLeft_cm = 5.2;
constexpr double kSideWidth_cm = 8.0;
constexpr std::size_t kSideColumns = 46;
constexpr std::size_t kMaxReasons = 8;

/// Each reason with its number of participants.
void add_reasons(std::vector<std::string>& lines, const ParticipantFlow& flow) {
  std::map<std::string, int> counts;
  for (const std::string& reason : flow.exclusion_reasons) ++counts[reason];
  std::size_t reason_count = 0;
  for (const auto& [reason, count] : counts) {
    if (++reason_count > kMaxReasons) {
      lines.push_back(fmt::format("    and {} further reasons", counts.size() - kMaxReasons));
      return;
    }
    lines.push_back(
        "    " + fitted(fmt::format("{}: {}", count, reason.empty() ? "no reason given" : reason),
                        kSideColumns));
  }
}

std::vector<std::string> losses_of(const ParticipantFlow& flow) {
  std::vector<std::string> lines;
  add_people(flow.erased, "withdrawn, data erased", lines);
  add_people(flow.replaced, "replaced by another participant", lines);
  add_people(flow.stopped, "stopped before the end", lines);
  add_people(flow.open, "session not ended", lines);
  add_people(flow.other_kind, "of another kind (pilot or simulated)", lines);
  add_people(flow.unseen, "completed after the interim look", lines);
  add_people(flow.excluded, "excluded", lines);
  add_reasons(lines, flow);
  return lines;
}

/// The boxes of a flow chart and the arrows between them, in cm.
struct FlowChart {
  Layer outlines{.kind = LayerKind::line, .name = "boxes"};
  Layer arrows{.kind = LayerKind::arrow, .name = "ways"};
  Layer counts{.kind = LayerKind::label, .name = "counts"};
  Layer losses{.kind = LayerKind::label, .name = "losses", .anchor = Anchor::start};

  void add_outline(double left, double top, double width, double height) {
    const std::string id = std::to_string(outlines.rows.size());
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}, {0, 0}}) {
      outlines.rows.push_back({.x = left + x * width, .y = top + y * height, .text = id});
    }
  }
  void add_main_box(double top, const std::vector<std::string>& texts) {
    add_outline(0.0, top, kBoxWidth_cm, kBoxHeight_cm);
    double y = top + 0.5 * kBoxHeight_cm - 0.5 * kLine_cm * static_cast<double>(texts.size() - 1);
    for (const std::string& text : texts) {
      counts.rows.push_back({.x = 0.5 * kBoxWidth_cm, .y = y, .text = text});
      y += kLine_cm;
    }
  }
  void add_side_box(double middle, const std::vector<std::string>& texts) {
    const double height = 0.3 + kLine_cm * static_cast<double>(texts.size());
    double y = middle - 0.5 * height;
    add_outline(kSideLeft_cm, y, kSideWidth_cm, height);
    y += 0.37;
    for (const std::string& text : texts) {
      // SVG drops leading spaces, so x gives the indentation.
      const std::size_t begin = text.find_first_not_of(' ');
      losses.rows.push_back({.x = kSideLeft_cm + 0.1 * static_cast<double>(begin),
                             .y = y,
                             .text = text.substr(begin)});
      y += kLine_cm;
    }
    arrows.rows.push_back(
        {.x = 0.5 * kBoxWidth_cm, .y = middle, .low = kSideLeft_cm, .high = middle});
  }
};

constexpr std::size_t kMaxPoints = 300;
constexpr double kMinLateness_us = 0.1;  ///< for the logarithmic axis

/// Lateness in microseconds.
struct LatenessSummary {
  double median = 0.0;
  double p99 = 0.0;
  double worst = 0.0;
};

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5).value_or(kMinLateness_us);
}

/// Medians of the trials' percentiles, and the worst of all.
LatenessSummary lateness_of(std::span<const ServoTrial> trials) {
  std::vector<double> medians;
  std::vector<double> p99s;
  LatenessSummary row{0.0, 0.0, kMinLateness_us};
  for (const ServoTrial& trial : trials) {
    medians.push_back(std::max(trial.health.lateness_p50_us, kMinLateness_us));
    p99s.push_back(std::max(trial.health.lateness_p99_us, kMinLateness_us));
    row.worst = std::max(row.worst, trial.health.lateness_worst_us);
  }
  row.median = median_of(std::move(medians));
  row.p99 = median_of(std::move(p99s));
  return row;
}

/// The starts of sessions except the first; empty if there are too many to distinguish.
Layer session_lines(std::span<const ServoTrial> trials) {
  Layer lines{.kind = LayerKind::rule, .name = "a new session", .colour = "#e0e0e0", .size = 0.6};
  for (std::size_t i = 1; i < trials.size(); ++i) {
    if (trials[i].session != trials[i - 1].session) {
      lines.rows.push_back({.x = static_cast<double>(i) + 0.5});
    }
  }
  if (lines.rows.size() > 60) lines.rows.clear();
  return lines;
}

Layer period_line(std::span<const ServoTrial> trials) {
  double rate_hz = 0.0;
  for (const ServoTrial& trial : trials) rate_hz = std::max(rate_hz, trial.health.rate_hz);
  return rate_hz > 0.0 ? dashed_rule(1e6 / rate_hz, "one tick") : Layer{};
}

}  // namespace

std::optional<Figure> flow_figure(const StudyHead& report) {
  const ParticipantFlow& flow = report.collection.flow;
  std::vector<std::string> lines = losses_of(flow);
  if (lines.empty()) return {};
  lines.insert(lines.begin(), fmt::format("not analysed (n = {})", flow.enrolled - flow.analysed));
  const double gap_cm = std::max(1.0, 0.8 + kLine_cm * static_cast<double>(lines.size()));
  FlowChart parts;
  parts.add_main_box(0.0, {fmt::format("enrolled (n = {})", flow.enrolled)});
  parts.add_side_box(kBoxHeight_cm + 0.5 * gap_cm, lines);
  parts.arrows.rows.push_back({.x = 0.5 * kBoxWidth_cm,
                               .y = kBoxHeight_cm,
                               .low = 0.5 * kBoxWidth_cm,
                               .high = kBoxHeight_cm + gap_cm});
  parts.add_main_box(kBoxHeight_cm + gap_cm, {fmt::format("analysed (n = {})", flow.analysed),
                                              fmt::format("{} trials", report.trials)});

  const double height_cm = 2 * kBoxHeight_cm + gap_cm;
  const double width_cm = kSideLeft_cm + kSideWidth_cm;
  Figure figure = empty_figure("participant-flow", "", report.simulated, width_cm + 0.6);
  figure.caption = stamped(report.simulated, "participants from enrolment to analysis.");
  figure.alt = fmt::format("{} participants enrolled, {} analysed with {} trials.", flow.enrolled,
                           flow.analysed, report.trials);
  for (const std::string& line : lines)
    figure.alt += " " + line.substr(line.find_first_not_of(' ')) + ";";
  figure.panels = {{.x = {.low = 0.0, .high = width_cm, .hidden = true},
                    .y = {.low = -0.05, .high = height_cm + 0.05, .reversed = true, .hidden = true},
                    .layers = {parts.outlines, parts.arrows, parts.counts, parts.losses},
                    .height_cm = height_cm + 0.1}};
  return figure;
}

std::optional<Figure> servo_figure(const StudyHead& report, const std::string& section) {
  const std::span<const ServoTrial> trials = report.collection.servo_trials;
  if (trials.empty()) return {};
  const std::size_t trials_per_point = (trials.size() + kMaxPoints - 1) / kMaxPoints;
  const auto layer = [](const char* name, std::size_t series, double size, Glyph glyph) {
    return Layer{.name = name,
                 .colour = series_colour(series),
                 .size = size,
                 .glyph = glyph,
                 .in_key = true};
  };
  Layer median = layer("median", 0, 0.7, Glyph::disc);
  Layer p99 = layer("99th percentile", 2, 0.9, Glyph::triangle);
  Layer worst = layer("worst", 1, 0.9, Glyph::cross);
  double worst_us = 1.0;
  for (std::size_t first = 0; first < trials.size(); first += trials_per_point) {
    const std::size_t count = std::min(trials_per_point, trials.size() - first);
    const LatenessSummary row = lateness_of(trials.subspan(first, count));
    const double x = static_cast<double>(first) + 0.5 * static_cast<double>(count + 1);
    median.rows.push_back({.x = x, .y = row.median});
    p99.rows.push_back({.x = x, .y = row.p99});
    worst.rows.push_back({.x = x, .y = row.worst});
    worst_us = std::max(worst_us, row.worst);
  }
  Figure figure = empty_figure("servo-lateness", section, report.simulated, kPage_cm);
  figure.caption =
      stamped(report.simulated,
              "lateness of the servo's ticks, by trial in the order of sessions" +
                  (trials_per_point > 1
                       ? fmt::format("; a point is {} trials: the medians of their percentiles, "
                                     "and the latest tick of all",
                                     trials_per_point)
                       : std::string(" (grey lines: a new session)")) +
                  ". The dashed line is the time between two ticks.");
  figure.alt = fmt::format(
      "Lateness of the servo over {} trials: latest tick of all {:.0f} microseconds; median of the "
      "trials' 99th percentiles {:.0f} microseconds.",
      trials.size(), worst_us, lateness_of(trials).p99);
  figure.panels = {
      {.x = {.label = "trial", .low = 0.0, .high = static_cast<double>(trials.size() + 1)},
       .y = {.label = "lateness, µs",
             .high = std::max(2.0 * worst_us, 1500.0),
             .logarithmic = true},
       .layers = {session_lines(trials), period_line(trials), median, p99, worst}}};
  return figure;
}

void stamp_figures(const std::string& stamp, std::vector<Figure>& figures) {
  if (stamp.empty()) return;
  for (Figure& figure : figures) {
    figure.stamp = stamp;
    figure.alt = stamp + ". " + figure.alt;
  }
}

}  // namespace touchtrial::analysis
