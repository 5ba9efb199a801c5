/// \file Sources of stations' sessions: SQLite files, stations in a collected file, bundles on a
///   server.
#pragma once

#include "core/bytes.hpp"
#include "record/event.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::merging {

/// One station's file, as that station wrote it: sessions have the station's numbers, and events
/// are as hashed (Event::renumbered_from empty, the file chain's session 0). Its content is not
/// trusted: collecting checks everything. Not thread-safe. Every function throws StoreError, naming
/// the source, if it cannot be read.
class StationFile {
 public:
  virtual ~StationFile() = default;

  /// The name for messages: "A.db", or "postgresql://host/study, station 0f3a91c2 of lab_a".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The file's own chain, from the study's commitment on.
  [[nodiscard]] virtual std::vector<record::Event> file_chain() = 0;
  /// A session's events in order; empty if there is no such session.
  /// \param own_session  its number at the station
  [[nodiscard]] virtual std::vector<record::Event> events(int own_session) = 0;
  /// The keys that were not destroyed by a withdrawal.
  [[nodiscard]] virtual record::WrappedKeys wrapped_keys(int own_session) = 0;
  /// Calls `visit` with the number and the sealed trace of each trial. Only a few traces are in
  /// memory at a time.
  virtual void for_each_trace(int own_session,
                              const std::function<void(int, const Bytes&)>& visit) = 0;
};

using Stations = std::vector<std::unique_ptr<StationFile>>;

/// The station of an SQLite file, or the stations that were collected into it.
/// \param traces  the extent of the check beforehand; collecting itself checks traces
/// \throws DamagedStore, naming file and session, if it is damaged or was tampered with
/// \throws StoreError if it is missing, has an older schema (with the remedy), or is a collected
///   file with later decisions
[[nodiscard]] Stations stations_of_file(const std::filesystem::path& database,
                                        record::TraceCheck traces = record::TraceCheck::skip);

}  // namespace touchtrial::merging
