/// \file The numbers of an identification study, for its page, its results.json and its CSV files.
/// Lists that take a part of a report refer to it: it must outlive them.
#pragma once

#include "analysis/report/listed_measures.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// Of a share of trials: n, correct and p.
[[nodiscard]] MeasureList<Proportion> trials_measures();
/// Participants, mean and interval of a mean accuracy.
[[nodiscard]] MeasureList<MeanEstimate> mean_measures();

/// All trials of a method.
[[nodiscard]] MeasureList<MethodReport> overall_measures();
/// The same, with d' and information.
[[nodiscard]] MeasureList<MethodReport> headline_measures(const StudyReport& report);
/// Of each class by its index, and of all together by the index after the last.
[[nodiscard]] MeasureList<std::size_t> accuracy_measures(const StudyReport& report,
                                                         const MethodReport& method);
[[nodiscard]] MeasureList<ParticipantAccuracy> participant_measures(const StudyReport& report);
[[nodiscard]] MeasureList<ChanceTest> chance_measures();
/// Whether somebody can, and how many would pass their own test.
[[nodiscard]] MeasureList<MethodReport> ability_measures();
/// The answers to each class, by its index. The columns are those of confusion_METHOD.csv.
[[nodiscard]] MeasureList<int> confusion_measures(const std::vector<std::string>& classes,
                                                  const ConfusionMatrix& confusion);
[[nodiscard]] MeasureList<LabelMatching> matching_measures(const std::vector<std::string>& classes);

/// Whether a breakdown is about people, so that its numbers are means over them.
[[nodiscard]] bool is_about_people(BreakdownKind kind);
[[nodiscard]] MeasureList<GroupAccuracy> breakdown_measures(BreakdownKind kind);
[[nodiscard]] MeasureList<SubsetAccuracy> subset_measures();
[[nodiscard]] MeasureList<RatedAccuracy> rating_measures(const ConfidenceReport& confidence);
[[nodiscard]] MeasureList<choices::PlaceUse> place_measures(const choices::AnswersByPlace& places);

[[nodiscard]] MeasureList<MethodPair> pair_measures(const StudyReport& report);
/// Of each class, by its index.
[[nodiscard]] MeasureList<std::size_t> class_measures(const StudyReport& report,
                                                      const MethodPair& pair);

/// What these lists make in results.json.
[[nodiscard]] std::vector<ListedObject> listed_objects();

/// The rows of a confusion matrix.
[[nodiscard]] std::vector<int> class_indices(const ConfusionMatrix& confusion);
/// "25 (83%)", of a row; "0" for none.
[[nodiscard]] std::string count_and_percentage(int count, int of);
/// "25/30 83.3%"; a dash without trials.
[[nodiscard]] std::string count_and_share(const Proportion& of);

}  // namespace touchtrial::analysis::identification
