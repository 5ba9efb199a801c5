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
  /// Missing events, or why the database or a head file cannot be read; empty: none.
  std::string missing;
  /// Message about recorded head files that no longer exist; empty: none.
  std::string missing_files;
  int compared = 0;  ///< head files
  /// The record of the head file with the longest chain: the database is confirmed up to there.
  std::optional<record::HeadRecord> confirmed{};
  std::vector<std::string> notes{};  ///< remarks that are not faults

  /// Both faults, joined; empty: there is none.
  [[nodiscard]] std::string fault() const;
  /// One line for a report: the head that was compared, or what is wrong.
  [[nodiscard]] std::string words() const;
};

/// Compares a database with its head files: those beside it, and those that it records.
/// \param given  further head files, which may replace missing ones
/// \throws DamagedStore if the database cannot be read
[[nodiscard]] HeadCheck check_heads(const record::StudyStore& store,
                                    const std::filesystem::path& database,
                                    std::span<const std::filesystem::path> given = {});

/// The result of comparing a collected study's stations with the head files of their own databases.
struct StationsCheck {
  std::string missing;  ///< missing stations or chain ends that a head file has; empty: none
  std::string absent;   ///< other stations of the key that are absent; empty: none
  std::string ends;     ///< chain ends of stations whose head file was not given; empty: none
};

/// \param signers  public halves of all stations that the study's key lists, by name
/// \param given  head files of stations' databases
/// \throws StoreError if the database cannot be read
[[nodiscard]] StationsCheck check_stations(const record::StudyStore& store,
                                           const std::map<std::string, PublicKey>& signers,
                                           std::span<const std::filesystem::path> given);

}  // namespace touchtrial::analysis
