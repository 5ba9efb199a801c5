/// \file Figures of identification reports.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/cues/exploration_path.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// The id of the subheading above pictures of explorations.
inline constexpr const char* kExplorations = "explorations";

struct FigureOptions {
  /// Shows the source paper's accuracies as open marks. They are of other images and another
  /// device, so they have a separate column unless a class has the name of the paper's image.
  bool paper_values = false;
  const CueReport* cues = nullptr;                  ///< not owned; null: no ideal observers
  std::span<const ExplorationPath> explorations{};  ///< one figure each, drawn last
  std::string stamp{};  ///< on every figure in addition to SIMULATED, such as "INTERIM LOOK"
};

/// All figures with data, in the order of a results section, not yet drawn. Cost: milliseconds.
/// Thread-safe.
[[nodiscard]] std::vector<Figure> report_figures(const StudyReport& report,
                                                 const FigureOptions& options = {});

/// \name Single figures, or nothing without data
/// \{

/// The answers to each class, and participants' accuracies, for a report with one method.
[[nodiscard]] std::optional<Figure> confusion_and_accuracy_figure(const StudyReport& report);
/// Each participant's accuracy from method to method, the mean, and the differences of pairs, for a
/// report with several methods.
[[nodiscard]] std::optional<Figure> people_figure(const StudyReport& report);
/// The answers to each class, for a report with several methods.
[[nodiscard]] std::optional<Figure> confusions_figure(const StudyReport& report);
/// Accuracy by class (Fig. 6 of the source paper) for a report with one method.
[[nodiscard]] std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values);
/// Methods side by side for each class (Fig. 7 of the source paper).
[[nodiscard]] std::optional<Figure> methods_figure(const StudyReport& report);
/// Accuracy over a participant's trials.
[[nodiscard]] std::optional<Figure> trials_figure(const StudyReport& report);
/// Reaction times by class.
[[nodiscard]] std::optional<Figure> reaction_figure(const StudyReport& report);
/// Accuracies of ideal observers and of participants.
[[nodiscard]] std::optional<Figure> cues_figure(const CueReport& cues);
/// The path of one trial over its texture, coloured by force, with arrows in the direction of time.
[[nodiscard]] Figure path_figure(const ExplorationPath& path);

/// \}

}  // namespace touchtrial::analysis::identification
