/// \file The measures of an identification study, for its page, results.json and CSV files. Arguments
/// must outlive the lists, which refer to them.
#pragma once

#include "analysis/report/listed_measures.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// n, correct and p of trials.
[[nodiscard]] MeasureList<Proportion> trials_measures();
/// Participants, mean and interval of a mean accuracy.
[[nodiscard]] MeasureList<MeanEstimate> mean_measures();

/// The accuracy over all trials of a method.
[[nodiscard]] MeasureList<MethodReport> overall_measures();
/// overall_measures with d' and information.
[[nodiscard]] MeasureList<MethodReport> headline_measures(const StudyReport& report);
/// Rows are indices of classes; the index after the last is for all classes.
[[nodiscard]] MeasureList<std::size_t> accuracy_measures(const StudyReport& report,
                                                         const MethodReport& method);
[[nodiscard]] MeasureList<ParticipantAccuracy> participant_measures(const StudyReport& report);
[[nodiscard]] MeasureList<ChanceTest> chance_measures();
/// Chance test and prevalence.
[[nodiscard]] MeasureList<MethodReport> ability_measures();
/// Answers by class index, with the columns of confusion_METHOD.csv.
[[nodiscard]] MeasureList<int> confusion_measures(const std::vector<std::string>& classes,
                                                  const ConfusionMatrix& confusion);
[[nodiscard]] MeasureList<LabelMatching> matching_measures(const std::vector<std::string>& classes);

/// Whether the groups of a breakdown differ in their people, so that numbers are means over people.
[[nodiscard]] bool is_between_people(BreakdownKind kind);
[[nodiscard]] MeasureList<GroupAccuracy> breakdown_measures(BreakdownKind kind);
[[nodiscard]] MeasureList<SubsetAccuracy> subset_measures();
[[nodiscard]] MeasureList<RatedAccuracy> rating_measures(const ConfidenceReport& confidence);
[[nodiscard]] MeasureList<choices::PlaceUse> place_measures(const choices::AnswersByPlace& places);

[[nodiscard]] MeasureList<MethodPair> pair_measures(const StudyReport& report);
/// Rows are indices of classes.
[[nodiscard]] MeasureList<std::size_t> class_measures(const StudyReport& report,
                                                      const MethodPair& pair);

/// The objects of these lists in results.json.
[[nodiscard]] std::vector<ListedObject> listed_objects();

/// The indices of the rows of a confusion matrix.
[[nodiscard]] std::vector<int> class_indices(const ConfusionMatrix& confusion);
/// "25 (83%)", or "0"
[[nodiscard]] std::string count_and_percentage(int count, int total);
/// "25/30 83.3%"; a dash without trials
[[nodiscard]] std::string count_and_share(const Proportion& trials);

}  // namespace touchtrial::analysis::identification
