/// \file Holds a database against its head files: what verify, report and status say of its end.
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

/// What a database's head files say of it.
struct HeadCheck {
  /// What the database lacks, or why it or a head file cannot be read; empty: nothing is missing.
  std::string lacks;
  /// Head files that the database has on record and that are gone, in words; empty: none.
  std::string gone;
  int compared = 0;  ///< head files
  /// Of the head file that knows the longest chain: the database's end was vouched for up to there.
  std::optional<record::HeadRecord> vouched{};
  std::vector<std::string> notes{};  ///< what is worth knowing and no fault

  /// Both faults, one after the other; empty: there is none.
  [[nodiscard]] std::string fault() const;
  /// One line for a report: the head that was compared, or what is wrong.
  [[nodiscard]] std::string words() const;
};

/// Holds a database against the head files that lie beside it or are on record.
/// \param given  further head files, which may stand in for those that are gone
/// \throws DamagedStore if the database cannot be read
[[nodiscard]] HeadCheck check_heads(const record::StudyStore& store,
                                    const std::filesystem::path& database,
                                    std::span<const std::filesystem::path> given = {});

/// The stations of a collected study, held against the head files of their own databases.
struct StationsCheck {
  std::string lacks;   ///< stations, or ends of their chains, that a head file knows; empty: none
  std::string absent;  ///< other stations of the key that are not there; empty: none
  std::string ends;    ///< of the chains of stations whose head file was not given; empty: none
};

/// \param signers  public halves of all stations that the study's key lists, by name
/// \param given  head files of stations' databases
/// \throws StoreError if the database cannot be read
[[nodiscard]] StationsCheck check_stations(const record::StudyStore& store,
                                           const std::map<std::string, PublicKey>& signers,
                                           std::span<const std::filesystem::path> given);

}  // namespace touchtrial::analysis
