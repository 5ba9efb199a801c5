/// \file The head files of a database at its station. The database must contain everything that
///   they record before anything is added.
#pragma once

#include "core/public_keys.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::app {

struct HeadOptions {
  /// Folder of the second head file from now on; if not set, the previous folder. Recorded head
  /// files are always read.
  std::optional<std::filesystem::path> folder{};
  std::string accept_loss{};  ///< the reason to accept a loss; empty: refuse it
};

/// Whether a database must have a head file; sessions require one and create it.
enum class HeadUse { required, if_present };

/// Refuses to create a database if a head file records an earlier one, unless the options accept
/// the loss.
/// \throws StoreError, naming the head file and the remedy
/// \throws FileError if a head file or its folder cannot be used
void refuse_lost_database(const std::filesystem::path& database,
                          const record::StudyCommitment& commitment, const HeadOptions& options);

/// Compares the database with its head files, and keeps them up to date from now on. A loss that
/// the options accept is recorded. Where a head file is required, the existing ones are recorded
/// too.
/// \pre store.sign_with(signer)
/// \throws StoreError, naming what is missing and the remedy, if the database lacks something that
///   a head file records, a recorded head file is missing, or it has sessions but no head file
///   where one is required
/// \throws FileError if a head file or its folder cannot be used
void set_head_writer(record::StudyStore& store, const std::filesystem::path& database,
                     const Signer& signer, const HeadOptions& options, HeadUse use);

/// Compares a database that will only be read with the accessible head files.
/// \throws VerificationError, naming what the database lacks and the remedy
/// \throws FileError if the head file cannot be read
void check_against_heads(const std::filesystem::path& database);

/// Creates the head file of a database that was filled in one step, for instance by a simulation.
void make_head(const record::StudyStore& store, const std::filesystem::path& database,
               const Signer& signer);

/// "head 0f3a 91c2 77de 4b08, 75 answers acknowledged", of the current database.
[[nodiscard]] std::string head_words(const record::StudyStore& store);

}  // namespace touchtrial::app
