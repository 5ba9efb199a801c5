#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <map>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

void fill(FakeStudy& study) {
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::confusing(0, 1)});
  study.add({.participant = "P02", .enrolment = 2, .answers = [](const study::Trial& shown) {
               return shown.place.trial == 7 ? std::nullopt
                                             : std::optional(shown.field().class_index);
             }});
}

constexpr const char* kHeader =
    "participant,session,trial,block,method,class,exemplar,response,correct,confidence,"
    "reaction_time_s,from_contact_s,contact_s,path_mm,force_rms_n,saturated_share,valid,"
    "presented_at_s,simulated,counted,kind,state,explorations,first_contact_s,position,"
    "first_position,valid_in_clear,contact_ok,path_ok,force_ok,speed_ok,within_limits,limited_"
    "ticks,samples,sampling_hz,overruns,paused";

/// The study's own closing questions.
constexpr const char* kQuestions = R"({"closing_questions": [
  {"id": "hard", "kind": "number", "text": {"en": "How hard was it?"}},
  {"id": "which", "kind": "choice", "text": {"en": "Which was best?"},
   "options": [{"en": "rough"}, {"en": "smooth"}]}]})";

}  // namespace

TEST_CASE("Exported trials count up to the report") {
  FakeStudy study(study::identification::comparison(), {.label = "bark, \"old\""});
  fill(study);
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(outcomes);
  const std::filesystem::path out = study.folder() / "new" / "out";
  const auto files = analysis::export_csv(study.store(), outcomes, out);
  REQUIRE(files.size() == 13);

  std::map<std::string, std::map<std::string, std::map<std::string, int>>> counts;
  int correct = 0;
  for (const CsvRow& row : rows_of(out / "trials.csv")) {
    ++counts[row.at("method")][row.at("class")][row.at("response")];
    correct += row.at("correct") == "1" ? 1 : 0;
  }
  int expected_correct = 0;
  for (const analysis::identification::MethodReport& method : report.methods) {
    expected_correct += method.overall.correct;
    const auto confusion = rows_of(out / ("confusion_" + method.method + ".csv"));
    REQUIRE(confusion.size() == 3);
    for (int i = 0; i < 3; ++i) {
      auto& answers = counts[method.method][report.classes[i]];
      CHECK(confusion[i].at("presented") == report.classes[i]);
      CHECK(answers[""] == method.confusion.no_response(i));
      CHECK(confusion[i].at("no_response") == std::to_string(answers[""]));
      for (int j = 0; j < 3; ++j) {
        CHECK(answers[report.classes[j]] == method.confusion.count(i, j));
        CHECK(confusion[i].at(report.classes[j]) == std::to_string(method.confusion.count(i, j)));
      }
    }
  }
  CHECK(correct == expected_correct);
}

TEST_CASE("trials.csv has the published columns, exact times and numbers") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  analysis::export_csv(study.store(), outcomes, study.folder());
  const std::string text = text_of_file(study.folder() / "trials.csv");
  CHECK(text.substr(0, text.find('\n')) == kHeader);
  const std::vector<CsvRow> rows = rows_of(study.folder() / "trials.csv");
  REQUIRE(rows.size() == 24);
  const CsvRow& first = rows.front();
  check_row(first,
            "participant=P01, trial=1, method=adaptive, presented_at_s=10, reaction_time_s=4.25, "
            "from_contact_s=3.75, contact_s=4, path_mm=300.5, force_rms_n=0.125, "
            "saturated_share=0.001, valid=1, confidence=");
  const CsvRow& missed = rows[12 + 6];
  check_row(missed, "response=, correct=0, reaction_time_s=");
}

TEST_CASE("An exported trial is valid by the rule's part in clear, then by its sealed part too") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1, .within_limits = false});
  study.add({.participant = "P02", .enrolment = 2, .valid = false});
  study.add({.participant = "P03", .enrolment = 3});
  const auto check = [&](const std::map<std::string, std::string>& expected) {
    const std::vector<CsvRow> rows = rows_of(study.folder() / "trials.csv");
    REQUIRE(rows.size() == 36);
    for (const CsvRow& row : rows) CHECK(row.at("valid") == expected.at(row.at("participant")));
  };
  analysis::export_csv(study.store(), std::nullopt, study.folder());
  check({{"P01", "1"}, {"P02", "0"}, {"P03", "1"}});
  study.close_and_unblind();
  analysis::export_csv(study.store(), analysis::load_outcomes(study.store(), study.key()),
                       study.folder());
  check({{"P01", "0"}, {"P02", "0"}, {"P03", "1"}});
}

