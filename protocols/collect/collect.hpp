/// \file Several stations' files made one: the collected study. Source: docs/several-stations.md,
/// docs/decisions/0041.
#pragma once

#include "protocols/collect/station_file.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// Whether traces are taken along, or asked of the station when somebody wants one (the sources
/// then live as long as the collected study).
enum class TraceUse { copied, fetched };

using Stations = std::vector<std::unique_ptr<StationFile>>;

/// Called with how many sessions are collected, and how many there are.
using CollectProgress = std::function<void(int, int)>;

/// A session that is not in the collected study, because it has not ended.
struct SessionLeftOut {
  std::string station;  ///< StationFile::name
  int session = 0;      ///< its number there
  std::string participant;
  /// Replaced or withdrawn before it ended: it cannot go on, and is in no collected study.
  bool cut_short = false;
};

struct CollectReport {
  int stations = 0;
  int sessions = 0;
  std::vector<SessionLeftOut> left_out;
  /// Files that hold nothing that others do not: copies, earlier copies, files without sessions.
  std::vector<std::string> superfluous;
};

/// Collects into a new file. What is made is a function of the stations' content alone, whatever
/// their order and names. One station may be given several times: the furthest copy counts. All or
/// nothing: the file gets its name when it is whole and on the disk.
/// Time: each session is read, checked and written once; one trace is in memory at a time.
/// \throws DamagedStore, naming station and session, if anything in the stations does not hold
/// \throws StoreError, naming station and session, if the target exists or cannot be written, the
///   stations are not of one study and kind, a participant or an enrolment number is taken in two
///   of them, or two copies of one went on differently
CollectReport collect_into_file(Stations stations, const std::filesystem::path& target,
                                const CollectProgress& progress = {});

/// The same for reading, in a private temporary database that no other program sees and that is
/// gone with the store, or with the program.
/// \param name  of the whole, for messages  \param report  may be null
[[nodiscard]] store::StudyStore collected_for_reading(Stations stations, const std::string& name,
                                                      TraceUse traces,
                                                      CollectReport* report = nullptr,
                                                      const CollectProgress& progress = {});

/// The station that an SQLite file is, or the stations that were collected into it.
/// \throws DamagedStore, naming file and session, if it is damaged or was tampered with
/// \throws StoreError if it is missing, of an older schema (and how to bring it forward), or a
///   collected file that went on by itself
[[nodiscard]] Stations stations_of_file(const std::filesystem::path& database);

}  // namespace touchtrial::collect
