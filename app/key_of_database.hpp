/// \file The key that belongs to a database.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>

namespace touchtrial::app {

/// Loads `given`, or the key beside the database if that is empty.
/// \throws FileError if it is missing (and how to name another), or damaged
/// \throws VerificationError, naming both files, if it is not the database's
[[nodiscard]] design::StudyKey key_of_database(const store::StudyStore& store,
                                               const std::filesystem::path& database,
                                               const std::filesystem::path& given);

}  // namespace touchtrial::app
