#include "analysis/report/figures/style.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// The maximum number of lines that can be distinguished; if there are more, only every n-th is
/// drawn.
constexpr std::size_t kMaxLines = 150;
/// So few lines are darker.
constexpr std::size_t kFewLines = 12;
constexpr double kDifferenceWidth = 0.7;

/// Accuracies by participant and method, in per cent.
using Accuracies = std::map<std::string, std::vector<std::optional<double>>>;

Accuracies accuracies_of(const StudyReport& report) {
  Accuracies all;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    for (const ParticipantAccuracy& participant : report.methods[i].per_participant) {
      auto& shares = all[participant.participant];
      shares.resize(report.methods.size());
      if (participant.accuracy.share()) shares[i] = 100.0 * *participant.accuracy.share();
    }
  }
  return all;
}

Layer lines_of(const Accuracies& all) {
  Layer lines{.kind = LayerKind::line,
              .name = "participants",
              .colour = std::string(all.size() > kFewLines ? kPale : kFaint),
              .size = all.size() > kFewLines ? 0.6 : 0.9,
              .in_key = true};
  const std::size_t step = (all.size() + kMaxLines - 1) / kMaxLines;
  std::size_t number = 0;
  for (const auto& [participant, shares] : all) {
    if (number++ % step != 0) continue;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      lines.rows.push_back({.x = static_cast<double>(i + 1),
                            .y = shares[i].value_or(kNoNumber),
                            .text = participant});
    }
  }
  return lines;
}

Panel people_panel(const StudyReport& report, const Accuracies& all) {
  Layer means{.kind = LayerKind::line, .name = "means", .size = 1.8};
  Layer marks{.kind = LayerKind::interval,
              .name = "mean, 95% interval",
              .size = 1.3,
              .glyph = Glyph::diamond,
              .in_key = true};
  Panel panel;
  panel.x = names_axis({});
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    panel.x.names.push_back(method.method);
    if (!method.mean.mean) continue;
    marks.rows.push_back(
        bar(static_cast<double>(i + 1), *method.mean.mean, method.mean.known_interval(), 100.0));
    means.rows.push_back(marks.rows.back());
    marks.rows.back().text = method.method;
  }
  panel.y = percent_axis("correct, %");
  panel.height_cm = 5.6;
  panel.layers = {chance_rule(static_cast<int>(report.classes.size())), lines_of(all),
                  std::move(means), marks};
  // Labels of inner marks are above them, where lines do not cross.
  for (std::size_t i = 0; i < marks.rows.size(); ++i) {
    const Datum& row = marks.rows[i];
    const bool is_inner = i > 0 && i + 1 < marks.rows.size();
    const Anchor anchor = i == 0 ? Anchor::end : is_inner ? Anchor::middle : Anchor::start;
    const double offset = i == 0 ? -0.06 : is_inner ? 0.0 : 0.06;
    panel.layers.push_back(direct_label(row.x + offset, is_inner ? row.high + 4.0 : row.y,
                                        fmt::format("{:.0f}", row.y), std::string(kInk), anchor));
  }
  return panel;
}

std::string pair_name(const StudyReport& report, const MethodPair& pair) {
  return report.methods[static_cast<std::size_t>(pair.first)].method + " − " +
         report.methods[static_cast<std::size_t>(pair.second)].method;
}

/// The differences of participants with both methods, in percentage points.
std::vector<ParticipantValue> differences(const Accuracies& all, const MethodPair& pair) {
  std::vector<ParticipantValue> differences;
  for (const auto& [participant, shares] : all) {
    const auto first = shares[static_cast<std::size_t>(pair.first)];
    const auto second = shares[static_cast<std::size_t>(pair.second)];
    if (first && second) differences.push_back({*first - *second, participant});
  }
  return differences;
}

