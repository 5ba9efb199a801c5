/// \file Verification of a study's files on disk. A damaged file is a finding, not an error.
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
  /// beside the database, where it may be missing.
  bool key_named = false;
  /// Head files in addition to those beside the database or on record; of a collected study, those
  /// of the stations' databases.
  std::vector<std::filesystem::path> heads{};
  /// Empty: study::find_pack, if it exists and belongs to this study.
  std::filesystem::path pack;
};

/// Opens a study's files and verifies them with verify_study. A damaged database, key or pack is a
/// failed check.
/// \param head  as for verify_study
/// \throws StoreError if the database is missing, is not one of Touchtrial, or has a newer schema
[[nodiscard]] Verification verify_files(const StudyFiles& files, const std::string& head);

}  // namespace touchtrial::analysis
