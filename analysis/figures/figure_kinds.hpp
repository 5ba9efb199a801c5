/// \file Every kind of figure that a report may have; nothing where there is nothing to show.
/// Private to figures.
#pragma once

#include "analysis/figures/figures.hpp"

#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Accuracy by class of one method (Fig. 6); with several, methods_figure has it.
[[nodiscard]] std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values);
/// Methods side by side by class (Fig. 7), and participants' differences.
[[nodiscard]] std::optional<Figure> methods_figure(const StudyReport& report);
/// Every participant's accuracy, the mean and its interval.
[[nodiscard]] std::optional<Figure> participants_figure(const StudyReport& report);
/// What was taken for what; one a method.
[[nodiscard]] std::vector<Figure> confusion_figures(const StudyReport& report);
/// Accuracy by the place among a participant's trials.
[[nodiscard]] std::optional<Figure> trials_figure(const StudyReport& report);
/// Reaction times by class.
[[nodiscard]] std::optional<Figure> reaction_figure(const StudyReport& report);
/// Ideal observers beside participants.
[[nodiscard]] std::optional<Figure> cues_figure(const CueReport& cues);
/// Lateness of the servo; nothing for studies in virtual time.
[[nodiscard]] std::optional<Figure> servo_figure(const StudyReport& report);
/// A trial's path over its texture, with force.
[[nodiscard]] Figure path_figure(const ExplorationPath& path);
/// Participants from enrolment to analysis.
[[nodiscard]] std::optional<Figure> flow_figure(const StudyReport& report);

}  // namespace touchtrial::analysis
