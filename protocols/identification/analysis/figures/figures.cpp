#include "protocols/identification/analysis/figures/figures.hpp"

#include "analysis/report/figures/study_figures.hpp"
#include "protocols/identification/analysis/figures/figure_kinds.hpp"

#include <utility>

namespace touchtrial::analysis::identification {

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
  stamp_figures(options.stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::identification
