/// \file Exports a study's data as CSV files or as one JSON file. Format: docs/data-dictionary.md,
/// "Exports".
#pragma once

#include "analysis/exports/export_folder.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/results.hpp"
#include "record/event.hpp"
#include "record/personal_data.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

inline constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

/// The tables that export_csv writes, under the names of their files.
/// \param outcomes  of this store; nothing before unblinding
/// \param consents  from the personal data, if available
[[nodiscard]] std::vector<ResultTable> exported_tables(
    const record::StudyStore& store, const std::optional<Outcomes>& outcomes,
    const std::vector<record::PersonalRecord>& consents = {});

/// Writes trials.csv, participants.csv, deviations.csv, servo.csv, people_tables and study.csv.
/// With outcomes it also writes the tables of the protocol's analysis (for example,
/// confusion_<method>.csv for each presented method), unscored_trials.csv and study_file.json. The
/// last file, export.json, lists the others and states whether they are simulated. Creates the
/// folder if necessary; does not touch files of other origin. Equal studies give equal bytes.
/// \param outcomes  of this store; nothing before unblinding
/// \param consents  from the personal data, if available
/// \param start  the start of each CSV file; Excel recognises UTF-8 only after kByteOrderMark
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_csv(
    const record::StudyStore& store, const std::optional<Outcomes>& outcomes,
    const std::filesystem::path& folder, const std::vector<record::PersonalRecord>& consents = {},
    const std::string& start = {});

/// Writes people_tables beside the files of `export_r_model`.
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_typed_text(
    const record::StudyStore& store, const Outcomes& outcomes, const std::filesystem::path& folder,
    const std::vector<record::PersonalRecord>& consents);

/// Writes events.csv and one file per flight record, for sessions whose outcomes may be shown and
/// whose data were not erased. Requires unblinding, because the forces before a fault can reveal
/// textures.
/// \param outcomes  of this store, opened with `key`
/// \return the files, in the order written
/// \throws VerificationError, naming the event, if a sealed part does not open
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_events(const record::StudyStore& store,
                                                 const study::StudyKey& key,
                                                 const Outcomes& outcomes,
                                                 const std::filesystem::path& folder);

/// The kinds of events in events.csv: all kinds that no other export lists individually.
[[nodiscard]] std::vector<record::EventKind> kinds_in_events_csv();

/// The files that export_events writes.
/// \param prefix  of every file's name
/// \throws VerificationError, naming the event, if a sealed part does not open
[[nodiscard]] std::vector<ExportFile> event_files(const record::StudyStore& store,
                                                  const study::StudyKey& key,
                                                  const Outcomes& outcomes,
                                                  const std::string& prefix = {});

/// Writes study.json: the report (before unblinding, the quality report) and the tables of the CSV
/// export, with their columns as keys. A missing value is null; times are in seconds. Arguments and
/// errors: see export_csv.
/// \return the file
std::filesystem::path export_json(const record::StudyStore& store,
                                  const std::optional<Outcomes>& outcomes,
                                  const std::filesystem::path& folder,
                                  const std::vector<record::PersonalRecord>& consents = {});

}  // namespace touchtrial::analysis
