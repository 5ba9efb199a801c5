#include "protocols/collect/server_rows.hpp"

#include "protocols/collect/server_array.hpp"
#include "protocols/collect/server_schema.hpp"
#include "protocols/store/event_fault.hpp"
#include "protocols/store/row_cells.hpp"
#include "protocols/store/tables.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

namespace touchtrial::collect {
namespace {

/// As much as goes to or comes from the server at a time, roughly, in bytes.
constexpr std::size_t kBatch = 8U << 20U;
/// No event and no trace of a session is nearly as large; what is was not written by us.
constexpr std::int64_t kLargestEvent = 64 << 20;
constexpr std::int64_t kLargestTrace = 512 << 20;

/// What arrays of a column's values are cast to.
std::string array_of(store::ColumnType type) {
  return std::string(kServerTypes.at(static_cast<std::size_t>(type))) + "[]";
}

/// "INSERT INTO trials(...) SELECT * FROM unnest(...)": a parameter a column, which holds all rows.
std::string insertion_sql(const store::TableDefinition& table) {
  std::string parameters;
  int number = 0;
  for (const store::TableColumn& column : table.columns) {
    parameters +=
        (number == 0 ? "$" : ", $") + std::to_string(number + 1) + "::" + array_of(column.type);
    ++number;
  }
  return "INSERT INTO " + std::string(table.name) + "(" + store::column_list(table) +
         ") SELECT * FROM unnest(" + parameters + ")";
}

/// Columns of rows of events, on their way.
class EventBatch {
 public:
  EventBatch(pqxx::work& work, int session) : work_(work), session_(session) {}

  void add(const store::Event& event) {
    sessions_.add(session_);
    sequences_.add(event.sequence);
    kinds_.add(store::name_of(event.kind));
    times_.add(event.at.count());
    bodies_.add(std::string_view(event.body));
    sealed_.add(ByteView(event.sealed));
    previous_.add(ByteView(event.previous));
    hashes_.add(ByteView(event.hash));
    own_.add(event.own_session());
    if (bodies_.size() + sealed_.size() > kBatch) send();
  }

  void send() {
    if (sequences_.size() == 0) return;
    work_.exec_params0(insertion_sql(store::table_definition(store::Table::events)),
                       sessions_.text(), sequences_.text(), kinds_.text(), times_.text(),
                       bodies_.text(), sealed_.text(), previous_.text(), hashes_.text(),
                       own_.text());
    sessions_ = sequences_ = kinds_ = times_ = bodies_ = sealed_ = previous_ = hashes_ = own_ = {};
  }

 private:
  pqxx::work& work_;
  int session_;
  ServerArray sessions_, sequences_, kinds_, times_, bodies_, sealed_, previous_, hashes_, own_;
};

/// Traces on their way, one after the other in one parameter that is sent as it is: as text they
/// would be twice as long.
class TraceBatch {
 public:
  TraceBatch(pqxx::work& work, int session) : work_(work), session_(session) {}

  void add(int trial, const Bytes& box) {
    if (!boxes_.empty() && boxes_.size() + box.size() > kBatch) send();
    trials_.add(trial);
    starts_.add(boxes_.size() + 1);
    lengths_.add(box.size());
    boxes_.insert(boxes_.end(), box.begin(), box.end());
  }

  void send() {
    if (trials_.size() == 0) return;
    work_.exec_params0(
        "INSERT INTO traces(session, trial, box) SELECT $1::bigint, t.trial, "
        "substring($2::bytea FROM t.start FOR t.length) "
        "FROM unnest($3::bigint[], $4::integer[], $5::integer[]) AS t(trial, start, length)",
        session_, binary(boxes_), trials_.text(), starts_.text(), lengths_.text());
    boxes_.clear();
    trials_ = starts_ = lengths_ = {};
  }

 private:
  pqxx::work& work_;
  int session_;
  Bytes boxes_;
  ServerArray trials_, starts_, lengths_;
};

void insert_rows(pqxx::work& work, store::Table table, std::span<const store::Cells> rows) {
  const store::TableDefinition& definition = store::table_definition(table);
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < definition.columns.size(); ++i) {
    ServerArray column;
    for (const store::Cells& row : rows) column.add(row.at(i));
    columns.push_back(column.text());
  }
  work.exec_params0(insertion_sql(definition), pqxx::prepare::make_dynamic_params(columns));
}

Digest digest_of(const pqxx::field& field, int session, std::int64_t sequence) {
  const Bytes bytes = bytes_of(field);
  Digest digest{};
  if (bytes.size() != digest.size()) {
    throw store::EventFault(session, sequence, "a hash of the event is not 32 bytes long");
  }
  std::copy(bytes.begin(), bytes.end(), digest.begin());
  return digest;
}

/// \param row  sequence, kind, at_ns, body, sealed, previous, hash, own_session
store::Event event_of(const pqxx::row& row, int session) {
  const auto sequence = row[0].as<std::int64_t>();
  const auto name = row[1].as<std::string>();
  const std::optional<store::EventKind> kind = store::event_kind_from_name(name);
  if (!kind) throw store::EventFault(session, sequence, "unknown kind of event '" + name + "'");
  const auto own = row[7].is_null() ? session : row[7].as<std::int64_t>();
  if (own < 0 || own > std::numeric_limits<int>::max() || (own == 0) != (session < 0)) {
    throw store::EventFault(session, sequence, "no session of a station has this number");
  }
  return {.session = static_cast<int>(own),
          .sequence = sequence,
          .kind = *kind,
          .at = std::chrono::nanoseconds(row[2].as<std::int64_t>()),
          .body = row[3].as<std::string>(),
          .sealed = bytes_of(row[4]),
          .previous = digest_of(row[5], session, sequence),
          .hash = digest_of(row[6], session, sequence)};
}

void refuse_large_events(pqxx::work& work, int session) {
  const pqxx::result found = work.exec_params(
      "SELECT sequence FROM events WHERE session = $1 AND octet_length(kind) + "
      "octet_length(body) + octet_length(sealed) + octet_length(previous) + octet_length(hash) > "
      "$2 "
      "ORDER BY sequence LIMIT 1",
      session, kLargestEvent);
  if (found.empty()) return;
  throw store::EventFault(session, found[0][0].as<std::int64_t>(), "the event is absurdly large");
}

}  // namespace

