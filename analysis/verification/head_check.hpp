/// \file Compares the end of a database's chain with its head files, for verify, report and status.
#pragma once

#include "core/public_keys.hpp"
#include "record/head_file.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The result of comparing a database with its head files.
struct HeadCheck {
  /// Missing events, or why the database or a head file cannot be read; empty: no fault.
  std::string missing;
  /// Recorded head files that no longer exist, with the remedy; empty: none.
  std::string missing_files;
  int compared = 0;  ///< number of head files
  /// The record of the head file with the longest chain; it confirms the database up to its end.
  std::optional<record::HeadRecord> confirmed{};
  std::vector<std::string> notes{};  ///< remarks that are not faults

  /// `missing` and `missing_files`, joined; empty: no fault.
  [[nodiscard]] std::string fault() const;
  /// One line for a report: the confirmed head, or the fault.
  [[nodiscard]] std::string words() const;
};

/// Compares a database with the head files beside it and the head files that it records.
/// \param extra_heads  further head files, which may replace missing ones
/// \throws DamagedStore if the database cannot be read
[[nodiscard]] HeadCheck check_heads(const record::StudyStore& store,
                                    const std::filesystem::path& database,
                                    std::span<const std::filesystem::path> extra_heads = {});

/// The result of comparing a collected study's stations with the head files of their databases.
struct StationsCheck {
  std::string missing;  ///< stations or chain ends that a head file proves missing; empty: none
  std::string absent;   ///< absent stations without a head file in `extra_heads`; empty: none
  std::string
      unchecked_ends;  ///< chain ends of stations without a head file in `extra_heads`; empty: none
};

/// \param signers  public keys of all stations that the study's key lists, by name
/// \param extra_heads  head files of stations' databases
/// \throws StoreError if the database cannot be read
[[nodiscard]] StationsCheck check_stations(const record::StudyStore& store,
                                           const std::map<std::string, PublicKey>& signers,
                                           std::span<const std::filesystem::path> extra_heads);

}  // namespace touchtrial::analysis
