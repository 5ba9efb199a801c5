#include "analysis/exports/csv_reading.hpp"

#include "analysis/exports/collection_reading.hpp"
#include "analysis/outcomes/demographics.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

namespace touchtrial {
namespace {

/// Exact: whole seconds and decimals apart.
std::chrono::nanoseconds time_of(const std::string& text) {
  const std::size_t dot = std::min(text.find('.'), text.size());
  std::string decimals = dot < text.size() ? text.substr(dot + 1) : "";
  decimals.resize(9, '0');
  return std::chrono::seconds(number_of<std::int64_t>(text.substr(0, dot))) +
         std::chrono::nanoseconds(number_of<std::int64_t>(decimals));
}

int index_of(const std::vector<std::string>& labels, const std::string& label) {
  const auto found = std::find(labels.begin(), labels.end(), label);
  REQUIRE(found != labels.end());
  return static_cast<int>(found - labels.begin());
}

void read_study(analysis::Outcomes& outcomes, const std::filesystem::path& folder) {
  std::map<std::string, std::string> single;
  for (const CsvRow& row : rows_of(folder / "study.csv")) {
    const std::string& value = row.at("value");
    if (row.at("key") == "class") {
      outcomes.classes.push_back(value);
      outcomes.exemplars.emplace_back();
    } else if (row.at("key") == "exemplar") {
      outcomes.exemplars[index_of(outcomes.classes, row.at("of"))].push_back(value);
    } else if (row.at("key") == "method") {
      outcomes.methods.push_back(value);
    } else {
      single[row.at("key")] = value;
    }
  }
  outcomes.study = single.at("study");
  outcomes.simulated = is_set(single.at("simulated"));
  outcomes.pilot = is_set(single.at("pilot"));
  outcomes.visual = is_set(single.at("visual"));
  outcomes.state.closed = is_set(single.at("closed"));
  outcomes.state.unblinded = is_set(single.at("unblinded"));
  outcomes.state.unblinding_reason = single.at("unblinding_reason");
  if (is_set(single.at("interim"))) outcomes.state.interim.emplace();
  outcomes.choices = outcomes.classes;
  outcomes.design =
      study::parse_study(text_of_file(folder / "study_file.json"), ".", "study_file.json");
}

record::TrialState trial_state_of(const std::string& name) {
  const std::map<std::string, record::TrialState> states{
      {"presented", record::TrialState::presented},
      {"answered", record::TrialState::answered},
      {"timed-out", record::TrialState::timed_out},
      {"interrupted", record::TrialState::interrupted},
      {"voided", record::TrialState::voided}};
  return states.at(name);
}

void read_sessions(analysis::Outcomes& outcomes, const std::filesystem::path& folder) {
  for (const CsvRow& row : rows_of(folder / "participants.csv")) {
    if (!is_set(row.at("shown"))) {
      ++outcomes.sessions_unseen;
      continue;
    }
    const record::SessionRow session = session_row_of(row);
    if (outcomes.state.interim) outcomes.state.interim->insert(session.session);
    const std::string& block = row.at("order_block");
    outcomes.sessions.push_back(
        {session, is_set(row.at("counted")), block.empty() ? -1 : number_of<int>(block)});
    const std::string& decided = row.at("after_look");
    const auto note = [&](const char* word, std::set<int>& sessions) {
      if (decided.find(word) != std::string::npos) sessions.insert(session.session);
    };
    note("excluded", outcomes.look_record.excluded_afterwards);
    note("replaced", outcomes.look_record.replaced_afterwards);
    note("erased", outcomes.look_record.erased_afterwards);
  }
}

void read_looks(analysis::Outcomes& outcomes, const std::filesystem::path& folder) {
  for (const CsvRow& row : rows_of(folder / "looks.csv")) {
    analysis::Look look;
    std::istringstream at(row.at("at"));
    std::tm civil{};
    REQUIRE(at >> std::get_time(&civil, "%Y-%m-%dT%H:%M:%SZ"));
    look.at = std::chrono::seconds(timegm(&civil));
    look.participants = number_of<int>(row.at("participants"));
    look.reason = row.at("reason");
    look.participant = row.at("participant");
    look.station = number_of<int>(row.at("station"));
    for (const auto kind : {analysis::LookKind::final, analysis::LookKind::registered,
                            analysis::LookKind::unregistered, analysis::LookKind::person}) {
      if (analysis::name_of(kind) == row.at("kind")) look.kind = kind;
    }
    outcomes.look_record.looks.push_back(look);
  }
}

record::TrialRow trial_row_of(const CsvRow& row) {
  record::TrialRow trial;
  trial.session = number_of<int>(row.at("session"));
  trial.trial = number_of<int>(row.at("trial"));
  trial.block = number_of<int>(row.at("block"));
  trial.state = trial_state_of(row.at("state"));
  trial.presented_at = time_of(row.at("presented_at_s"));
  if (!row.at("first_contact_s").empty()) {
    trial.contact_at = trial.presented_at + time_of(row.at("first_contact_s"));
  }
  if (!row.at("reaction_time_s").empty()) {
    trial.answered_at = trial.presented_at + time_of(row.at("reaction_time_s"));
  }
  if (const auto position = maybe<int>(row.at("position"))) {
    trial.answer = ChoiceAnswer{*position, maybe<int>(row.at("first_position"))};
  }
  trial.confidence = maybe<int>(row.at("confidence"));
  trial.valid = is_set(row.at("valid_in_clear"));
  trial.overruns = number_of<std::int64_t>(row.at("overruns"));
  trial.samples = number_of<std::int64_t>(row.at("samples"));
  trial.rate_hz = number_of<double>(row.at("sampling_hz"));
  if (trial.has_trace()) {
    trial.hand = {.contact = is_set(row.at("contact_ok")),
                  .path = is_set(row.at("path_ok")),
                  .force = is_set(row.at("force_ok")),
                  .speed = is_set(row.at("speed_ok"))};
  }
  trial.explorations = number_of<int>(row.at("explorations"));
  return trial;
}

std::optional<record::TrialMeasures> measures_of(const CsvRow& row) {
  if (row.at("within_limits").empty()) return std::nullopt;
  return record::TrialMeasures{
      number_of<double>(row.at("contact_s")),   number_of<double>(row.at("path_mm")),
      number_of<double>(row.at("force_rms_n")), number_of<double>(row.at("saturated_share")),
      is_set(row.at("within_limits")),          maybe<std::int64_t>(row.at("limited_ticks"))};
}

study::StimulusIndex stimulus_of(const analysis::Outcomes& outcomes, const CsvRow& row) {
  study::StimulusIndex stimulus{.class_index = index_of(outcomes.classes, row.at("class"))};
  stimulus.exemplar = index_of(outcomes.exemplars[stimulus.class_index], row.at("exemplar"));
  stimulus.method = index_of(outcomes.methods, row.at("method"));
  return stimulus;
}

void read_trials(analysis::Outcomes& outcomes, const std::filesystem::path& file) {
  for (const CsvRow& row : rows_of(file)) {
    analysis::TrialOutcome& trial = outcomes.trials.emplace_back();
    trial.participant = row.at("participant");
    trial.row = trial_row_of(row);
    const std::string& kind = row.at("kind");
    if (kind == "lead-in") trial.role = study::Role::lead_in;
    if (kind == "catch") trial.role = study::Role::catch_trial;
    trial.scored = kind == "scored";
    trial.counted = is_set(row.at("counted"));
    if (kind != "catch") {
      trial.stimulus = stimulus_of(outcomes, row);
      trial.has_stimulus = true;
      trial.right = trial.stimulus.class_index;
    }
    if (!row.at("response").empty()) {
      trial.response = index_of(outcomes.classes, row.at("response"));
    }
    trial.measures = measures_of(row);
  }
}

void read_answers(analysis::Outcomes& outcomes, const std::filesystem::path& file) {
  outcomes.questionnaires = analysis::closing_questionnaires(outcomes.design);
  for (const CsvRow& row : rows_of(file)) {
    analysis::QuestionAnswer answer{row.at("participant"), number_of<int>(row.at("session")),
                                    row.at("questionnaire"), row.at("question")};
    answer.number = maybe<double>(row.at("answer"));
    if (!answer.number) answer.words = row.at("words");
    outcomes.answers.push_back(std::move(answer));
  }
}

/// Of participants with one session each.
void read_demographics(analysis::Outcomes& outcomes) {
  const auto said = analysis::demographics_of(outcomes.answers, outcomes.design);
  std::vector<analysis::Demographics> people;
  for (const analysis::SessionOutcome& one : outcomes.sessions) {
    if (!one.counted) continue;
    const auto own = said.find(one.row.session);
    people.push_back(own == said.end() ? analysis::Demographics{} : own->second);
  }
  outcomes.demographics = analysis::banded_characteristics(people);
}

}  // namespace

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records{{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& field = records.back().back();
    if (quoted && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[++i];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && text[i] == ',') {
      records.back().emplace_back();
    } else if (!quoted && text[i] == '\n') {
      records.push_back({""});
    } else {
      field += text[i];
    }
  }
  records.pop_back();
  return records;
}

std::string text_of_file(const std::filesystem::path& path) {
  return text_of(ByteView(read_file(path)));
}

void check_row(const CsvRow& row, const std::string& cells) {
  const std::string all = cells + ", ";
  for (std::size_t at = 0, end = 0; (end = all.find(", ", at)) != std::string::npos; at = end + 2) {
    const std::string cell = all.substr(at, end - at);
    const std::size_t sign = cell.find('=');
    INFO(cell);
    CHECK(row.at(cell.substr(0, sign)) == cell.substr(sign + 1));
  }
}

std::vector<CsvRow> rows_of(const std::filesystem::path& path) {
  const std::vector<std::vector<std::string>> records = parse_csv(text_of_file(path));
  std::vector<CsvRow> rows;
  for (std::size_t i = 1; i < records.size(); ++i) {
    REQUIRE(records[i].size() == records[0].size());
    CsvRow& row = rows.emplace_back();
    for (std::size_t k = 0; k < records[0].size(); ++k) row[records[0][k]] = records[i][k];
  }
  return rows;
}

analysis::Outcomes outcomes_from_csv(const std::filesystem::path& folder) {
  analysis::Outcomes outcomes;
  read_study(outcomes, folder);
  read_sessions(outcomes, folder);
  read_looks(outcomes, folder);
  outcomes.collection = collection_from_csv(folder, outcomes.state);
  read_trials(outcomes, folder / "trials.csv");
  read_trials(outcomes, folder / "unscored_trials.csv");
  read_answers(outcomes, folder / "answers.csv");
  read_demographics(outcomes);
  std::sort(outcomes.trials.begin(), outcomes.trials.end(),
            [](const analysis::TrialOutcome& a, const analysis::TrialOutcome& b) {
              return std::pair(a.row.session, a.row.trial) < std::pair(b.row.session, b.row.trial);
            });
  std::map<int, std::vector<record::TrialRow>> of_session;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    of_session[trial.row.session].push_back(trial.row);
  }
  for (analysis::SessionRecord& record : outcomes.collection.sessions) {
    record.spread = analysis::spread_of(of_session[record.row.session]);
  }
  return outcomes;
}

}  // namespace touchtrial
