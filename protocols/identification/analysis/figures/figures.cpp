#include "protocols/identification/analysis/figures/figures.hpp"

#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// A matrix of more classes takes the whole width of the page.
constexpr std::size_t kMaxClassesInColumn = 6;

bool has_confusions(const StudyReport& report, const MethodReport& method) {
  return method.confusion.classes() == static_cast<int>(report.classes.size()) &&
         method.confusion.accuracy().n > 0;
}

Datum tile_of(int column, int row, int count, int total) {
  const double share = total > 0 ? static_cast<double>(count) / total : 0.0;
  return {.x = column + 1.0,
          .y = row + 1.0,
          .low = static_cast<double>(count),
          .high = static_cast<double>(total),
          .value = share,
          .text = fmt::format("{:.0f}", 100.0 * share)};
}

/// Rows are presented classes, columns answers, the last one for trials without a response, if any.
Panel confusion_panel(const StudyReport& report, const MethodReport& method) {
  const ConfusionMatrix& confusion = method.confusion;
  const int classes = confusion.classes();
  bool all_answered = true;
  for (int row = 0; row < classes; ++row) all_answered &= confusion.no_response(row) == 0;
  Layer tiles{.kind = LayerKind::tile, .name = "per cent of the row"};
  for (int row = 0; row < classes; ++row) {
    const int total = confusion.presented(row);
    for (int column = 0; column < classes; ++column) {
      tiles.rows.push_back(tile_of(column, row, confusion.count(row, column), total));
    }
    if (!all_answered) {
      tiles.rows.push_back(tile_of(classes, row, confusion.no_response(row), total));
    }
  }
  std::vector<std::string> answers = report.classes;
  if (!all_answered) answers.emplace_back("(none)");
  Panel panel;
  panel.aspect = static_cast<double>(classes) / static_cast<double>(answers.size());
  panel.x = names_axis(std::move(answers), "answer, %");
  panel.y = names_axis(report.classes, "presented");
  panel.y.reversed = true;
  panel.layers = {std::move(tiles)};
  return panel;
}

std::string alt_of_confusions(const StudyReport& report, const MethodReport& method) {
  std::string alt = "Confusion matrix of " + method.method + ", rows presented, columns answered.";
  for (int row = 0; row < method.confusion.classes(); ++row) {
    alt += fmt::format(" {}:", report.classes[static_cast<std::size_t>(row)]);
    for (int column = 0; column < method.confusion.classes(); ++column) {
      alt += fmt::format(" {}", method.confusion.count(row, column));
    }
    alt += fmt::format(", no response {}.", method.confusion.no_response(row));
  }
  return alt;
}

/// Participants' accuracies and the mean.
Panel accuracies_panel(const StudyReport& report, const MethodReport& method) {
  Layer dots{.name = "participants", .colour = series_colour(0)};
  std::vector<ParticipantValue> values;
  for (const ParticipantAccuracy& participant : method.per_participant) {
    const std::optional<double> share = participant.accuracy.share();
    if (share) values.push_back({100.0 * *share, participant.participant});
  }
  swarm(dots.rows, 1.0, 1.0, 1.5, values);
  Layer mean{.kind = LayerKind::interval, .name = "mean", .size = 1.4, .glyph = Glyph::diamond};
  Panel panel;
  panel.height_cm = 0.0;
  panel.share = 0.55;
  panel.x = {.low = 0.3, .high = 2.5, .hidden = true};
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size())), std::move(dots)};
  if (!method.mean.mean) return panel;
  mean.rows = {bar(1.75, *method.mean.mean, method.mean.known_interval(), 100.0)};
  panel.layers.push_back(std::move(mean));
  panel.layers.push_back(direct_label(1.8, 100.0 * *method.mean.mean,
                                      fmt::format("{:.0f}%", 100.0 * *method.mean.mean),
                                      std::string(kInk)));
  return panel;
}

}  // namespace

std::optional<Figure> confusion_and_accuracy_figure(const StudyReport& report) {
  if (report.methods.size() != 1 || !has_confusions(report, report.methods.front())) return {};
  const MethodReport& method = report.methods.front();
  Figure figure = empty_figure("confusion-and-accuracy", "result", report.simulated,
                               report.classes.size() > kMaxClassesInColumn ? kPage_cm : 13.0);
  figure.panels_per_row = 2;
  figure.panels = {confusion_panel(report, method), accuracies_panel(report, method)};
  figure.caption = stamped(
      report.simulated,
      "left: answers to each presented class, per cent of its trials, all participants. Right: "
      "each participant's accuracy, and the mean with its 95% t interval over participants.");
  figure.alt = alt_of_confusions(report, method);
  if (method.mean.mean) {
    figure.alt += fmt::format(" Accuracy of {} participants: mean {}.", method.mean.participants,
                              share_with_interval(*method.mean.mean, method.mean.known_interval()));
  }
  return figure;
}

std::optional<Figure> confusions_figure(const StudyReport& report) {
  std::vector<const MethodReport*> methods;
  for (const MethodReport& method : report.methods) {
    if (has_confusions(report, method)) methods.push_back(&method);
  }
  if (report.methods.size() < 2 || methods.empty()) return {};
  Figure figure = empty_figure("confusions", "confusions", report.simulated, kPage_cm);
  figure.panels_per_row = report.classes.size() > kMaxClassesInColumn ? 1 : 2;
  for (const MethodReport* method : methods) {
    Panel panel = confusion_panel(report, *method);
    panel.title = method->method;
    figure.panels.push_back(std::move(panel));
    figure.alt += (figure.alt.empty() ? "" : " ") + alt_of_confusions(report, *method);
  }
  figure.caption = stamped(
      report.simulated,
      "answers to each presented class by method, per cent of its trials, all participants.");
  return figure;
}

std::vector<Figure> report_figures(const StudyReport& report, const FigureOptions& options) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(confusion_and_accuracy_figure(report));
  add(people_figure(report));
  add(flow_figure(report));
  add(accuracy_figure(report, options.paper_values));
  add(methods_figure(report));
  add(confusions_figure(report));
  add(trials_figure(report));
  add(reaction_figure(report));
  if (options.cues != nullptr) add(cues_figure(*options.cues));
  add(servo_figure(report, "servo-and-validity"));
  for (const ExplorationPath& path : options.explorations) figures.push_back(path_figure(path));
  stamp_figures(options.stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::identification
