#include "protocols/collect/server_rows.hpp"

#include "protocols/collect/server_schema.hpp"
#include "protocols/collect/server_tables.hpp"
#include "protocols/store/damage.hpp"

#include <charconv>
#include <concepts>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace touchtrial::collect {
namespace {

/// Roughly how much is sent to the server or fetched from it at a time, in bytes.
constexpr std::size_t kBatch = 8U << 20U;
/// No event or trace of ours is nearly as large. As text, bytes travel in twice their number, and
/// stay below the limit of an answer (answer_watch.hpp).
constexpr std::int64_t kLargestEvent = 16 << 20;
constexpr std::int64_t kLargestTrace = 24 << 20;

/// A column of many rows as one parameter of a statement, in PostgreSQL's text form of arrays:
/// "{1,NULL,\"text\"}", to be cast to the column's type in SQL.
class ServerArray {
 public:
  template <std::integral Number>
  void add(Number value) {
    add_bare(std::to_string(value));
  }
  /// With enough digits to be read back as the same number.
  void add(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    add_bare({text, static_cast<std::size_t>(end - text)});
  }
  void add(std::string_view text) {
    separate();
    values_ += '"';
    for (const char character : text) {
      if (character == '"' || character == '\\') values_ += '\\';
      values_ += character;
    }
    values_ += '"';
  }
  void add(ByteView bytes) { add(std::string_view("\\x" + to_hex(bytes))); }
  void add(std::monostate) { add_bare("NULL"); }
  template <typename... Values>
  void add(const std::variant<std::monostate, Values...>& value) {
    std::visit([this](const auto& held) { this->add(held); }, value);
  }

  /// Its length so far, in bytes.
  [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
  [[nodiscard]] std::string text() const { return "{" + values_ + "}"; }

 private:
  void separate() {
    if (!values_.empty()) values_ += ',';
  }
  void add_bare(std::string_view text) {
    separate();
    values_ += text;
  }

  std::string values_;
};

/// The type that arrays of a column's values are cast to.
std::string array_of(ColumnType type) {
  return std::string(kServerTypes.at(static_cast<std::size_t>(type))) + "[]";
}

/// "INSERT INTO trials(...) SELECT * FROM unnest(...)": one parameter for each column, with all
/// rows.
/// \param first  number of the first parameter
std::string insertion_sql(Table table, std::size_t first) {
  const TableDefinition& definition = table_definition(table);
  std::string parameters;
  for (const TableColumn& column : definition.columns) {
    parameters +=
        (parameters.empty() ? "$" : ", $") + std::to_string(first++) + "::" + array_of(column.type);
  }
  return "INSERT INTO " + std::string(definition.name) + "(" + column_list(table) +
         ") SELECT * FROM unnest(" + parameters + ")";
}

/// Rows of a table, which are added to insertions a batch at a time.
class RowBatch {
 public:
  RowBatch(Insertions& insertions, Table table)
      : insertions_(insertions), table_(table), columns_(table_definition(table).columns.size()) {}

  /// The values of a row, in the order of the table's columns.
  template <typename... Values>
  void add(const Values&... values) {
    std::size_t column = 0;
    (columns_[column++].add(values), ...);
    finish_if_full();
  }
  void add(const Cells& cells) {
    for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].add(cells.at(i));
    finish_if_full();
  }

  void finish() {
    if (columns_.front().size() == 0) return;
    std::vector<std::string> texts;
    for (ServerArray& column : columns_) texts.push_back(std::exchange(column, {}).text());
    insertions_.add(table_, std::move(texts));
  }

 private:
  void finish_if_full() {
    std::size_t size = 0;
    for (const ServerArray& column : columns_) size += column.size();
    if (size > kBatch) finish();
  }

