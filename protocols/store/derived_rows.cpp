#include "protocols/store/derived_rows.hpp"

#include "protocols/store/event_fault.hpp"
#include "protocols/store/state_names.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

/// A row whose values are taken only if an event can have given rise to them.
class DerivedRow {
 public:
  DerivedRow(const Query& row, const char* table) : row_(row), table_(table) {}

  [[nodiscard]] int whole(int column) const {
    const std::int64_t number = row_.integer(column);
    if (number < 0 || number > std::numeric_limits<int>::max()) refuse();
    return static_cast<int>(number);
  }
  [[nodiscard]] std::optional<int> optional_whole(int column) const {
    if (row_.is_null(column)) return std::nullopt;
    return whole(column);
  }
  [[nodiscard]] std::optional<std::chrono::nanoseconds> optional_time(int column) const {
    if (row_.is_null(column)) return std::nullopt;
    return std::chrono::nanoseconds(row_.integer(column));
  }
  [[nodiscard]] bool flag(int column) const {
    const std::int64_t number = row_.integer(column);
    if (number != 0 && number != 1) refuse();
    return number == 1;
  }
  template <typename State, std::size_t N>
  [[nodiscard]] State state(int column, const std::array<std::string_view, N>& names) const {
    const auto* const found = std::find(names.begin(), names.end(), row_.text(column));
    if (found == names.end()) refuse();
    return static_cast<State>(found - names.begin());
  }

 private:
  [[noreturn]] void refuse() const {
    throw EventFault(
        row_.integer(0), kNoEvent,
        std::string("derived table ") + table_ + " holds a value that no event gives rise to");
  }

  const Query& row_;
  const char* table_;
};

SessionRow session_of_row(const Query& query) {
  const DerivedRow row(query, "sessions");
  return {.session = row.whole(0),
          .participant = query.text(1),
          .enrolment = row.whole(2),
          .state = row.state<SessionState>(3, kSessionStates),
          .simulated = row.flag(4),
          .pilot = row.flag(5),
          .excluded = row.flag(6),
          .withdrawn = row.flag(7),
          .device = query.text(8),
          .replaced_by = query.text(9),
          .own_session = row.whole(10),
          .station = row.whole(11)};
}

TrialRow trial_of_row(const Query& query) {
  const DerivedRow trial(query, "trials");
  const DerivedRow response(query, "responses");
  return {.session = trial.whole(0),
          .trial = trial.whole(1),
          .block = trial.whole(2),
          .state = trial.state<TrialState>(3, kTrialStates),
          .presented_at = std::chrono::nanoseconds(query.integer(4)),
          .contact_at = trial.optional_time(5),
          .answered_at = response.optional_time(10),
          .position = response.optional_whole(11),
          .first_position = response.optional_whole(12),
          .confidence = response.optional_whole(13),
          .valid = trial.flag(6),
          .overruns = query.integer(7),
          .samples = query.integer(8),
          .rate_hz = query.real(9),
          .explorations = trial.whole(14)};
}

void visit_sessions(const Database& database, std::int64_t first, std::int64_t last,
                    const std::function<void(const SessionRow&)>& visit) {
  Query query = database.query(
      "SELECT session, participant, enrolment, state, simulated, pilot, excluded, withdrawn, "
      "device, coalesce(replaced_by, ''), coalesce(own_session, session), station FROM sessions "
      "WHERE session BETWEEN ? AND ? ORDER BY session");
  query.bind(first).bind(last);
  while (query.step()) visit(session_of_row(query));
}

/// From the first trial id to the last, in both members.
void visit_trials(const Database& database, std::pair<std::int64_t, std::int64_t> first,
                  std::pair<std::int64_t, std::int64_t> last,
                  const std::function<void(const TrialRow&)>& visit) {
  Query query = database.query(
      "SELECT t.session, t.trial, t.block, t.state, t.presented_at_ns, t.contact_at_ns, t.valid, "
      "t.overruns, t.samples, t.rate_hz, r.answered_at_ns, r.position, r.first_position, "
      "r.confidence, t.explorations FROM trials t LEFT JOIN responses r USING(session, trial) "
      "WHERE t.session BETWEEN ? AND ? AND t.trial BETWEEN ? AND ? ORDER BY t.session, t.trial");
  query.bind(first.first).bind(last.first).bind(first.second).bind(last.second);
  while (query.step()) visit(trial_of_row(query));
}

template <typename State, std::size_t N>
std::string_view name_in(const std::array<std::string_view, N>& names, State state) {
  return names.at(static_cast<std::size_t>(state));
}

