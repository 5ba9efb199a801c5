/// \file Several stations' files made one, the collected study. Source: docs/several-stations.md,
/// docs/decisions/0041.
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

/// A session that is not in the collected study, because it has not ended.
struct SessionLeftOut {
  std::string station;  ///< StationFile::name
  int session = 0;      ///< its number there
  std::string participant;
  /// Replaced or withdrawn before it ended: it cannot go on, and will be in no collected study.
  bool cut_short = false;

  /// "A.db: session 3 (participant P3) has not ended ..."
  [[nodiscard]] std::string words() const;
};

/// \param course  of a session that has not ended
[[nodiscard]] SessionLeftOut left_out_of(const StationFile& station, int session,
                                         const record::SessionOnFile& course);

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

}  // namespace touchtrial::merging