  Insertions& insertions_;
  Table table_;
  std::vector<ServerArray> columns_;
};

/// \param row  sequence, kind, at_ns, body, sealed, previous, hash, signature, own_session
store::Event event_of(const pqxx::row& row, int session) {
  const auto sequence = row[0].as<std::int64_t>();
  const store::EventKind kind = store::stored_kind(row[1].as<std::string>(), session, sequence);
  const auto own = row[8].is_null() ? session : row[8].as<std::int64_t>();
  if (own < 0 || own > std::numeric_limits<int>::max() || (own == 0) != (session < 0)) {
    throw store::EventFault(session, sequence, "no session of a station has this number");
  }
  return {.session = static_cast<int>(own),
          .sequence = sequence,
          .kind = kind,
          .at = std::chrono::nanoseconds(row[2].as<std::int64_t>()),
          .body = row[3].as<std::string>(),
          .sealed = bytes_of(row[4]),
          .previous = store::stored_hash(bytes_of(row[5]), session, sequence),
          .hash = store::stored_hash(bytes_of(row[6]), session, sequence),
          .signature = bytes_of(row[7])};
}

}  // namespace

void InsertStatement::send(ServerWork& work) const {
  work.exec0_with_lists(sql, texts, boxes);
}

void Insertions::add(Table table, std::vector<std::string> columns) {
  parts_.push_back(insertion_sql(table, texts_.size() + 1));
  for (std::string& column : columns) {
    bytes_ += column.size();
    texts_.push_back(std::move(column));
  }
  if (bytes_ > kBatch) finish_statement();
}

void Insertions::add_trace(int session, int trial, const Bytes& box) {
  constexpr std::size_t kMostTraces = 1000;
  if (bytes_ + box.size() > kBatch || boxes_.size() == kMostTraces) finish_statement();
  boxes_.push_back(binary(box));
  traces_.emplace_back(session, trial);
  bytes_ += box.size();
}

std::vector<InsertStatement> Insertions::take() {
  finish_statement();
  return std::exchange(finished_, {});
}

void Insertions::finish_statement() {
  // Each trace is a binary parameter of its own: as text they would be twice as long, and the
  // server would copy one that holds them all once for each.
  std::string rows;
  std::size_t parameter = texts_.size();
  for (const auto& [session, trial] : traces_) {
    rows += (rows.empty() ? "(" : ", (") + std::to_string(session) + ", " + std::to_string(trial) +
            ", $" + std::to_string(++parameter) + "::bytea)";
  }
  if (!rows.empty()) parts_.push_back("INSERT INTO traces(session, trial, box) VALUES " + rows);
  if (parts_.empty()) return;
  std::string sql;
  int number = 0;
  for (const std::string& part : parts_) {
    sql += (number == 0 ? "WITH part_" : ", part_") + std::to_string(number) + " AS (" + part + ")";
    ++number;
  }
  // The parts are carried out whether or not anything reads them.
  finished_.push_back({.sql = sql + " SELECT WHERE FALSE",
                       .texts = std::exchange(texts_, {}),
                       .boxes = std::exchange(boxes_, {})});
  parts_.clear();
  traces_.clear();
  bytes_ = 0;
}

void insert_events(Insertions& insertions, int session, std::span<const store::Event> events) {
  RowBatch batch(insertions, Table::events);
  for (const store::Event& event : events) {
    batch.add(session, event.sequence, store::name_of(event.kind), event.at.count(), event.body,
              event.sealed, event.previous, event.hash, event.signature, event.own_session());
  }
  batch.finish();
}

std::map<std::int64_t, SentTrace> insert_traces(Insertions& insertions, int session,
                                                StationFile& station, int own_session) {
  std::map<std::int64_t, SentTrace> sent;
  station.for_each_trace(own_session, [&](int trial, const Bytes& box) {
    sent[trial] = {.digest = blake2b(box), .sha256 = sha256(box)};
    insertions.add_trace(session, trial, box);
  });
  return sent;
}

void insert_keys(Insertions& insertions, int session, const store::WrappedKeys& keys) {
  const auto add = [&](Table table, const std::optional<Bytes>& wrapped) {
    if (!wrapped) return;
    RowBatch batch(insertions, table);
    batch.add(session, *wrapped);
    batch.finish();
  };
  add(Table::participant_keys, keys.participant);
  add(Table::safety_keys, keys.safety);
}

