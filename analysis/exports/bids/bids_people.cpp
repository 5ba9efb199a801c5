#include "analysis/exports/bids/bids_people.hpp"

#include "analysis/exports/study_tables.hpp"
#include "analysis/sealed_sessions.hpp"
#include "analysis/session_rules.hpp"
#include "core/errors.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

struct Demographics {
  std::optional<std::string> age_band;     ///< for example "20-29", "under 18" or "70 or more"
  std::optional<std::string> sex;          ///< the text of the chosen option, in lower case
  std::optional<double> handedness_score;  ///< -100 to 100
};

/// Answers by the id of their question. Texts are left out, because they may name people.
struct QuestionnaireAnswers {
  std::map<std::string, int> choices;     ///< index of the option, or a whole number
  std::map<std::string, double> numbers;  ///< finite
};

bool fits_int(const nlohmann::json& value) {
  return value.is_number_integer() && value >= 0 && value <= std::numeric_limits<int>::max();
}

/// \throws StoreError if the text is not a JSON object
QuestionnaireAnswers answers_from_json(const std::string& text) {
  const nlohmann::json object = nlohmann::json::parse(text, nullptr, false);
  if (!object.is_object()) {
    throw StoreError("a questionnaire's answers are no JSON object; run `touchtrial verify`");
  }
  QuestionnaireAnswers answers;
  for (const auto& [id, value] : object.items()) {
    if (fits_int(value)) answers.choices[id] = value.get<int>();
    if (value.is_number()) answers.numbers[id] = value.get<double>();
  }
  return answers;
}

/// Changes ASCII letters only, in every locale.
std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// The text of an option in lower case, in English if the study has it in English.
std::optional<std::string> option_text(const design::Study& study, const std::string& question,
                                       int option) {
  for (const design::Question& one : study.session.closing_questions) {
    if (one.id != question || option < 0 || option >= static_cast<int>(one.options.size())) {
      continue;
    }
    const design::Translated& words = one.options[option];
    if (words.empty()) return std::nullopt;
    const auto english = words.find("en");
    return lower_case(english == words.end() ? words.begin()->second : english->second);
  }
  return std::nullopt;
}

/// \param age  in years
std::string age_band(double age) {
  if (!(age >= 18.0)) return "under 18";
  if (age < 20.0) return "18-19";
  if (age >= 70.0) return "70 or more";
  const int decade = static_cast<int>(std::floor(age / 10.0)) * 10;
  return fmt::format("{}-{}", decade, decade + 9);
}

/// The laterality quotient: the mean over the inventory's four items, each 100 (always right), 50,
/// 0, -50 or -100. Source: Veale (2014), Laterality 19, 164-177.
/// \return nothing if an item has no answer
std::optional<double> handedness_score(const std::map<std::string, int>& answers) {
  constexpr std::array<const char*, 4> kItems{"writing", "throwing", "toothbrush", "spoon"};
  double sum = 0.0;
  for (const char* item : kItems) {
    const auto answer = answers.find(item);
    if (answer == answers.end() || answer->second < 0 || answer->second > 4) return std::nullopt;
    sum += 100.0 - 50.0 * answer->second;
  }
  return sum / static_cast<double>(kItems.size());
}

/// "right", "left" or "ambidextrous", with Veale's bounds of 60 and -60.
std::string handedness_of(double score) {
  if (score > 60.0) return "right";
  return score < -60.0 ? "left" : "ambidextrous";
}

void take_answers(const std::string& questionnaire, const QuestionnaireAnswers& answers,
                  const design::Study& study, Demographics& of) {
  if (questionnaire == "handedness") {
    if (const auto score = handedness_score(answers.choices)) of.handedness_score = score;
  }
  const auto age = answers.numbers.find("age");
  if (age != answers.numbers.end()) of.age_band = age_band(age->second);
  for (const char* id : {"sex", "gender"}) {
    const auto chosen = answers.choices.find(id);
    if (chosen == answers.choices.end()) continue;
    if (const auto text = option_text(study, id, chosen->second)) of.sex = text;
  }
}

/// Demographics by session. They come from answers to questions with the id "age" (a number), "sex"
/// or "gender", and from the handedness inventory. Empty before unblinding.
/// \throws VerificationError if an answer does not open
std::map<int, Demographics> demographics(const DatasetSource& source) {
  std::map<int, Demographics> all;
  if (source.key == nullptr) return all;
  const std::map<int, SecretKey> keys = participant_keys(source.store, *source.key);
  source.store.for_each(store::EventKind::questioned, [&](const store::Event& event) {
    const auto own = keys.find(event.session);
    if (own == keys.end()) return;
    take_answers(store::remark_from_json(event.body),
                 answers_from_json(whole_event(event, own->second).secret), source.key->study,
                 all[event.session]);
  });
  return all;
}

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
  const std::map<int, Demographics> by_session = demographics(source);
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
