/// \file The numbers of a threshold study, for its page, its results.json and thresholds.csv. Lists
/// that take a report refer to it: it must outlive them.
#pragma once

#include "analysis/report/listed_measures.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// Of each track. The columns are those of thresholds.csv.
[[nodiscard]] MeasureList<TrackReport> track_measures(const ThresholdReport& report);
/// Of each class and standard.
[[nodiscard]] MeasureList<StandardReport> standard_measures(const ThresholdReport& report);
[[nodiscard]] MeasureList<DifferenceReport> difference_measures(const ThresholdReport& report);
/// Mean, interval, standard deviation and median, and what keeps the first two away.
/// \param name  of the mean's member
[[nodiscard]] MeasureList<CensoredMean> censored_measures(const std::string& name);

/// Right answers: of participants with their names and adjusted p, or of all together.
[[nodiscard]] MeasureList<RightAnswers> right_measures(bool of_participants);
[[nodiscard]] MeasureList<ChoiceUse> choice_measures();
[[nodiscard]] MeasureList<Repetition> repetition_measures();
/// A mean over participants, tested against 0.
/// \param name  of the mean's member
[[nodiscard]] MeasureList<GroupTest> test_measures(const std::string& name);

/// Of same or different.
[[nodiscard]] MeasureList<SameDifferentLevel> level_measures(const ThresholdReport& report);
[[nodiscard]] MeasureList<SameDifferentGroup> group_measures(const ThresholdReport& report);

/// What these lists make in results.json.
/// \param report  of any threshold study; it may be without numbers
[[nodiscard]] std::vector<ListedObject> listed_objects(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