void insert_events(pqxx::work& work, int session, std::span<const store::Event> events) {
  EventBatch batch(work, session);
  for (const store::Event& event : events) batch.add(event);
  batch.send();
}

void insert_traces(pqxx::work& work, int session, StationFile& station, int own_session) {
  TraceBatch batch(work, session);
  station.for_each_trace(own_session, [&](int trial, const Bytes& box) { batch.add(trial, box); });
  batch.send();
}

void insert_key(pqxx::work& work, int session, const Bytes& wrapped) {
  work.exec_params0("INSERT INTO participant_keys(session, wrapped) VALUES($1, $2)", session,
                    binary(wrapped));
}

void insert_session(pqxx::work& work, const store::SessionRow& row) {
  insert_rows(work, store::Table::sessions,
              std::array{store::session_cells(row, store::OwnNumber::always)});
}

void insert_trials(pqxx::work& work, int session, const store::DerivedRows& rows) {
  std::vector<store::Cells> trials;
  std::vector<store::Cells> responses;
  for (const auto& [id, own] : rows.trials) {
    store::TrialRow row = own;
    row.session = session;
    trials.push_back(store::trial_cells(row));
    if (row.position) responses.push_back(store::response_cells(row));
  }
  insert_rows(work, store::Table::trials, trials);
  insert_rows(work, store::Table::responses, responses);
}

std::vector<store::Event> read_events(pqxx::work& work, int session, std::int64_t first) {
  refuse_large_events(work, session);
  const pqxx::result rows = work.exec_params(
      "SELECT sequence, kind, at_ns, body, sealed, previous, hash, own_session FROM events "
      "WHERE session = $1 AND sequence >= $2 ORDER BY sequence",
      session, first);
  std::vector<store::Event> events;
  events.reserve(rows.size());
  for (const pqxx::row& row : rows) events.push_back(event_of(row, session));
  return events;
}

std::optional<Bytes> read_key(pqxx::work& work, int session) {
  const pqxx::result rows = work.exec_params(
      "SELECT wrapped FROM participant_keys WHERE session = $1 AND octet_length(wrapped) < 4096",
      session);
  if (rows.empty()) return std::nullopt;
  return bytes_of(rows[0][0]);
}

std::optional<Bytes> read_trace(pqxx::work& work, int session, int trial) {
  const pqxx::result rows = work.exec_params(
      "SELECT box FROM traces WHERE session = $1 AND trial = $2 AND octet_length(box) <= $3",
      session, trial, kLargestTrace);
  if (rows.empty()) return std::nullopt;
  return bytes_of(rows[0][0]);
}

std::vector<TrialRange> trace_batches(pqxx::work& work, int session) {
  std::vector<TrialRange> batches;
  std::int64_t bytes = 0;
  for (const pqxx::row& row : work.exec_params(
           "SELECT trial, octet_length(box)::bigint FROM traces WHERE session = $1 ORDER BY trial",
           session)) {
    const auto trial = row[0].as<std::int64_t>();
    const auto size = row[1].as<std::int64_t>();
    if (size > kLargestTrace)
      throw store::EventFault(session, store::kNoEvent, "a trace is absurdly large");
    if (batches.empty() || bytes + size > static_cast<std::int64_t>(kBatch)) {
      batches.push_back({trial, trial});
      bytes = 0;
    }
    batches.back().last = trial;
    bytes += size;
  }
  return batches;
}

std::vector<std::pair<int, Bytes>> read_traces(pqxx::work& work, int session,
                                               const TrialRange& trials) {
  std::vector<std::pair<int, Bytes>> traces;
  for (const pqxx::row& row : work.exec_params(
           "SELECT trial, box FROM traces WHERE session = $1 AND trial BETWEEN $2 AND $3 "
           "ORDER BY trial",
           session, trials.first, trials.last)) {
    traces.emplace_back(row[0].as<int>(), bytes_of(row[1]));
  }
  return traces;
}

std::map<std::int64_t, Bytes> trace_digests(pqxx::work& work, int session) {
  std::map<std::int64_t, Bytes> digests;
  for (const pqxx::row& row :
       work.exec_params("SELECT trial, sha256(box) FROM traces WHERE session = $1", session)) {
    digests[row[0].as<std::int64_t>()] = bytes_of(row[1]);
  }
  return digests;
}

}  // namespace touchtrial::collect
