/// \file Where the sessions of one station come from, whatever keeps them: an SQLite file, one of
/// the stations in a collected file, a server.
#pragma once

#include "core/bytes.hpp"
#include "protocols/store/event.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// One station's file, read as that station wrote it: sessions have the numbers that they have
/// there, events are as they were hashed (Event::renumbered_from empty, the file chain's session
/// 0). Nothing is believed of it: collect() checks all that it takes. Not to be shared between
/// threads.
/// Every function throws StoreError, naming the source, if it cannot be read.
class StationFile {
 public:
  virtual ~StationFile() = default;

  /// For messages: "A.db", or "postgresql://host/study, station 2".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The file's own chain, from the study's commitment on.
  [[nodiscard]] virtual std::vector<store::Event> file_chain() = 0;
  /// A session's events in order; none if there is no such session.
  /// \param own_session  its number at the station
  [[nodiscard]] virtual std::vector<store::Event> events(int own_session) = 0;
  /// Nothing after a withdrawal.
  [[nodiscard]] virtual std::optional<Bytes> wrapped_key(int own_session) = 0;
  /// The sealed trace of a trial, if there is one.
  [[nodiscard]] virtual std::optional<Bytes> trace(int own_session, int trial) = 0;
  /// Calls `visit` with every trial and sealed trace of a session, by trial; at most a few are in
  /// memory at a time.
  virtual void for_each_trace(int own_session,
                              const std::function<void(int, const Bytes&)>& visit) = 0;
};

}  // namespace touchtrial::collect
