/// \file Exports about people: all data about one participant, and the safety record of all.
/// Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/exports/dataset.hpp"
#include "record/personal_data.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Writes a study's data about one participant: the rows of participants.csv, trials.csv,
/// deviations.csv, incidents.csv and servo.csv, the times of the sessions, and every consent with
/// the personal data. With outcomes, also the unscored trials, answers to questions, and the events
/// with flight records. Every file's name begins with the id.
/// \param study  with the outcomes of this participant (load_outcomes); without outcomes, only
///   unencrypted data are written
/// \param consents  of this participant; empty: none recorded
/// \return the files, in the order written
/// \throws StoreError if the participant has no session and no personal data
/// \throws VerificationError, naming the event, if a sealed part does not open
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_participant(
    const DatasetSource& study, const std::string& participant,
    const std::vector<record::PersonalRecord>& consents, const std::filesystem::path& folder);

/// Writes safety_sessions.csv and safety_events.csv: stops, faults, largest forces, reasons and
/// deviations of all participants, including those whose data were erased. They never contain
/// outcomes.
/// \param key  opens texts; null: only codes are written
/// \return the files, in the order written
/// \throws VerificationError if the key does not match the database, or a text does not open
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_safety(const record::StudyStore& store,
                                                 const study::StudyKey* key,
                                                 const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
