/// \file Every kind of figure of a report; each returns nothing if it has nothing to show.
/// Private to figures.
#pragma once

#include "protocols/identification/analysis/figures/figures.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis::identification {

/// Accuracy by class of one method (Fig. 6); with several, methods_figure has it.
[[nodiscard]] std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values);
/// Methods side by side by class (Fig. 7), and participants' differences.
[[nodiscard]] std::optional<Figure> methods_figure(const StudyReport& report);
/// Every participant's accuracy, the mean and its interval.
[[nodiscard]] std::optional<Figure> participants_figure(const StudyReport& report);
/// Confusion matrices, one for each method.
[[nodiscard]] std::vector<Figure> confusion_figures(const StudyReport& report);
/// Accuracy by the trial's place among a participant's trials.
[[nodiscard]] std::optional<Figure> trials_figure(const StudyReport& report);
/// Reaction times by class.
[[nodiscard]] std::optional<Figure> reaction_figure(const StudyReport& report);
/// Ideal observers beside participants.
[[nodiscard]] std::optional<Figure> cues_figure(const CueReport& cues);
/// The path of one trial over its texture, with force.
[[nodiscard]] Figure path_figure(const ExplorationPath& path);
}  // namespace touchtrial::analysis::identification
