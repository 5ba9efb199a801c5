/// \file The page of an identification study and its sections, as its results use them.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/page/study_document.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis::identification {

/// The sentences above the figure of the result, after the verdict.
[[nodiscard]] Section result_section(const StudyReport& report);
[[nodiscard]] Section accuracy_section(const StudyReport& report);
/// \param drawn  whether a figure shows the confusions, so that their tables are folded
[[nodiscard]] Section confusions_section(const StudyReport& report, bool drawn);
/// Answers by their places on the screen, and who prefers a picture: folded unless somebody does.
/// \return a section without blocks if no answer has a place
[[nodiscard]] Section places_section(const StudyReport& report);
/// The comparison of two or more methods.
/// \return a section without blocks if there is one method
[[nodiscard]] Section comparison_section(const StudyReport& report);
[[nodiscard]] Section order_section(const StudyReport& report);
/// Accuracies by visit and by group.
/// \return a section without blocks if the study has one visit and no groups
[[nodiscard]] Section visits_section(const StudyReport& report);
/// How sure participants were.
/// \return a section without blocks if they were not asked
[[nodiscard]] Section confidence_section(const StudyReport& report);
[[nodiscard]] Section times_section(const StudyReport& report);
/// Folded.
/// \param explores  whether there are pictures of explorations, which stand at its end
[[nodiscard]] Section cues_section(const StudyReport& report, bool explores = false);
/// The servo and the validity of trials, and the results with and without invalid trials.
[[nodiscard]] Section robustness_section(const StudyReport& report);

/// Adds a subheading with the method's name if the report has several methods.
/// \param section  its id begins the id of the heading
void add_method_heading(const StudyReport& report, std::size_t method, Section& section);
/// Which method a table is of, if the report has several.
struct TableName {
  std::string id;
  std::string caption;
};
[[nodiscard]] TableName method_table_name(const StudyReport& report, std::size_t method,
                                          const std::string& id, const std::string& caption);
/// The table of a list of measures, with that name.
template <typename Row>
[[nodiscard]] Table method_table(const StudyReport& report, std::size_t method,
                                 const std::string& id, const std::string& caption,
                                 const std::vector<Row>& rows, const MeasureList<Row>& measures) {
  TableName name = method_table_name(report, method, id, caption);
  return table_of(std::move(name.id), std::move(name.caption), rows, measures);
}
/// The beginning of captions: for example "adaptive: " if the report has several methods, otherwise
/// empty.
[[nodiscard]] std::string method_prefix(const StudyReport& report, std::size_t method);

/// The report after unblinding.
/// \param pictures  in the order in which they appear
[[nodiscard]] Document study_document(const StudyReport& report, const Provenance& provenance,
                                      const Pictures& pictures = {});

}  // namespace touchtrial::analysis::identification
