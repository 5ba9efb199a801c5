/// \file The measures of a threshold study, for its page, results.json and thresholds.csv. A report
/// must outlive the lists, which refer to it.
#pragma once

#include "analysis/report/listed_measures.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The measures of a track, with the columns of thresholds.csv.
[[nodiscard]] MeasureList<TrackReport> track_measures(const ThresholdReport& report);
[[nodiscard]] MeasureList<StandardReport> standard_measures(const ThresholdReport& report);
[[nodiscard]] MeasureList<DifferenceReport> difference_measures(const ThresholdReport& report);
/// Mean, interval, standard deviation and median, and the reason if the first two are missing.
/// \param name  of the mean's member
[[nodiscard]] MeasureList<CensoredMean> censored_measures(const std::string& name);

/// \param has_participants  whether rows are participants; adds names and adjusted p
[[nodiscard]] MeasureList<RightAnswers> right_measures(bool has_participants);
[[nodiscard]] MeasureList<ChoiceUse> choice_measures();
[[nodiscard]] MeasureList<Repetition> repetition_measures();
/// A mean over participants, tested against 0.
/// \param name  of the mean's member
[[nodiscard]] MeasureList<GroupTest> test_measures(const std::string& name);

/// Measures of the task "same or different".
[[nodiscard]] MeasureList<SameDifferentLevel> level_measures(const ThresholdReport& report);
[[nodiscard]] MeasureList<SameDifferentGroup> group_measures(const ThresholdReport& report);

/// The objects of these lists in results.json.
/// \param report  of any threshold study; may be empty
[[nodiscard]] std::vector<ListedObject> listed_objects(const ThresholdReport& report);

}  // namespace touchtrial::analysis::threshold
