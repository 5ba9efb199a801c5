#include "protocols/identification/analysis/figures/figures.hpp"

#include "analysis/figures/study_figures.hpp"
#include "analysis/figures/style.hpp"
#include "protocols/identification/analysis/figures/figure_kinds.hpp"

#include <utility>

namespace touchtrial::analysis::identification {

namespace {

/// Stamps the right edge with upright text below SIMULATED, where every figure leaves room.
void add_stamp(Figure& figure, const std::string& stamp) {
  const Sheet sheet{figure.width_cm, figure.height_cm, false};
  figure.script = text_on_sheet(sheet, stamp, sheet.width_cm - 0.17, 0.6,
                                "left rotate by -90 textcolor rgb '#b3261e'") +
                  figure.script;
  figure.alt = stamp + ". " + figure.alt;
}

}  // namespace

std::vector<Figure> report_figures(const StudyReport& report, const FigureOptions& options) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(flow_figure(report));
  add(accuracy_figure(report, options.paper_values));
  add(methods_figure(report));
  add(participants_figure(report));
  for (Figure& figure : confusion_figures(report)) figures.push_back(std::move(figure));
  add(trials_figure(report));
  add(reaction_figure(report));
  if (options.cues != nullptr) add(cues_figure(*options.cues));
  add(servo_figure(report));
  for (const ExplorationPath& path : options.explorations) figures.push_back(path_figure(path));
  if (!options.stamp.empty()) {
    for (Figure& figure : figures) add_stamp(figure, options.stamp);
  }
  return figures;
}

}  // namespace touchtrial::analysis::identification
