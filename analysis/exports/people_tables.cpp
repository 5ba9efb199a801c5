#include "analysis/exports/people_tables.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "core/named.hpp"
#include "record/marks.hpp"

#include <array>
#include <map>
#include <set>

namespace touchtrial::analysis {
namespace {

const char* name_of_kind(study::QuestionKind kind) {
  using enum study::QuestionKind;
  static constexpr auto kNames = std::to_array<Named<study::QuestionKind>>(
      {{"choice", choice}, {"number", number}, {"text", text}});
  return name_in(kNames, kind).data();
}

/// The kind of an answer; if its question is unknown, only whether it is a text.
DataCell kind_cell(const QuestionAnswer& answer, const study::Question* question) {
  if (question != nullptr) return std::string(name_of_kind(question->kind));
  return answer.number ? DataCell() : DataCell(std::string("text"));
}

template <typename Value>
DataCell cell_of(const std::optional<Value>& value) {
  return value ? DataCell(*value) : DataCell();
}

}  // namespace

DataTable answers_table(const Outcomes& outcomes, FreeText free_text) {
  DataTable table{columns_of("answers.csv"), {}};
  const std::string& language = outcomes.design.session.language;
  for (const QuestionAnswer& answer : outcomes.answers) {
    if (free_text == FreeText::left_out && may_identify_person(answer)) continue;
    const study::Question* const question = question_of(outcomes.questionnaires, answer);
    table.rows.push_back({answer.participant, std::int64_t{answer.session}, answer.questionnaire,
                          answer.question, kind_cell(answer, question),
                          question == nullptr ? "" : in_language(question->text, language),
                          cell_of(answer.number), words_of(answer, question, language),
                          flag(outcomes.simulated)});
  }
  return table;
}

std::vector<DataCell> incident_cells(const Incident& incident) {
  return {
      incident.participant,  std::int64_t{incident.session},
      incident.event,        std::string(record::name_of(incident.kind)),
      cell_of(incident.at),  incident.trial ? DataCell(std::int64_t{*incident.trial}) : DataCell(),
      incident.code,         incident.safety_fault,
      incident.device_fault, incident.text};
}

DataTable incidents_table(const record::StudyStore& store, const std::optional<Outcomes>& outcomes,
                          FreeText free_text) {
  DataTable table{columns_of("incidents.csv"), {}};
  for (Incident& incident : outcomes ? std::vector(outcomes->incidents) : load_incidents(store)) {
    if (free_text == FreeText::left_out) incident.text.clear();
    table.rows.push_back(incident_cells(incident));
    table.rows.back().push_back(flag(store.commitment().simulated));
  }
  return table;
}

DataTable marks_table(const Outcomes& outcomes) {
  DataTable table{columns_of("marks.csv"), {}};
  for (const InstrumentMark& mark : outcomes.marks) {
    table.rows.push_back({mark.participant, std::int64_t{mark.session},
                          mark.trial > 0 ? DataCell(std::int64_t{mark.trial}) : DataCell(),
                          std::string(name_of(static_cast<record::Mark>(mark.code))),
                          std::int64_t{mark.code}, mark.at, cell_of(mark.latency),
                          cell_of(mark.lsl_s), cell_of(mark.lsl_uncertainty_s),
                          flag(outcomes.simulated)});
  }
  return table;
}

DataTable consents_table(const record::StudyStore& store,
                         const std::vector<record::PersonalRecord>& consents) {
  std::set<std::string> participants;
  for (const record::SessionRow& row : store.sessions()) {
    if (!row.erased) participants.insert(row.participant);
  }
  DataTable table{columns_of("consents.csv"), {}};
  std::map<std::string, std::int64_t> numbers;
  for (const record::PersonalRecord& one : consents) {
    if (!participants.contains(one.participant)) continue;
    table.rows.push_back({one.participant, ++numbers[one.participant], one.consent_version,
                          flag(store.commitment().simulated)});
  }
  return table;
}

ExportFile text_table_file(const std::string& name, const DataTable& table, bool has_words,
                           const std::string& start) {
  return text_file(name, start + csv_text(table),
                   has_words ? FileMode::owner_only : FileMode::everyone);
}

std::vector<ResultTable> people_tables(const record::StudyStore& store,
                                       const std::optional<Outcomes>& outcomes,
                                       const std::vector<record::PersonalRecord>& consents) {
  std::vector<ResultTable> tables;
  if (outcomes) tables.push_back({"answers.csv", answers_table(*outcomes), true});
  if (outcomes && !outcomes->marks.empty()) {
    tables.push_back({"marks.csv", marks_table(*outcomes)});
  }
  tables.push_back({"incidents.csv", incidents_table(store, outcomes), outcomes.has_value()});
  if (!consents.empty()) tables.push_back({"consents.csv", consents_table(store, consents)});
  return tables;
}

}  // namespace touchtrial::analysis