TEST_CASE("Before unblinding an export has no word of what was presented or answered") {
  FakeStudy study(study::identification::comparison(), {.label = "petrified wood"});
  fill(study);
  const std::filesystem::path out = study.folder() / "out";
  const auto files = analysis::export_csv(study.store(), std::nullopt, out);
  CHECK(files.size() == 7);
  CHECK_FALSE(std::filesystem::exists(out / "confusion_adaptive.csv"));
  const std::string json = text_of_file(analysis::export_json(study.store(), std::nullopt, out));
  const std::string csv = text_of_file(out / "trials.csv");
  const std::string people = text_of_file(out / "participants.csv");
  CHECK(csv.starts_with("participant,session,trial,block,contact_s,path_mm,"));
  for (const char* secret :
       {"petrified", "cloth", "straw", "png", "adaptive", "tv-gabor", "correct", "exemplar"}) {
    CHECK_FALSE(contains(csv, secret));
    CHECK_FALSE(contains(people, secret));
    CHECK_FALSE(contains(json, secret));
  }
  for (const char* column : {"class", "response", "method"}) {
    CHECK_FALSE(nlohmann::json::parse(json)["trials"][0].contains(column));
  }
  const std::vector<CsvRow> rows = rows_of(out / "trials.csv");
  REQUIRE(rows.size() == 48);
  CHECK(rows[0].size() == 20);
  for (const char* column : {"confidence", "reaction_time_s", "from_contact_s", "presented_at_s",
                             "first_contact_s", "samples"}) {
    INFO(column);
    CHECK_FALSE(rows[0].contains(column));
  }
  for (const CsvRow& row : rows) {
    for (const char* sealed : {"contact_s", "path_mm", "force_rms_n", "saturated_share"}) {
      CHECK(row.at(sealed).empty());
    }
  }
}

TEST_CASE("participants.csv tells whose sessions count and that they are simulated") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.add({.participant = "P03", .enrolment = 3, .complete = false, .stop_after = 2});
  analysis::export_csv(study.store(), std::nullopt, study.folder());
  const std::vector<CsvRow> rows = rows_of(study.folder() / "participants.csv");
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].at("counted") == "1");
  check_row(rows[2], "participant=P03, state=stopped, counted=0");
  for (const CsvRow& row : rows) CHECK(row.at("simulated") == "1");
  const auto contents = nlohmann::json::parse(text_of_file(study.folder() / "export.json"));
  CHECK(contents["stamp"] == "SIMULATED");
  CHECK(contents["blinded"] == true);
  CHECK(contents["files"] == nlohmann::json({"trials.csv", "participants.csv", "deviations.csv",
                                             "servo.csv", "incidents.csv", "study.csv"}));
}

TEST_CASE("The JSON export holds the report and the same trials") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  analysis::export_csv(study.store(), outcomes, study.folder());
  const auto json = nlohmann::json::parse(
      text_of_file(analysis::export_json(study.store(), outcomes, study.folder())));
  CHECK(json["stamp"] == "SIMULATED");
  CHECK(json["report"] == nlohmann::json::parse(analysis::identification::report_json(
                              analysis::identification::make_report(outcomes))));
  CHECK(json["participants"].size() == 2);
  const std::vector<CsvRow> rows = rows_of(study.folder() / "trials.csv");
  REQUIRE(json["trials"].size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& trial = json["trials"][i];
    CHECK(trial.size() == rows[i].size());
    CHECK(trial["class"] == rows[i].at("class"));
    CHECK(trial["response"].is_null() == rows[i].at("response").empty());
  }
  CHECK(json["trials"][0]["reaction_time_s"] == 4.25);
}

