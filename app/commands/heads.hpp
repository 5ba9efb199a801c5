/// \file The head files of a database at its station. What they know must be there before anything
/// is recorded.
#pragma once

#include "core/public_keys.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::app {

struct HeadOptions {
  /// Folder of the second head file from now on; nothing: the one of the last time. The head files
  /// that are on record are read in any case.
  std::optional<std::filesystem::path> folder{};
  std::string accept_loss{};  ///< why to go on without what is lost; empty: do not
};

/// Whether a database must have a head file: at sessions it gets one.
enum class HeadUse { required, if_there };

/// Refuses to begin a database anew where a head file knows the one that was there, unless the
/// options accept the loss.
/// \throws StoreError, naming the head file and the remedy
/// \throws FileError if a head file or its folder cannot be used
void refuse_lost_database(const std::filesystem::path& database,
                          const record::StudyCommitment& commitment, const HeadOptions& options);

/// Holds the database against its head files, and lets them know from now on what is recorded. A
/// loss that the options accept is recorded, and so is where a head file is required which ones
/// there are.
/// \pre store.sign_with(signer)
/// \throws StoreError, naming what is missing and the remedy, if the database lacks something that
///   a head file knows, a head file that is on record is gone, or it has sessions and no head file
///   at all where one is required
/// \throws FileError if a head file or its folder cannot be used
void keep_heads(record::StudyStore& store, const std::filesystem::path& database,
                const Signer& signer, const HeadOptions& options, HeadUse use);

/// Holds a database that is only read against the head files that are in reach.
/// \throws VerificationError, naming what the database lacks and the remedy
/// \throws FileError if the head file cannot be read
void require_head_beside(const std::filesystem::path& database);

/// Makes the head file of a database that was filled at once, as simulations do, and has none.
void make_head(const record::StudyStore& store, const std::filesystem::path& database,
               const Signer& signer);

/// "head 0f3a 91c2 77de 4b08, 75 answers acknowledged", of the database as it is.
[[nodiscard]] std::string head_words(const record::StudyStore& store);

}  // namespace touchtrial::app
