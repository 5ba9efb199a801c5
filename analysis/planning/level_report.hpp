/// \file The levels of a study's stimuli as text, tables and JSON. Definition: docs/perception.md.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/results.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "study/study.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// A section with a table of stimuli by device, with the ranges over the curves. It also has a
/// table by bands if there is one device, the distances between stimuli, and the accuracy possible
/// from level alone.
[[nodiscard]] analysis::Section levels_section(const study::Study& study,
                                               const simulation::StimulusLevels& levels);

/// Levels as JSON, as in `prepare --json`: docs/data-dictionary.md, "levels".
[[nodiscard]] std::string levels_json(const simulation::PlaneLevels& levels);
/// The differences of all pairs of stimuli; empty for more than 40 stimuli.
[[nodiscard]] std::string differences_json(const study::Study& study,
                                           const simulation::StimulusLevels& levels);

/// Levels and differences of all stimuli and of the blank plane: the member "levels" of `report
/// --json`.
[[nodiscard]] std::string all_levels_json(const study::Study& study,
                                          const simulation::StimulusLevels& levels);

/// A one-line warning that starts with the setting to change, if stimuli are too weak on the
/// study's device by either curve. Empty for a study that names no device, states a level, or
/// measures thresholds.
[[nodiscard]] std::vector<std::string> level_warnings(const study::Study& study,
                                                      const simulation::StimulusLevels& levels);

/// \return the range over all devices and curves, dB: "12 to 31"
[[nodiscard]] std::string range_words(const simulation::PlaneLevels& levels);

/// \return the results with an additional section on levels and a JSON member "levels"
[[nodiscard]] std::unique_ptr<const analysis::Results> with_levels(
    std::unique_ptr<const analysis::Results> results, const study::Study& study,
    simulation::StimulusLevels levels);

/// \return the results with a section that states how to get the levels, which were not computed
[[nodiscard]] std::unique_ptr<const analysis::Results> with_levels_note(
    std::unique_ptr<const analysis::Results> results);

}  // namespace touchtrial::planning
