/// \file Where the sessions of stations come from: SQLite files, stations in a collected file,
/// bundles on a server.
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

/// One station's file, read as that station wrote it: sessions have their numbers there, and events
/// are as they were hashed (Event::renumbered_from empty, the file chain's session 0). Its content
/// is not trusted: whoever collects checks everything. Not to be shared between threads. Every
/// function throws StoreError, naming the source, if it cannot be read.
class StationFile {
 public:
  virtual ~StationFile() = default;

  /// For messages: "A.db", or "postgresql://host/study, station 0f3a91c2 of lab_a".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The file's own chain, from the study's commitment on.
  [[nodiscard]] virtual std::vector<record::Event> file_chain() = 0;
  /// A session's events in order; none if there is no such session.
  /// \param own_session  its number at the station
  [[nodiscard]] virtual std::vector<record::Event> events(int own_session) = 0;
  /// Those that no withdrawal destroyed.
  [[nodiscard]] virtual record::WrappedKeys wrapped_keys(int own_session) = 0;
  /// Calls `visit` with every trial and sealed trace of a session, by trial. Only a few traces are
  /// in memory at a time.
  virtual void for_each_trace(int own_session,
                              const std::function<void(int, const Bytes&)>& visit) = 0;
};

using Stations = std::vector<std::unique_ptr<StationFile>>;

/// The station that an SQLite file is, or the stations that were collected into it.
/// \param traces  whether all of the file is checked first, or what collecting does not check
/// \throws DamagedStore, naming file and session, if it is damaged or was tampered with
/// \throws StoreError if it is missing, of an older schema (with the remedy), or a collected file
///   in which something was decided since
[[nodiscard]] Stations stations_of_file(const std::filesystem::path& database,
                                        record::TraceCheck traces = record::TraceCheck::skip);

}  // namespace touchtrial::merging
