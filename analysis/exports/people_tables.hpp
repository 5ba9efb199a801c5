/// \file Tables of answers to questions, incidents, marks and consents. Columns:
/// docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/outcomes/answers.hpp"
#include "analysis/outcomes/incidents.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/results.hpp"
#include "record/personal_data.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Whether a table may contain typed text, which may name people.
enum class FreeText { shown, left_out };

/// One row per answer, with the wording of its question and the text of the chosen option if they
/// are known.
/// \param free_text  left_out: without free-text answers and ages
[[nodiscard]] DataTable answers_table(const Outcomes& outcomes,
                                      FreeText free_text = FreeText::shown);

/// The cells participant, session, event, kind, at_s, trial, code, safety_fault, device_fault and
/// text.
[[nodiscard]] std::vector<DataCell> incident_cells(const Incident& incident);

/// One row per incident. Without outcomes, times and texts are sealed and their cells empty.
/// \param free_text  left_out: without texts
[[nodiscard]] DataTable incidents_table(const record::StudyStore& store,
                                        const std::optional<Outcomes>& outcomes,
                                        FreeText free_text = FreeText::shown);

/// One row per consent of participants with sessions whose data were not erased: the number of the
/// consent and the signed version, but no date or other personal data.
[[nodiscard]] DataTable consents_table(const record::StudyStore& store,
                                       const std::vector<record::PersonalRecord>& consents);

/// A table as CSV.
/// \param has_words  it contains people's words, so only the owner may read the file
/// \param start  precedes the table
[[nodiscard]] ExportFile text_table_file(const std::string& name, const DataTable& table,
                                         bool has_words, const std::string& start = {});

/// The marks sent to other instruments: their times on the session's clock and, if the Lab
/// Streaming Layer was used, on its clock.
[[nodiscard]] DataTable marks_table(const Outcomes& outcomes);

/// answers.csv (with outcomes), incidents.csv, and marks.csv and consents.csv if there are any.
[[nodiscard]] std::vector<ResultTable> people_tables(
    const record::StudyStore& store, const std::optional<Outcomes>& outcomes,
    const std::vector<record::PersonalRecord>& consents);

}  // namespace touchtrial::analysis
