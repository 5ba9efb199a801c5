/// \file The page of an identification study and its sections.
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

/// The sentences between the verdict and the figure of the result.
[[nodiscard]] Section result_section(const StudyReport& report);
[[nodiscard]] Section accuracy_section(const StudyReport& report);
/// \param has_figure  folds the tables
[[nodiscard]] Section confusions_section(const StudyReport& report, bool has_figure);
/// Answers by place on the screen, and preferences for pictures; folded unless there are
/// preferences.
/// \return a section without blocks if no answer has a place
[[nodiscard]] Section places_section(const StudyReport& report);
/// \return a section without blocks if there is one method
[[nodiscard]] Section comparison_section(const StudyReport& report);
[[nodiscard]] Section order_section(const StudyReport& report);
/// Accuracies by visit and by group.
/// \return a section without blocks if the study has one visit and no groups
[[nodiscard]] Section visits_section(const StudyReport& report);
/// \return a section without blocks if the study does not ask for confidence
[[nodiscard]] Section confidence_section(const StudyReport& report);
[[nodiscard]] Section times_section(const StudyReport& report);
/// Ideal observers, as a folded section.
/// \param has_explorations  whether pictures of explorations follow at the end
[[nodiscard]] Section cues_section(const StudyReport& report, bool has_explorations = false);
/// Servo timing, and results for other selections of trials.
[[nodiscard]] Section robustness_section(const StudyReport& report);

/// Adds a subheading with the method's name if the report has several methods.
/// \param section  its id is the prefix of the heading's id
void add_method_heading(const StudyReport& report, std::size_t method, Section& section);
/// The id and caption of a table, with the name of the method if the report has several.
struct TableName {
  std::string id;
  std::string caption;
};
[[nodiscard]] TableName method_table_name(const StudyReport& report, std::size_t method,
                                          const std::string& id, const std::string& caption);
/// A table of measures with method_table_name.
template <typename Row>
[[nodiscard]] Table method_table(const StudyReport& report, std::size_t method,
                                 const std::string& id, const std::string& caption,
                                 const std::vector<Row>& rows, const MeasureList<Row>& measures) {
  TableName name = method_table_name(report, method, id, caption);
  return table_of(std::move(name.id), std::move(name.caption), rows, measures);
}
/// The beginning of captions: "adaptive: " if the report has several methods, otherwise empty.
[[nodiscard]] std::string method_prefix(const StudyReport& report, std::size_t method);

/// \param pictures  in their order on the page
[[nodiscard]] Document study_document(const StudyReport& report, const Provenance& provenance,
                                      const Pictures& pictures = {});

}  // namespace touchtrial::analysis::identification
