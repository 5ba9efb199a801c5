/// \file Collects several stations' files into one, the collected study. Source:
/// docs/several-stations.md, docs/decisions/0041.
#pragma once

#include "record/file_chain.hpp"
#include "record/merging/stations.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::merging {

/// Called with the number of sessions collected so far and the number of all.
using CollectProgress = std::function<void(int, int)>;

/// A session that is left out of the collected study because it has not ended.
struct SessionLeftOut {
  std::string station;  ///< StationFile::name
  int session = 0;      ///< its number at the station
  std::string participant;
  /// Whether it was replaced or withdrawn before it ended. It can then never be collected.
  bool cut_short = false;

  /// "A.db: session 3 (participant P3) has not ended ..."
  [[nodiscard]] std::string words() const;
};

/// \param on_file  of a session that has not ended
[[nodiscard]] SessionLeftOut left_out_of(const StationFile& station, int session,
                                         const record::SessionOnFile& on_file);

struct CollectReport {
  int stations = 0;
  int sessions = 0;
  std::vector<SessionLeftOut> left_out;
  /// Redundant files: copies, earlier copies, files without sessions.
  std::vector<std::string> redundant;
};

/// Collects into a new file. Its content depends only on the stations' content, not on their order
/// and names. A station may be given several times: the longest copy counts. The file gets its name
/// when it is complete and synced. Each session is read, checked and written once; one trace is in
/// memory at a time.
/// \throws DamagedStore, naming station and session, at any fault in the stations
/// \throws StoreError, naming station and session, if the target exists or cannot be written, the
///   stations do not belong to one study and kind, two of them used one participant id or enrolment
///   number, or two copies of one station diverged
CollectReport collect_into_file(Stations stations, const std::filesystem::path& target,
                                const CollectProgress& progress = {});

}  // namespace touchtrial::merging
