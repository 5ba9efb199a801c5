/// \file The study of a session (its key and pack, checked against each other and the study file),
/// and its database.
#pragma once

#include "app/run/run_options.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::app {

struct RunStudy {
  design::StudyKey key;
  engine::Pack pack;
};

/// Loads what `prepare` made, with the key that `--key` names, or else the key beside the database,
/// or else the key beside the pack. For a simulated participant of a study that was not prepared,
/// makes a simulated study and saves its key beside the database.
/// \throws StudyError if the study file has changed since it was prepared
/// \throws FileError if pack or key is missing or damaged, with the remedy
[[nodiscard]] RunStudy run_study_for(const RunOptions& options);

/// Opens the database, or creates it with the study's commitment if there is none.
/// \throws StoreError if it is another study's, if it mixes pilot or simulated sessions with
/// others,
///   or if it was merged from several stations
/// \throws as StudyStore::open
[[nodiscard]] store::StudyStore run_database_for(const RunOptions& options, const RunStudy& study);

}  // namespace touchtrial::app