/// \return a panel without names if nobody felt both methods of a pair
Panel differences_panel(const StudyReport& report, const Accuracies& all) {
  Layer dots{.name = "participants' differences", .colour = std::string(kFaint), .size = 0.9};
  Layer means{
      .kind = LayerKind::interval, .name = "mean difference", .size = 1.3, .glyph = Glyph::diamond};
  Panel panel;
  for (const MethodPair& pair : report.pairs) {
    if (!pair.overall.difference) continue;
    panel.x.names.push_back(pair_name(report, pair));
    const auto x = static_cast<double>(panel.x.names.size());
    swarm(dots.rows, x - 0.08, kDifferenceWidth, 0.8, differences(all, pair));
    means.rows.push_back(
        bar(x + 0.36, *pair.overall.difference, pair.overall.known_interval(), 100.0));
    means.rows.back().text = panel.x.names.back();
  }
  Interval range{0.0, 0.0};
  for (const Layer* layer : {&dots, &means}) {
    for (const Datum& row : layer->rows) {
      range.low = std::min({range.low, row.y, std::isfinite(row.low) ? row.low : row.y});
      range.high = std::max({range.high, row.y, std::isfinite(row.high) ? row.high : row.y});
    }
  }
  const double room = std::max(0.05 * (range.high - range.low), 1.0);
  Layer zero{.kind = LayerKind::rule,
             .name = "no difference",
             .rows = {{.y = 0.0}},
             .colour = std::string(kPale)};
  panel.y = {
      .label = "difference, percentage points", .low = range.low - room, .high = range.high + room};
  panel.height_cm = 0.0;
  panel.share = 0.45 + 0.25 * static_cast<double>(panel.x.names.size());
  panel.layers = {std::move(zero), std::move(dots), std::move(means)};
  return panel;
}

std::string alt_of_people(const StudyReport& report) {
  std::string alt = "Each participant's accuracy from method to method as a line, and the means.";
  for (const MethodReport& method : report.methods) {
    if (!method.mean.mean) continue;
    alt += fmt::format(" {}: {} participants, mean {}.", method.method, method.mean.participants,
                       share_with_interval(*method.mean.mean, method.mean.known_interval()));
  }
  for (const MethodPair& pair : report.pairs) {
    if (!pair.overall.difference) continue;
    alt += fmt::format(" {}: {:+.1f} percentage points", pair_name(report, pair),
                       100.0 * *pair.overall.difference);
    if (const auto interval = pair.overall.known_interval()) {
      alt += fmt::format(" ({:+.1f} to {:+.1f})", 100.0 * interval->low, 100.0 * interval->high);
    }
    alt += fmt::format(", participants: {}.", pair.overall.participants);
  }
  return alt;
}

bool has_times(const MethodReport& method, std::size_t classes) {
  return method.reaction_times.size() >= classes &&
         std::any_of(
             method.reaction_times.begin(),
             method.reaction_times.begin() + static_cast<std::ptrdiff_t>(classes),
             [](const ReactionTimes& times) { return times.from_plane_on.median.has_value(); });
}

/// The range of the reaction times of all methods, in seconds.
Interval range_of_times(std::span<const MethodReport* const> methods, std::size_t classes) {
  Interval range{0.0, 0.0};
  for (const MethodReport* method : methods) {
    for (std::size_t i = 0; i < classes; ++i) {
      const std::vector<double>& times = method->reaction_times[i].seconds;
      const auto positive = std::ranges::upper_bound(times, 0.0);
      if (positive == times.end()) continue;
      range.low = range.low > 0.0 ? std::min(range.low, *positive) : *positive;
      range.high = std::max(range.high, times.back());
    }
  }
  return range;
}

Panel reaction_panel(const StudyReport& report, const MethodReport& method, const Interval& range) {
  constexpr double kOverlap = 0.03;        ///< share of the range
  constexpr double kMaxLinearRatio = 6.0;  ///< highest to lowest time on a linear axis
  Layer dots{.name = "trials", .colour = std::string(kPale), .size = 0.55};
  Layer boxes{.kind = LayerKind::box, .name = "quartiles and median", .colour = series_colour(0)};
  for (std::size_t i = 0; i < report.classes.size(); ++i) {
    const auto x = static_cast<double>(i + 1);
    std::vector<ParticipantValue> times;
    for (const double seconds : method.reaction_times[i].seconds) times.push_back({seconds});
    swarm(dots.rows, x, 0.8, kOverlap * (range.high - range.low), std::move(times));
    const Quartiles& q = method.reaction_times[i].from_plane_on;
    if (!q.median) continue;
    boxes.rows.push_back({.x = x,
                          .y = *q.median,
                          .low = *q.lower,
                          .high = *q.upper,
                          .value = 0.62,
                          .text = report.classes[i]});
  }
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = {.label = "reaction time, s",
             .logarithmic = range.high > kMaxLinearRatio * range.low && range.low > 0.0};
  if (range.high > 0.0) {
    panel.y.low = 0.9 * range.low;
    panel.y.high = 1.1 * range.high;
  }
  panel.layers = {std::move(dots), std::move(boxes)};
  return panel;
}

