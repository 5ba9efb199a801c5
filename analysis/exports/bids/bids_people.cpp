#include "analysis/exports/bids/bids_people.hpp"

#include "analysis/exports/study_tables.hpp"
#include "analysis/outcomes/answers.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/demographics.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace touchtrial::analysis {
namespace {

/// A participant's demographics, and the last consent form signed.
struct BidsPerson : Demographics {
  std::optional<std::string> consent_version{};
};

/// A column of participants.tsv that exists only if at least one participant has a value.
struct OptionalColumn {
  const char* name;
  DataCell (*value)(const BidsPerson&);
};

constexpr std::array<OptionalColumn, 5> kOptionalColumns{{
    {"age_band", [](const BidsPerson& person) { return optional_cell(person.age_band); }},
    {"sex", [](const BidsPerson& person) { return optional_cell(person.sex); }},
    {"handedness",
     [](const BidsPerson& person) -> DataCell {
       if (!person.handedness_score) return std::monostate{};
       return handedness_of(*person.handedness_score);
     }},
    {"handedness_score",
     [](const BidsPerson& person) { return optional_cell(person.handedness_score); }},
    {"consent_version",
     [](const BidsPerson& person) { return optional_cell(person.consent_version); }},
}};

/// Adds the column unless all its values are missing.
/// \param people  one entry per row of the table
void add_if_known(DataTable& table, const OptionalColumn& column,
                  const std::vector<BidsPerson>& people) {
  std::vector<DataCell> values;
  for (const BidsPerson& one : people) values.push_back(column.value(one));
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
  static const std::vector<std::string> kColumns{
      "session",         "enrolment", "session_state", "excluded",      "pilot", "simulated",
      "counted_session", "device",    "replaced_by",   "interruptions", "pauses"};
  return kColumns;
}

std::vector<DataCell> session_cells(const BidsSession& session) {
  const record::SessionRow& row = session.row;
  return {std::int64_t{row.session},
          std::int64_t{row.enrolment},
          std::string(name_of(row.state)),
          flag(row.excluded),
          flag(row.pilot),
          flag(row.simulated),
          flag(session.counted),
          row.device,
          row.replaced_by,
          std::int64_t{session.interruptions},
          std::int64_t{session.pauses}};
}

void append_columns(DataTable& table, const std::vector<std::string>& columns) {
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
}

void append_cells(std::vector<DataCell>& row, std::vector<DataCell> cells) {
  row.insert(row.end(), std::make_move_iterator(cells.begin()),
             std::make_move_iterator(cells.end()));
}

std::vector<const BidsSession*> last_sessions(const std::vector<BidsSession>& sessions) {
  std::vector<const BidsSession*> participant_sessions;
  for (const BidsSession& session : sessions) {
    const auto entry =
        std::find_if(participant_sessions.begin(), participant_sessions.end(),
                     [&](const BidsSession* other) { return other->subject == session.subject; });
    if (entry == participant_sessions.end()) {
      participant_sessions.push_back(&session);
    } else {
      *entry = &session;
    }
  }
  return participant_sessions;
}

/// Adds each participant's group if the study has groups; hidden groups are missing.
void add_group(DataTable& table, const std::vector<const BidsSession*>& participant_sessions,
               const Collection& collection) {
  if (collection.prescription.groups.empty()) return;
  table.columns.emplace_back("group");
  for (std::size_t i = 0; i < participant_sessions.size(); ++i) {
    const auto record =
        std::ranges::find(collection.sessions, participant_sessions[i]->row.session,
                          [](const SessionRecord& session) { return session.row.session; });
    table.rows[i].emplace_back(record->group);
  }
}

/// The participant's last answer to each question, over all sessions.
BidsPerson last_answers(const std::string& subject, const std::vector<BidsSession>& sessions,
                        const std::map<int, Demographics>& by_session) {
  BidsPerson person;
  for (const BidsSession& session : sessions) {
    const auto found = by_session.find(session.row.session);
    if (session.subject == subject && found != by_session.end()) person.update(found->second);
  }
  return person;
}

/// A name of lower-case letters, digits and underscores, as BIDS requires for columns.
/// \param used_names  names in use; a number makes the new name different
std::string snake_case(const std::string& name, const std::vector<std::string>& used_names) {
  std::string snake;
  for (const char c : name) {
    const bool is_capital = c >= 'A' && c <= 'Z';
    const bool is_plain = is_capital || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_plain) {
      snake += is_capital ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!snake.empty() && snake.back() != '_') {
      snake += '_';
    }
  }
  while (!snake.empty() && snake.back() == '_') snake.pop_back();
  if (snake.empty() || (snake[0] >= '0' && snake[0] <= '9')) snake = "q_" + snake;
  std::string unique_name = snake;
  for (int n = 2; std::ranges::count(used_names, unique_name) > 0; ++n)
    unique_name = snake + "_" + std::to_string(n);
  return unique_name;
}

/// The day of a session, if it is recorded.
std::optional<std::chrono::sys_days> day_of(const std::string& opened_utc) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  if (std::sscanf(opened_utc.c_str(), "%4d-%2u-%2u", &year, &month, &day) != 3) return std::nullopt;
  return std::chrono::year(year) / std::chrono::month(month) / std::chrono::day(day);
}

void label_sessions(std::vector<BidsSession>& sessions) {
  std::map<std::string, int> count;
  for (const BidsSession& session : sessions) ++count[session.subject];
  const bool has_labels =
      std::any_of(count.begin(), count.end(), [](const auto& one) { return one.second > 1; });
  if (!has_labels) return;
  std::map<std::string, int> number;
  for (BidsSession& session : sessions) {
    session.label = "ses-" + std::to_string(++number[session.subject]);
  }
}

}  // namespace

