/// \file Events, traces, keys and derived rows in a server's tables. Private to protocols/collect.
/// A session has two numbers: `session` on the server, and its own, to which hashes are bound.
#pragma once

#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/server_tables.hpp"
#include "protocols/collect/stations.hpp"
#include "protocols/store/fold.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::collect {

/// A statement that adds rows, with its parameters.
struct InsertStatement {
  std::string sql;
  std::vector<std::string> texts;  ///< first parameters: columns as arrays in text form
  std::vector<Binary> boxes{};     ///< the others: traces

  void send(ServerWork& work) const;
};

/// Collects rows of several tables into as few statements as possible, because each waits for an
/// answer. COPY would be no faster, and a station's role may not use it: PostgreSQL has none for
/// tables with row-level security. Needs no server; a statement gets some megabytes.
class Insertions {
 public:
  /// \param columns  of the table, each an array in PostgreSQL's text form
  void add(Table table, std::vector<std::string> columns);
  void add_trace(int session, int trial, const Bytes& box);
  /// What has been added since the last call, to be sent in this order.
  [[nodiscard]] std::vector<InsertStatement> take();

 private:
  void finish_statement();

  std::vector<InsertStatement> finished_;
  std::vector<std::string> parts_;           ///< statements that become one
  std::vector<std::string> texts_;           ///< parameters of the parts
  std::vector<std::pair<int, int>> traces_;  ///< session and trial
  std::vector<Binary> boxes_;
  std::size_t bytes_ = 0;
};

/// \param session  the number on the server; -1, -2, ... for a station's file chain
void insert_events(Insertions& insertions, int session, std::span<const store::Event> events);
/// A trace as it was sent.
struct SentTrace {
  Digest digest{};  ///< as its event names it
  Digest sha256{};  ///< as a server can compute it
};
/// All traces of a session.
/// \return them by trial
std::map<std::int64_t, SentTrace> insert_traces(Insertions& insertions, int session,
                                                StationFile& station, int own_session);
/// Those of the two that there are.
void insert_keys(Insertions& insertions, int session, const store::WrappedKeys& keys);
/// \param row  row.session is the number on the server
void insert_session(Insertions& insertions, const store::SessionRow& row);
/// \param rows  by own numbers
void insert_trials(Insertions& insertions, int session, const store::DerivedRows& rows);

/// Events as the station wrote them: with the session's own number, 0 for a file chain.
/// \param first  the least sequence
/// \throws EventFault, by the number on the server, if a row is no event or absurdly large
[[nodiscard]] std::vector<store::Event> read_events(ServerWork& work, int session,
                                                    std::int64_t first = 0);
[[nodiscard]] store::WrappedKeys read_keys(ServerWork& work, int session);
[[nodiscard]] std::optional<Bytes> read_trace(ServerWork& work, int session, int trial);

/// Trials from the first to the last.
struct TrialRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};
/// Cuts a session's traces into batches of a few megabytes.
/// \throws EventFault if a trace is absurdly large
[[nodiscard]] std::vector<TrialRange> trace_batches(ServerWork& work, int session);
/// Trial and trace, by trial.
[[nodiscard]] std::vector<std::pair<int, Bytes>> read_traces(ServerWork& work, int session,
                                                             const TrialRange& trials);
/// SHA-256 of every trace of a session, by trial, as the server has it.
[[nodiscard]] std::map<std::int64_t, Bytes> trace_digests(ServerWork& work, int session);

}  // namespace touchtrial::collect
