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
  session::StimulusSource source;  ///< of the pack
  /// The investigator's key, if it lies beside the pack; else empty.
  std::filesystem::path key_in_reach{};
  /// Of a simulated study that was not prepared: its key, for the database that is made.
  std::optional<study::StudyKey> own_key{};
};

/// Loads the pack and this station's file; never the investigator's key. For a simulated
/// participant of a study that was not prepared, makes a simulated study.
/// \throws StudyError if the study file is not that of the station's file
/// \throws FileError if pack, station's file or a shown picture is missing, damaged or not what the
///   investigator signed, or if another process prepares the pack, with the remedy
[[nodiscard]] RunStudy run_study_for(const RunOptions& options);

/// The database of a session, with a lock on its participant. If there is none yet, it is made when
/// the session begins, so that a run that is refused leaves nothing.
class RunDatabase {
 public:
  /// Opens the database if there is one.
  /// \param options,study  must outlive this
  /// \throws StoreError if it is another study's, if it mixes pilot or simulated sessions with
  ///   others, if it was merged from several stations, or if there is no folder for it
  /// \throws as StudyStore::open and SessionLock
  RunDatabase(const RunOptions& options, const RunStudy& study);

  /// \return null while there is no database
  [[nodiscard]] const record::StudyStore* present() const noexcept {
    return store_ ? &*store_ : nullptr;
  }
  /// Makes the database with the study's commitment if there is none.
  /// \throws StoreError if it cannot be made
  [[nodiscard]] record::StudyStore& made();

 private:
  void open();

  const RunOptions& options_;
  const RunStudy& study_;
  record::StudyCommitment ours_;
  std::optional<record::SessionLock> lock_;
  std::optional<record::StudyStore> store_;
};

}  // namespace touchtrial::app
