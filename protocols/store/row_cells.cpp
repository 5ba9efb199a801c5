#include "protocols/store/row_cells.hpp"

#include "protocols/store/event_fault.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

namespace touchtrial::store {
namespace {

template <typename State, std::size_t N>
Cell state_cell(const std::array<std::string_view, N>& names, State state) {
  return std::string(names.at(static_cast<std::size_t>(state)));
}

Cell cell_of(const std::optional<std::chrono::nanoseconds>& time) {
  return time ? Cell(std::int64_t{time->count()}) : Cell();
}

Cell cell_of(const std::optional<int>& number) {
  return number ? Cell(std::int64_t{*number}) : Cell();
}

Cell cell_of(bool flag) {
  return std::int64_t{flag};
}

/// Values of a row from left to right, taken only if an event can have given rise to them.
class CellReader {
 public:
  CellReader(std::span<const Cell> cells, const char* table) : cells_(cells), table_(table) {}

  [[nodiscard]] int whole() { return whole_of(integer()); }
  [[nodiscard]] std::optional<int> optional_whole() {
    if (skip_null()) return std::nullopt;
    return whole();
  }
  [[nodiscard]] std::int64_t integer() { return next<std::int64_t>(); }
  [[nodiscard]] double real() { return next<double>(); }
  [[nodiscard]] std::string text() { return next<std::string>(); }
  [[nodiscard]] std::string text_or_empty() { return skip_null() ? std::string() : text(); }
  [[nodiscard]] bool flag() {
    const std::int64_t number = integer();
    if (number != 0 && number != 1) refuse();
    return number == 1;
  }
  [[nodiscard]] std::chrono::nanoseconds time() { return std::chrono::nanoseconds(integer()); }
  [[nodiscard]] std::optional<std::chrono::nanoseconds> optional_time() {
    if (skip_null()) return std::nullopt;
    return time();
  }
  template <typename State, std::size_t N>
  [[nodiscard]] State state(const std::array<std::string_view, N>& names) {
    const auto* const found = std::find(names.begin(), names.end(), text());
    if (found == names.end()) refuse();
    return static_cast<State>(found - names.begin());
  }

 private:
  template <typename Value>
  [[nodiscard]] Value next() {
    const Value* const value = std::get_if<Value>(&cells_[at_++]);
    if (value == nullptr) refuse();
    return *value;
  }
  [[nodiscard]] bool skip_null() {
    const bool is_null = std::holds_alternative<std::monostate>(cells_[at_]);
    at_ += is_null ? 1 : 0;
    return is_null;
  }
  [[nodiscard]] int whole_of(std::int64_t number) const {
    if (number < 0 || number > std::numeric_limits<int>::max()) refuse();
    return static_cast<int>(number);
  }
  [[noreturn]] void refuse() const {
    const auto* const session = std::get_if<std::int64_t>(&cells_.front());
    throw EventFault(
        session == nullptr ? 0 : *session, kNoEvent,
        std::string("derived table ") + table_ + " holds a value that no event gives rise to");
  }

  std::span<const Cell> cells_;
  const char* table_;
  std::size_t at_ = 0;
};

}  // namespace

Cells session_cells(const SessionRow& row, OwnNumber own) {
  const bool says_own = own == OwnNumber::always || row.own_session != row.session;
  return {std::int64_t{row.session},
          row.participant,
          std::int64_t{row.enrolment},
          state_cell(kSessionStates, row.state),
          cell_of(row.simulated),
          cell_of(row.pilot),
          cell_of(row.excluded),
          cell_of(row.withdrawn),
          row.device,
          row.replaced_by.empty() ? Cell() : Cell(row.replaced_by),
          says_own ? Cell(std::int64_t{row.own_session}) : Cell(),
          std::int64_t{row.station}};
}

Cells trial_cells(const TrialRow& row) {
  return {std::int64_t{row.session},
          std::int64_t{row.trial},
          std::int64_t{row.block},
          state_cell(kTrialStates, row.state),
          std::int64_t{row.presented_at.count()},
          cell_of(row.contact_at),
          cell_of(row.valid),
          row.overruns,
          row.samples,
          row.rate_hz,
          std::int64_t{row.explorations}};
}

Cells response_cells(const TrialRow& row) {
  return {std::int64_t{row.session}, std::int64_t{row.trial},     cell_of(row.answered_at),
          cell_of(row.position),     cell_of(row.first_position), cell_of(row.confidence)};
}

SessionRow session_row(std::span<const Cell> cells) {
  CellReader row(cells, "sessions");
  const int session = row.whole();
  // Members are initialised in the order of the columns.
  return {.session = session,
          .participant = row.text(),
          .enrolment = row.whole(),
          .state = row.state<SessionState>(kSessionStates),
          .simulated = row.flag(),
          .pilot = row.flag(),
          .excluded = row.flag(),
          .withdrawn = row.flag(),
          .device = row.text(),
          .replaced_by = row.text_or_empty(),
          .own_session = row.optional_whole().value_or(session),
          .station = row.whole()};
}

TrialRow trial_row(std::span<const Cell> cells) {
  constexpr std::size_t kOfTrials = 11;
  CellReader trial(cells.first(kOfTrials), "trials");
  TrialRow row;
  row.session = trial.whole();
  row.trial = trial.whole();
  row.block = trial.whole();
  row.state = trial.state<TrialState>(kTrialStates);
  row.presented_at = trial.time();
  row.contact_at = trial.optional_time();
  row.valid = trial.flag();
  row.overruns = trial.integer();
  row.samples = trial.integer();
  row.rate_hz = trial.real();
  row.explorations = trial.whole();
  const std::span<const Cell> response = cells.subspan(kOfTrials);
  if (std::holds_alternative<std::monostate>(response.front())) return row;
  CellReader answer(response, "responses");
  static_cast<void>(answer.whole());  // session and trial again
  static_cast<void>(answer.whole());
  row.answered_at = answer.time();
  row.position = answer.whole();
  row.first_position = answer.optional_whole();
  row.confidence = answer.optional_whole();
  return row;
}

}  // namespace touchtrial::store