TEST_CASE("What participants said and what happened to them comes out with outcomes alone") {
  FakeStudy study({.simulated = false, .session = kQuestions});
  study.add(talkative("P01", 1, R"({"hard":7.0,"remarks":"=none","which":1})"));
  study.add(talkative("P02", 2, R"({"remarks":"it is Anna's"})"));
  study.store().note(1, std::chrono::milliseconds(20), "too-hot", "30 degrees");
  study.store().withdraw(2, std::chrono::milliseconds(30), "asked to");
  const std::vector<record::PersonalRecord> consents{
      {.participant = "P01", .consent_version = "1", .contact = "somebody@example.org"},
      {.participant = "P01", .consent_version = "2"},
      {.participant = "P02", .consent_version = "2"},
      {.participant = "P09", .consent_version = "2"}};
  const std::filesystem::path out = study.folder() / "out";
  const auto all_text = [&] {
    std::string text;
    for (const auto& file : analysis::export_csv(study.store(), std::nullopt, out, consents)) {
      text += text_of_file(file);
    }
    return text + text_of_file(analysis::export_json(study.store(), std::nullopt, out, consents));
  };
  const std::string blind = all_text();
  for (const char* words : {"phone", "wears", "Anna", "=none", "30 degrees", "somebody", "P09"}) {
    INFO(words);
    CHECK_FALSE(contains(blind, words));
  }
  std::vector<CsvRow> incidents = rows_of(out / "incidents.csv");
  REQUIRE(incidents.size() == 7);
  const std::vector<std::string> kinds{"paused",           "resumed",     "noted",
                                       "interrupted",      "interrupted", "interrupted",
                                       "participant-noted"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    CHECK(incidents[i].at("participant") == "P01");
    CHECK(incidents[i].at("incident") == kinds[i]);
    check_row(incidents[i], "at_s=, text=");
  }
  check_row(incidents[3], "trial=1, code=comfort stop");
  CHECK(incidents[6].at("code") == "too-hot");
  const std::vector<CsvRow> signed_forms = rows_of(out / "consents.csv");
  REQUIRE(signed_forms.size() == 2);  // of people with a session whose data are there
  check_row(signed_forms[1], "consent=2, consent_version=2");
  const CsvRow person = rows_of(out / "participants.csv").front();
  check_row(person, "interruptions=3, pauses=1");
  CHECK_FALSE(person.contains("handedness_score"));

  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  analysis::export_csv(study.store(), outcomes, out, consents);
  incidents = rows_of(out / "incidents.csv");
  REQUIRE(incidents.size() == 7);
  check_row(incidents[0], "text=a phone rang, at_s=0.02");
  CHECK(incidents[6].at("text") == "30 degrees");
  const std::vector<CsvRow> answers = rows_of(out / "answers.csv");
  REQUIRE(answers.size() == 5 + 3);
  CHECK(answers[0].at("questionnaire") == "handedness");
  check_row(answers[1], "question=spoon, answer=1");
  check_row(answers[5], "question=hard, question_kind=number, wording=How hard was it?, answer=7");
  CHECK(answers[6].at("words") == "'=none");  // no formula
  check_row(answers[7], "question_kind=choice, answer=1, words=smooth");
  CHECK(rows_of(out / "participants.csv").front().at("handedness_score") == "87.5");
  const auto json = nlohmann::json::parse(
      text_of_file(analysis::export_json(study.store(), outcomes, out, consents)));
  CHECK(json["answers"].size() == 8);
  CHECK(json["answers"][6]["words"] == "=none");
  CHECK(json["incidents"][0]["text"] == "a phone rang");
  CHECK(json["consents"].size() == 2);
  const auto beside =
      analysis::export_typed_text(study.store(), outcomes, study.folder() / "r", consents);
  REQUIRE(beside.size() == 3);
  CHECK(rows_of(beside[0]) == answers);
}

TEST_CASE("Exporting twice gives the same bytes and leaves other files alone") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const std::filesystem::path out = study.folder() / "out";
  std::filesystem::create_directory(out);
  replace_file(out / "notes.txt", "mine");
  std::map<std::filesystem::path, std::string> before;
  for (const auto& file : analysis::export_csv(study.store(), outcomes, out)) {
    before[file] = text_of_file(file);
  }
  const std::string json = text_of_file(analysis::export_json(study.store(), outcomes, out));
  for (const auto& file : analysis::export_csv(study.store(), outcomes, out)) {
    CHECK(before.at(file) == text_of_file(file));
  }
  CHECK(json == text_of_file(analysis::export_json(study.store(), outcomes, out)));
  CHECK(text_of_file(out / "notes.txt") == "mine");
}

TEST_CASE("An export into a file instead of a folder is refused") {
  FakeStudy study(study::identification::classification());
  const std::string complaint = message_of<FileError>(
      [&] { analysis::export_csv(study.store(), std::nullopt, study.database()); });
  CHECK(contains(complaint, study.database().string()));
}

}  // namespace touchtrial
