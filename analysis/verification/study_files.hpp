/// \file Verification of a study's files on disk. A damaged file is a failed check, not an error.
#pragma once

#include "analysis/verification/verification.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// The paths of a study's files.
struct StudyFiles {
  std::filesystem::path database;
  std::filesystem::path key;
  /// Whether the user named the key, which must then exist. Otherwise `key` is the default path
  /// beside the database and may be missing.
  bool key_named = false;
  /// Head files in addition to those beside the database or recorded in it. For a collected study,
  /// the head files of the stations' databases.
  std::vector<std::filesystem::path> heads{};
  /// Empty: the pack that study::find_pack returns, if it exists and belongs to this study.
  std::filesystem::path pack;
};

/// Opens a study's files and verifies them with verify_study. A damaged database, key or pack is a
/// failed check.
/// \param head  as for verify_study
/// \throws StoreError if the database is missing, is not a Touchtrial database, or has a newer
///   schema
[[nodiscard]] Verification verify_files(const StudyFiles& files, const std::string& head);

}  // namespace touchtrial::analysis