std::optional<std::int64_t> count_of(const std::optional<std::chrono::nanoseconds>& time) {
  if (!time) return std::nullopt;
  return time->count();
}

void write_session(const Database& database, const SessionRow& row) {
  database
      .query(
          "INSERT INTO sessions(session, participant, enrolment, state, simulated, pilot, "
          "excluded, withdrawn, device, replaced_by, own_session, station) "
          "VALUES(?,?,?,?,?,?,?,?,?,?,?,?) "
          "ON CONFLICT(session) DO UPDATE SET state = excluded.state, "
          "excluded = excluded.excluded, withdrawn = excluded.withdrawn, "
          "replaced_by = excluded.replaced_by, station = excluded.station")
      .bind(row.session)
      .bind(row.participant)
      .bind(row.enrolment)
      .bind(name_in(kSessionStates, row.state))
      .bind(row.simulated)
      .bind(row.pilot)
      .bind(row.excluded)
      .bind(row.withdrawn)
      .bind(row.device)
      .bind(row.replaced_by.empty() ? std::nullopt : std::optional(row.replaced_by))
      .bind(row.own_session == row.session ? std::nullopt : std::optional(row.own_session))
      .bind(row.station)
      .run();
}

void write_response(const Database& database, const TrialRow& row) {
  database
      .query(
          "INSERT INTO responses(session, trial, answered_at_ns, position, first_position, "
          "confidence) VALUES(?,?,?,?,?,?) ON CONFLICT DO NOTHING")
      .bind(row.session)
      .bind(row.trial)
      .bind(count_of(row.answered_at))
      .bind(row.position)
      .bind(row.first_position)
      .bind(row.confidence)
      .run();
}

void write_trial(const Database& database, const TrialRow& row) {
  database
      .query(
          "INSERT INTO trials(session, trial, block, state, presented_at_ns, contact_at_ns, valid, "
          "overruns, samples, rate_hz, explorations) VALUES(?,?,?,?,?,?,?,?,?,?,?) "
          "ON CONFLICT(session, trial) DO UPDATE SET block = excluded.block, "
          "state = excluded.state, presented_at_ns = excluded.presented_at_ns, "
          "contact_at_ns = excluded.contact_at_ns, valid = excluded.valid, "
          "overruns = excluded.overruns, samples = excluded.samples, rate_hz = excluded.rate_hz, "
          "explorations = excluded.explorations")
      .bind(row.session)
      .bind(row.trial)
      .bind(row.block)
      .bind(name_in(kTrialStates, row.state))
      .bind(row.presented_at.count())
      .bind(count_of(row.contact_at))
      .bind(row.valid)
      .bind(row.overruns)
      .bind(row.samples)
      .bind(row.rate_hz)
      .bind(row.explorations)
      .run();
  // An answer is final, so that a response is only ever added.
  if (row.position) write_response(database, row);
}

}  // namespace

std::vector<SessionRow> read_sessions(const Database& database) {
  std::vector<SessionRow> rows;
  visit_sessions(database, kLowest, kHighest, [&](const SessionRow& row) { rows.push_back(row); });
  return rows;
}

std::vector<TrialRow> read_trials(const Database& database) {
  std::vector<TrialRow> rows;
  visit_trials(database, {kLowest, kLowest}, {kHighest, kHighest},
               [&](const TrialRow& row) { rows.push_back(row); });
  return rows;
}

DerivedRows read_rows(const Database& database, const FoldScope& scope) {
  DerivedRows rows;
  if (scope.session) {
    visit_sessions(database, *scope.session, *scope.session,
                   [&](const SessionRow& row) { rows.sessions[row.session] = row; });
  }
  if (scope.block) {
    const int session = scope.block->first;
    visit_trials(database, {session, kLowest}, {session, kHighest}, [&](const TrialRow& row) {
      if (row.block == scope.block->second) rows.trials[{row.session, row.trial}] = row;
    });
  }
  if (scope.trial) {
    visit_trials(database, *scope.trial, *scope.trial, [&](const TrialRow& row) {
      rows.trials[{row.session, row.trial}] = row;
    });
  }
  return rows;
}

void write_rows(const Database& database, const DerivedRows& rows) {
  for (const auto& [session, row] : rows.sessions) write_session(database, row);
  for (const auto& [id, row] : rows.trials) write_trial(database, row);
}

void delete_all_rows(const Database& database) {
  database.connection().exec("DELETE FROM responses; DELETE FROM trials; DELETE FROM sessions;");
}

}  // namespace touchtrial::store
