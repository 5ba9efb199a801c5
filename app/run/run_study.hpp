/// \file The study of a session (its codes and pack, checked against each other and the study
/// file), and its database.
#pragma once

#include "app/run/run_session.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::app {

struct RunStudy {
  design::StationKey key;
  engine::Pack pack;
  bool key_in_reach = false;  ///< the investigator's key lies beside the pack
};

/// Loads the pack and this station's file; never the investigator's key. For a simulated
/// participant of a study that was not prepared, makes a simulated study and saves its key beside
/// the database.
/// \throws StudyError if the study file has changed since it was prepared
/// \throws FileError if pack or station file is missing or damaged, with the remedy
[[nodiscard]] RunStudy run_study_for(const RunOptions& options);

/// Opens the database, or creates it with the study's commitment if there is none.
/// \throws StoreError if it is another study's, if it mixes pilot or simulated sessions with
///   others, or if it was merged from several stations
/// \throws as StudyStore::open
[[nodiscard]] store::StudyStore run_database_for(const RunOptions& options, const RunStudy& study);

}  // namespace touchtrial::app
