/// \file The first hundred bytes of an SQLite file, read without SQLite.
/// Source: "Database File Format", section 1.3, https://www.sqlite.org/fileformat2.html
#pragma once

#include <cstdint>
#include <filesystem>

namespace touchtrial::store {

/// What tells our databases from other SQLite files: "TTRL" in SQLite's application_id.
inline constexpr std::int32_t kApplicationId = 0x5454524c;

/// Looks at a file before SQLite does, so that a file of others, a newer one, one older than
/// kOldestSchemaVersion, or a truncated one is refused untouched.
/// \param newest_version  the newest schema that the program knows
/// \throws DamagedStore if it is truncated or has no version, StoreError for all else; both with
///   file and remedy
void check_header(const std::filesystem::path& path, int newest_version);

/// Whether a write-ahead log lies beside the database, with anything in it.
[[nodiscard]] bool has_log(const std::filesystem::path& path);

}  // namespace touchtrial::store