std::string BidsSession::folder() const {
  return subject + (label.empty() ? "" : "/" + label);
}

std::string BidsSession::stem() const {
  return subject + (label.empty() ? "" : "_" + label);
}

std::vector<BidsSession> bids_sessions(const record::StudyStore& store) {
  const record::StudyState state = store.state();
  std::vector<BidsSession> sessions;
  const Collection collection = load_collection(store);
  std::vector<record::SessionRow> rows = store.sessions();
  std::erase_if(rows, [&](const record::SessionRow& row) {
    return row.erased || (state.unblinded && !state.reports(row.session));
  });
  const std::set<int> counted = counted_sessions(rows, store.commitment());
  std::map<std::string, std::chrono::sys_days> first_days;
  for (const SessionRecord& record : collection.sessions) {
    const record::SessionRow& row = record.row;
    if (row.erased || (state.unblinded && !state.reports(row.session))) continue;
    BidsSession& session = sessions.emplace_back();
    session.row = row;
    session.counted = counted.contains(row.session);
    session.interruptions = record.interruptions;
    session.pauses = record.pauses;
    session.subject = "sub-" + participant_label(row.participant);
    if (const auto day = day_of(record.opened_utc)) {
      session.days = *day - first_days.emplace(session.subject, *day).first->second;
    }
  }
  label_sessions(sessions);
  return sessions;
}

DataTable bids_participants(const DatasetSource& source, const std::vector<BidsSession>& sessions,
                            const Collection& collection,
                            const std::vector<record::PersonalRecord>& consents) {
  std::map<int, Demographics> by_session;
  if (source.outcomes != nullptr) {
    by_session = demographics_of(source.outcomes->answers, source.outcomes->design);
  }
  DataTable table{{"participant_id", "participant"}, {}};
  // A column must not be in both *_sessions.tsv and participants.tsv.
  const bool has_sessions = !sessions.empty() && !sessions.front().label.empty();
  if (!has_sessions) append_columns(table, session_columns());
  std::vector<BidsPerson> people;
  for (const BidsSession* session : last_sessions(sessions)) {
    std::vector<DataCell>& row = table.rows.emplace_back();
    row = {session->subject, session->row.participant};
    if (!has_sessions) append_cells(row, session_cells(*session));
    people.push_back(last_answers(session->subject, sessions, by_session));
    for (const record::PersonalRecord& one : consents) {
      if (one.participant != session->row.participant) continue;
      people.back().consent_version = one.consent_version;
    }
  }
  if (has_sessions) {
    add_group(table, last_sessions(sessions), collection);
  } else {
    add_visit_and_group(table, collection);
  }
  for (const OptionalColumn& column : kOptionalColumns) add_if_known(table, column, people);
  return table;
}

std::vector<BidsQuestionnaire> bids_questionnaires(const DatasetSource& study,
                                                   const std::vector<BidsSession>& sessions,
                                                   FreeText free_text) {
  const Outcomes& outcomes = *study.outcomes;
  std::map<std::string, std::map<int, std::map<std::string, DataCell>>> answers;
  std::map<std::string, std::vector<QuestionAnswer>> questions;  // one answer per question
  for (const QuestionAnswer& one : outcomes.answers) {
    if (free_text == FreeText::left_out && may_identify_person(one)) continue;
    answers[one.questionnaire][one.session][one.question] =
        one.number ? DataCell(*one.number) : DataCell(one.words);
    std::vector<QuestionAnswer>& distinct_questions = questions[one.questionnaire];
    if (std::ranges::find(distinct_questions, one.question, &QuestionAnswer::question) ==
        distinct_questions.end()) {
      distinct_questions.push_back(one);
    }
  }
  std::set<std::string> labels;  // session labels; one empty label if sessions have none
  for (const BidsSession& session : sessions) labels.insert(session.label);
  std::vector<BidsQuestionnaire> all;
  for (auto& [name, tool_questions] : questions) {
    std::ranges::sort(tool_questions, {}, &QuestionAnswer::question);
    for (const std::string& label : labels) {
      BidsQuestionnaire questionnaire;
      questionnaire.tool = snake_case(name, {});
      questionnaire.name = questionnaire.tool +
                           (label.empty() ? "" : "_session_" + label.substr(label.find('-') + 1));
      questionnaire.table.columns = {"participant_id"};
      for (const QuestionAnswer& question : tool_questions) {
        questionnaire.table.columns.push_back(
            snake_case(question.question, questionnaire.table.columns));
        questionnaire.questions.push_back(question_of(outcomes.questionnaires, question));
      }
      for (const BidsSession& session : sessions) {
        const auto session_answers = answers[name].find(session.row.session);
        if (session.label != label || session_answers == answers[name].end()) continue;
        std::vector<DataCell>& row = questionnaire.table.rows.emplace_back();
        row = {session.subject};
        for (const QuestionAnswer& question : tool_questions)
          row.push_back(session_answers->second[question.question]);
      }
      if (!questionnaire.table.rows.empty()) all.push_back(std::move(questionnaire));
    }
  }
  return all;
}

DataTable bids_sessions_of(const std::string& subject, const std::vector<BidsSession>& sessions,
                           const Collection& collection) {
  DataTable table{{"session_id"}, {}};
  append_columns(table, session_columns());
  const bool has_visits = collection.prescription.visits > 1;
  if (has_visits) table.columns.emplace_back("visit");
  for (const BidsSession& session : sessions) {
    if (session.subject != subject) continue;
    std::vector<DataCell>& row = table.rows.emplace_back();
    row = {session.label};
    append_cells(row, session_cells(session));
    if (has_visits) row.emplace_back(std::int64_t{session.row.visit});
  }
  return table;
}

}  // namespace touchtrial::analysis
