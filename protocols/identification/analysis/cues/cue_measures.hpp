/// \file The numbers of ideal observers, for the page and results.json.
#pragma once

#include "analysis/report/measure.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"

namespace touchtrial::analysis::identification {

/// An observer's accuracy, and participants' efficiency.
[[nodiscard]] MeasureList<ObserverFigures> efficiency_measures();
/// Divergence of an observer's confusions from the participants'.
/// \param match  its best observer is emphasised
[[nodiscard]] MeasureList<ObserverFigures> divergence_measures(
    const std::optional<CueMatch>& match = {});

/// The member "cues" of results.json.
[[nodiscard]] nlohmann::ordered_json cues_object(const CueReport& report);

}  // namespace touchtrial::analysis::identification
