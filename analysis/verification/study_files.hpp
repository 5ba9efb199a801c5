/// \file A study as it lies on disk, verified: files that are damaged are findings, not errors.
#pragma once

#include "analysis/verification/verification.hpp"

#include <filesystem>
#include <functional>
#include <optional>

namespace touchtrial::analysis {

/// Where a study's files are.
struct StudyFiles {
  std::filesystem::path database;
  std::filesystem::path key;
  bool key_named = false;      ///< then it must be there; else it is the one beside the database
  std::filesystem::path pack;  ///< empty: where the key says, if it is there and of this study
};

/// How the database is opened; it may throw what StudyStore::open throws.
using StudyOpener = std::function<store::StudyStore(const std::filesystem::path&)>;

/// As verify_study. A damaged database, key or pack is a failed check.
/// \param open  for reading; empty: as StudyStore does
/// \throws StoreError if the database is missing, none of Touchtrial, or of a newer schema
[[nodiscard]] Verification verify_files(const StudyFiles& files, const std::optional<Digest>& head,
                                        const StudyOpener& open = {});

}  // namespace touchtrial::analysis
