/// \file The study of a session (its codes and pack, checked against each other and the study
/// file), and its database.
#pragma once

#include "app/run/run_session.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "record/session_lock.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::app {

struct RunStudy {
  study::StationKey key;
  engine::Pack pack;
  session::StimulusSource source;  ///< the pack's stimuli
  /// The investigator's key, if it is beside the pack; otherwise empty.
  std::filesystem::path reachable_key{};
  /// The key of a simulated study that was not prepared, for its new database.
  std::optional<study::StudyKey> new_key{};
};

/// Loads the pack and this station's file, but never the investigator's key. For a simulated
/// participant of a study that was not prepared, makes a simulated study.
/// \throws StudyError if the study file does not match the station's file
/// \throws FileError if pack, station's file or a shown picture is missing, damaged or does not
///   match the investigator's signature, or if another process prepares the pack; with the remedy
[[nodiscard]] RunStudy run_study_for(const RunOptions& options);

/// The database of a session, with a lock on its participant. A new one is created when the session
/// begins, so that a refused run leaves no file.
class RunDatabase {
 public:
  /// Opens the database if it exists.
  /// \param options,study  must outlive this
  /// \throws StoreError if it is another study's, if it mixes pilot or simulated sessions with
  ///   others, if it was merged from several stations, or if its folder does not exist
  /// \throws as StudyStore::open and SessionLock
  RunDatabase(const RunOptions& options, const RunStudy& study);

  /// \return null while there is no database
  [[nodiscard]] const record::StudyStore* existing_store() const noexcept {
    return store_ ? &*store_ : nullptr;
  }
  /// Creates the database with the study's commitment if it does not exist.
  /// \throws StoreError if it cannot be created
  [[nodiscard]] record::StudyStore& open_or_create();

 private:
  void open();

  const RunOptions& options_;
  const RunStudy& study_;
  record::StudyCommitment commitment_;
  std::optional<record::SessionLock> lock_;
  std::optional<record::StudyStore> store_;
};

}  // namespace touchtrial::app
