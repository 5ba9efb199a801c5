/// \file The kinds of figures of a report. A function returns nothing if the figure has nothing to
/// show. Private to figures.
#pragma once

#include "protocols/identification/analysis/figures/figures.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis::identification {

/// Accuracy by class (Fig. 6 of the source paper) for a report with one method; methods_figure
/// shows several.
[[nodiscard]] std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values);
/// Methods side by side for each class (Fig. 7 of the source paper), and participants' differences.
[[nodiscard]] std::optional<Figure> methods_figure(const StudyReport& report);
/// Every participant's accuracy, the mean and its interval.
[[nodiscard]] std::optional<Figure> participants_figure(const StudyReport& report);
/// Confusion matrices, one for each method.
[[nodiscard]] std::vector<Figure> confusion_figures(const StudyReport& report);
/// Accuracy by the place of a trial among a participant's trials.
[[nodiscard]] std::optional<Figure> trials_figure(const StudyReport& report);
/// Reaction times by class.
[[nodiscard]] std::optional<Figure> reaction_figure(const StudyReport& report);
/// Accuracies of ideal observers beside those of participants.
[[nodiscard]] std::optional<Figure> cues_figure(const CueReport& cues);
/// The path of one trial over its texture, coloured by force.
[[nodiscard]] Figure path_figure(const ExplorationPath& path);
}  // namespace touchtrial::analysis::identification