std::string alt_of_reactions(const StudyReport& report, const MethodReport& method) {
  std::string alt;
  for (std::size_t i = 0; i < report.classes.size(); ++i) {
    const Quartiles& q = method.reaction_times[i].from_plane_on;
    if (!q.median) continue;
    alt += fmt::format(" {}, {}: {:.2f} s ({:.2f} to {:.2f});", method.method, report.classes[i],
                       *q.median, *q.lower, *q.upper);
  }
  return alt;
}

}  // namespace

std::optional<Figure> people_figure(const StudyReport& report) {
  const bool has_means = std::ranges::any_of(
      report.methods, [](const MethodReport& method) { return method.mean.mean.has_value(); });
  if (report.methods.size() < 2 || !has_means) return {};
  const Accuracies all = accuracies_of(report);
  Figure figure = empty_figure("methods-by-person", "result", report.simulated, 13.0);
  figure.panels = {people_panel(report, all)};
  Panel differences = differences_panel(report, all);
  const bool has_pairs = !differences.x.names.empty();
  if (has_pairs) {
    figure.panels_per_row = 2;
    if (differences.x.names.size() > 1) figure.width_cm = kPage_cm;
    figure.panels.push_back(std::move(differences));
  }
  figure.alt = alt_of_people(report);
  figure.caption = stamped(
      report.simulated,
      std::string(has_pairs ? "left: each" : "each") +
          " participant's accuracy with each method, and the means with their 95% t intervals "
          "over participants." +
          (has_pairs ? " Right: each participant's difference, and the mean with its interval."
                     : ""));
  return figure;
}

std::optional<Figure> trials_figure(const StudyReport& report) {
  Figure figure = empty_figure("accuracy-over-trials", "order", report.simulated);
  Panel panel;
  panel.x = {.label = "trial of a participant", .low = 0.0};
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size()))};
  figure.alt = "Accuracy over a participant's trials.";
  double width = 0.0;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const AccuracyOverTrials& course = report.methods[i].accuracy_over_trials;
    const std::string& name = report.methods[i].method;
    Layer band{.kind = LayerKind::band, .name = name + ", interval", .colour = series_colour(i)};
    Layer line{.kind = LayerKind::line,
               .name = name,
               .colour = series_colour(i),
               .size = 1.6,
               .in_key = report.methods.size() > 1};
    for (const AccuracyAtPlace& point : course.points) {
      if (!point.mean.mean) continue;
      band.rows.push_back(bar(point.place, *point.mean.mean, point.mean.known_interval(), 100.0));
      line.rows.push_back({.x = point.place, .y = 100.0 * *point.mean.mean});
    }
    if (line.rows.empty()) continue;
    width = std::max(width, course.width);
    figure.alt += fmt::format(" {}: {:.1f}% at first, {:.1f}% at last.", name, line.rows.front().y,
                              line.rows.back().y);
    panel.layers.insert(panel.layers.begin() + 1, std::move(band));
    panel.layers.push_back(std::move(line));
  }
  if (panel.layers.size() < 2) return {};
  figure.panels = {std::move(panel)};
  figure.caption = stamped(
      report.simulated,
      fmt::format("accuracy over a participant's trials of the method: each participant's answers "
                  "smoothed by a Gaussian kernel (standard deviation {:.2g} trials), the mean over "
                  "participants and its pointwise 95% t interval.",
                  width));
  return figure;
}

std::optional<Figure> reaction_figure(const StudyReport& report) {
  const std::size_t classes = report.classes.size();
  std::vector<const MethodReport*> methods;
  for (const MethodReport& method : report.methods) {
    if (has_times(method, classes)) methods.push_back(&method);
  }
  if (methods.empty() || classes == 0) return {};
  const bool is_wide = methods.size() > 1 || classes > 8;
  Figure figure = empty_figure("reaction-times", "reaction-times", report.simulated,
                               is_wide ? kPage_cm : kColumn_cm);
  figure.panels_per_row = classes > 8 ? 1 : 2;
  figure.alt = "Median reaction time and quartiles by class:";
  const Interval range = range_of_times(methods, classes);
  for (const MethodReport* method : methods) {
    figure.panels.push_back(reaction_panel(report, *method, range));
    if (methods.size() > 1) figure.panels.back().title = method->method;
    figure.alt += alt_of_reactions(report, *method);
  }
  figure.caption = stamped(
      report.simulated,
      fmt::format(
          "reaction times by presented class, from plane-on to the answer: the trials of all "
          "participants with a response (at most {} per class, evenly over their order), their "
          "quartiles and median.",
          kMaxDots));
  return figure;
}

}  // namespace touchtrial::analysis::identification
