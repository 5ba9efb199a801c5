/// \file A copy of a study's database, for an archive.
#pragma once

#include <filesystem>

namespace touchtrial::store {

/// Lays a copy at a path, of the database as it is now, whatever others write meanwhile. A copy
/// that is broken off leaves no file of that name; a file that is there is replaced. \throws
/// StoreError if there is no such database, another program keeps it from being read, or the
///   copy cannot be written
void copy_database(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace touchtrial::store
