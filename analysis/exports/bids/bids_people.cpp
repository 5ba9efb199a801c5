#include "analysis/exports/bids/bids_people.hpp"

#include "analysis/demographics.hpp"
#include "analysis/exports/study_tables.hpp"
#include "analysis/session_rules.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace touchtrial::analysis {
namespace {

/// A column of participants.tsv that exists only if at least one participant has a value.
struct OptionalColumn {
  const char* name;
  DataCell (*value)(const Demographics&);
};

DataCell text_or_nothing(const std::optional<std::string>& text) {
  if (!text) return std::monostate{};
  return *text;
}

constexpr std::array<OptionalColumn, 4> kOptionalColumns{{
    {"age_band", [](const Demographics& of) { return text_or_nothing(of.age_band); }},
    {"sex", [](const Demographics& of) { return text_or_nothing(of.sex); }},
    {"handedness",
     [](const Demographics& of) -> DataCell {
       if (!of.handedness_score) return std::monostate{};
       return handedness_of(*of.handedness_score);
     }},
    {"handedness_score",
     [](const Demographics& of) -> DataCell {
       if (!of.handedness_score) return std::monostate{};
       return *of.handedness_score;
     }},
}};

/// Adds the column unless all its values are missing.
/// \param people  one entry for each row of the table
void add_if_known(DataTable& table, const OptionalColumn& column,
                  const std::vector<Demographics>& people) {
  std::vector<DataCell> values;
  for (const Demographics& one : people) values.push_back(column.value(one));
  if (std::all_of(values.begin(), values.end(), [](const DataCell& cell) {
        return std::holds_alternative<std::monostate>(cell);
      })) {
    return;
  }
  table.columns.emplace_back(column.name);
  for (std::size_t i = 0; i < values.size(); ++i) table.rows[i].push_back(std::move(values[i]));
}

/// The columns that describe a session, in the order of session_cells.
const std::vector<std::string>& session_columns() {
  static const std::vector<std::string> kColumns{"session",         "enrolment", "session_state",
                                                 "excluded",        "pilot",     "simulated",
                                                 "counted_session", "device",    "replaced_by"};
  return kColumns;
}

std::vector<DataCell> session_cells(const BidsSession& session) {
  const store::SessionRow& row = session.row;
  return {std::int64_t{row.session},
          std::int64_t{row.enrolment},
          std::string(text_of(row.state)),
          flag(row.excluded),
          flag(row.pilot),
          flag(row.simulated),
          flag(session.counted),
          row.device,
          row.replaced_by};
}

/// The last session of each participant.
std::vector<const BidsSession*> standing_sessions(const std::vector<BidsSession>& sessions) {
  std::vector<const BidsSession*> standing;
  for (const BidsSession& session : sessions) {
    const auto same = std::find_if(standing.begin(), standing.end(), [&](const BidsSession* other) {
      return other->subject == session.subject;
    });
    if (same == standing.end()) {
      standing.push_back(&session);
    } else {
      *same = &session;
    }
  }
  return standing;
}

/// The last answer that a participant gave to each question, over all sessions.
Demographics said_by(const std::string& subject, const std::vector<BidsSession>& sessions,
                     const std::map<int, Demographics>& by_session) {
  Demographics said;
  for (const BidsSession& session : sessions) {
    const auto found = by_session.find(session.row.session);
    if (session.subject != subject || found == by_session.end()) continue;
    if (found->second.age_band) said.age_band = found->second.age_band;
    if (found->second.sex) said.sex = found->second.sex;
    if (found->second.handedness_score) said.handedness_score = found->second.handedness_score;
  }
  return said;
}

void label_sessions(std::vector<BidsSession>& sessions) {
  std::map<std::string, int> count;
  for (const BidsSession& session : sessions) ++count[session.subject];
  const bool several =
      std::any_of(count.begin(), count.end(), [](const auto& one) { return one.second > 1; });
  if (!several) return;
  std::map<std::string, int> number;
  for (BidsSession& session : sessions) {
    session.label = "ses-" + std::to_string(++number[session.subject]);
  }
}

}  // namespace

std::string BidsSession::folder() const {
  return subject + (label.empty() ? "" : "/" + label) + "/beh";
}

std::string BidsSession::stem() const {
  return subject + (label.empty() ? "" : "_" + label);
}

std::vector<BidsSession> bids_sessions(const store::StudyStore& store) {
  const store::StudyState state = store.state();
  std::vector<BidsSession> sessions;
  for (const store::SessionRow& row : store.sessions()) {
    if (row.erased || (state.unblinded && !state.reports(row.session))) continue;
    sessions.push_back({row, session_counts(row, store.commitment()),
                        "sub-" + participant_label(row.participant), ""});
  }
  label_sessions(sessions);
  return sessions;
}

DataTable bids_participants(const DatasetSource& source, const std::vector<BidsSession>& sessions) {
  std::map<int, Demographics> by_session;
  if (source.key != nullptr) by_session = demographics_of(source.store, *source.key);
  DataTable table{{"participant_id", "participant"}, {}};
  table.columns.insert(table.columns.end(), session_columns().begin(), session_columns().end());
  std::vector<Demographics> people;
  for (const BidsSession* session : standing_sessions(sessions)) {
    std::vector<DataCell>& row = table.rows.emplace_back();
    row = {session->subject, session->row.participant};
    for (DataCell& cell : session_cells(*session)) row.push_back(std::move(cell));
    people.push_back(said_by(session->subject, sessions, by_session));
  }
  for (const OptionalColumn& column : kOptionalColumns) add_if_known(table, column, people);
  return table;
}

DataTable bids_sessions_of(const std::string& subject, const std::vector<BidsSession>& sessions) {
  DataTable table{{"session_id"}, {}};
  table.columns.insert(table.columns.end(), session_columns().begin(), session_columns().end());
  for (const BidsSession& session : sessions) {
    if (session.subject != subject) continue;
    std::vector<DataCell>& row = table.rows.emplace_back();
    row = {session.label};
    for (DataCell& cell : session_cells(session)) row.push_back(std::move(cell));
  }
  return table;
}

}  // namespace touchtrial::analysis