void insert_session(Insertions& insertions, const store::SessionRow& row) {
  RowBatch batch(insertions, Table::sessions);
  batch.add(session_cells(row, OwnNumber::always));
  batch.finish();
}

void insert_trials(Insertions& insertions, int session, const store::DerivedRows& rows) {
  RowBatch trials(insertions, Table::trials);
  for (const auto& [id, own] : rows.trials) {
    store::TrialRow row = own;
    row.session = session;
    trials.add(trial_cells(row));
  }
  trials.finish();
}

std::vector<store::Event> read_events(ServerWork& work, int session, std::int64_t first) {
  // What is absurdly large is told, not sent.
  const pqxx::result rows = work.exec(
      "WITH measured AS (SELECT *, octet_length(kind) + octet_length(body) + octet_length(sealed) "
      "+ "
      "octet_length(previous) + octet_length(hash) + octet_length(signature) > $3 AS is_large FROM "
      "events WHERE session = $1 AND sequence >= $2) SELECT sequence, kind, at_ns, body, sealed, "
      "previous, hash, signature, own_session, FALSE FROM measured WHERE NOT is_large UNION ALL "
      "SELECT sequence, '', 0, '', '', '', '', '', 0, TRUE FROM measured WHERE is_large "
      "ORDER BY sequence",
      session, first, kLargestEvent);
  std::vector<store::Event> events;
  events.reserve(rows.size());
  for (const pqxx::row& row : rows) {
    if (row[9].as<bool>()) {
      throw store::EventFault(session, row[0].as<std::int64_t>(), "the event is absurdly large");
    }
  }
  for (const pqxx::row& row : rows) events.push_back(event_of(row, session));
  return events;
}

store::WrappedKeys read_keys(ServerWork& work, int session) {
  const pqxx::result rows = work.exec(
      "SELECT (SELECT wrapped FROM participant_keys WHERE session = $1 AND octet_length(wrapped) < "
      "4096), (SELECT wrapped FROM safety_keys WHERE session = $1 AND octet_length(wrapped) < "
      "4096)",
      session);
  const auto read = [&](int column) -> std::optional<Bytes> {
    if (rows[0][column].is_null()) return std::nullopt;
    return bytes_of(rows[0][column]);
  };
  return {.participant = read(0), .safety = read(1)};
}

std::optional<Bytes> read_trace(ServerWork& work, int session, int trial) {
  const pqxx::result rows = work.exec(
      "SELECT box FROM traces WHERE session = $1 AND trial = $2 AND octet_length(box) <= $3",
      session, trial, kLargestTrace);
  if (rows.empty()) return std::nullopt;
  return bytes_of(rows[0][0]);
}

std::vector<TrialRange> trace_batches(ServerWork& work, int session) {
  std::vector<TrialRange> batches;
  std::int64_t bytes = 0;
  for (const pqxx::row& row : work.exec(
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

std::vector<std::pair<int, Bytes>> read_traces(ServerWork& work, int session,
                                               const TrialRange& trials) {
  std::vector<std::pair<int, Bytes>> traces;
  for (const pqxx::row& row :
       work.exec("SELECT trial, box FROM traces WHERE session = $1 AND trial BETWEEN $2 AND $3 "
                 "ORDER BY trial",
                 session, trials.first, trials.last)) {
    traces.emplace_back(row[0].as<int>(), bytes_of(row[1]));
  }
  return traces;
}

std::map<std::int64_t, Bytes> trace_digests(ServerWork& work, int session) {
  std::map<std::int64_t, Bytes> digests;
  for (const pqxx::row& row :
       work.exec("SELECT trial, sha256(box) FROM traces WHERE session = $1", session)) {
    digests[row[0].as<std::int64_t>()] = bytes_of(row[1]);
  }
  return digests;
}

}  // namespace touchtrial::collect
