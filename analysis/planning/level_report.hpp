/// \file The levels of a study's stimuli in words, tables and JSON. What they are: docs/perception.md.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/results.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "study/study.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// One table of stimuli by device, with the ranges over the curves; for one device a second one by
/// bands; how far the stimuli are apart; and what level alone gives away.
[[nodiscard]] analysis::Section levels_section(const study::Study& study,
                                               const simulation::StimulusLevels& levels);

/// A list as `prepare --json` has it, as JSON: docs/data-dictionary.md, "levels".
[[nodiscard]] std::string levels_json(const simulation::PlaneLevels& levels);
/// How far each two stimuli are apart; empty for more than 40 stimuli.
[[nodiscard]] std::string differences_json(const study::Study& study,
                                           const simulation::StimulusLevels& levels);

/// Both of every stimulus and of the blank plane: the member "levels" of `report --json`.
[[nodiscard]] std::string all_levels_json(const study::Study& study,
                                          const simulation::StimulusLevels& levels);

/// One line, with its key, if stimuli are too weak on the study's device by either curve. None for
/// a study without a device, one that states its level, and one that looks for thresholds.
[[nodiscard]] std::vector<std::string> level_warnings(const study::Study& study,
                                                      const simulation::StimulusLevels& levels);

/// \return the range over all devices and curves, dB: "12 to 31"
[[nodiscard]] std::string range_words(const simulation::PlaneLevels& levels);

/// Results with a section on levels and a member "levels".
[[nodiscard]] std::unique_ptr<const analysis::Results> with_levels(
    std::unique_ptr<const analysis::Results> results, const study::Study& study,
    simulation::StimulusLevels levels);

/// Results with a section that says where the levels are, which were not computed.
[[nodiscard]] std::unique_ptr<const analysis::Results> with_levels_note(
    std::unique_ptr<const analysis::Results> results);

}  // namespace touchtrial::planning
