/// \file Several stations' files made one, the collected study; and a study opened for reading, in
/// a file or on a server. Source: docs/several-stations.md, docs/decisions/0041.
#pragma once

#include "protocols/collect/stations.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// Whether traces are copied, or fetched from the station when they are asked for (the sources then
/// live as long as the collected study).
enum class TraceUse { copied, fetched };

/// Called with the number of sessions collected so far and the number of all.
using CollectProgress = std::function<void(int, int)>;

/// A session that is not in the collected study, because it has not ended.
struct SessionLeftOut {
  std::string station;  ///< StationFile::name
  int session = 0;      ///< its number there
  std::string participant;
  /// Replaced or withdrawn before it ended: it cannot go on, and will be in no collected study.
  bool cut_short = false;
};

struct CollectReport {
  int stations = 0;
  int sessions = 0;
  std::vector<SessionLeftOut> left_out;
  /// Files that hold nothing that others do not: copies, earlier copies, files without sessions.
  std::vector<std::string> superfluous;
};

/// Collects into a new file. Its content depends on the stations' content alone, and not on their
/// order and names. A station may be given several times: the copy that went furthest counts. All
/// or nothing: the file gets its name when it is whole and on the disk. Time: each session is read,
/// checked and written once; one trace is in memory at a time.
/// \throws DamagedStore, naming station and session, if anything in the stations does not hold
/// \throws StoreError, naming station and session, if the target exists or cannot be written, the
///   stations are not of one study and kind, two of them used one participant id or enrolment
///   number, or two copies of one station went on differently
CollectReport collect_into_file(Stations stations, const std::filesystem::path& target,
                                const CollectProgress& progress = {});

/// Collects for reading, into a private temporary database that no other program sees and that is
/// gone with the store, or with the program.
/// \param name  of the whole, for messages
/// \param report  may be null
/// \throws the same
[[nodiscard]] store::StudyStore collected_for_reading(Stations stations, const std::string& name,
                                                      TraceUse traces,
                                                      CollectReport* report = nullptr,
                                                      const CollectProgress& progress = {});

/// Opens a database file as StudyStore::open does for reading, or collects all stations of a server
/// into a private temporary database.
/// \param where  a path, or a postgresql:// address
/// \param traces  for a server: `copied` if the reader wants all traces
/// \throws what StudyStore::open throws; also what ServerAddress, stations_of_server and
///   collected_for_reading throw
[[nodiscard]] store::StudyStore open_study(const std::string& where,
                                           TraceUse traces = TraceUse::fetched);

/// The name of a study in reports: of its file, or the address of its server without the user.
/// \throws what ServerAddress throws
[[nodiscard]] std::string study_name(const std::string& where);

}  // namespace touchtrial::collect
