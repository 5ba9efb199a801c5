// A report for everybody holds nobody's name and nothing that a person wrote.
#include "analysis/fake_study.hpp"
#include "analysis/outcomes/identities.hpp"
#include "analysis/report/figures/redraw.hpp"
#include "analysis/text_matching.hpp"
#include "core/bytes.hpp"
#include "core/files.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <filesystem>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace analysis::identification;

using std::chrono::milliseconds;
using std::chrono::seconds;

const std::vector<std::string> kPlanted = {
    "qqanna",    "qqbert",     "qqcarl",    "qqdora",      "qqemil",   "qqfritz",
    "qqlook",    "qqexcluded", "qqstopped", "qqdeviation", "qqcode",   "qqnote",
    "qqreplace", "qqwithdrew", "qqperson",  "qqunblind",   "qqremark", "qqafter"};

/// Six people, and a planted text wherever a person can write one.
void add_people_and_texts(FakeStudy& study) {
  for (int i = 0; i < 6; ++i) {
    FakeSession session{.participant = kPlanted[static_cast<std::size_t>(i)],
                        .enrolment = i + 1,
                        .answers = [i](const study::Trial& shown) {
                          const bool wrong = shown.place.trial <= 2 + i;
                          return std::optional((shown.field().class_index + (wrong ? 1 : 0)) % 3);
                        }};
    session.before_trials = [i](record::SessionRecorder& recorder) {
      if (i == 0)
        recorder.add(milliseconds(10), record::EventKind::deviated,
                     record::DeviationBody{"no-curtain", "qqdeviation"});
      if (i == 1)
        recorder.add(milliseconds(10), record::EventKind::deviated,
                     record::DeviationBody{"qqcode", "qqdeviation"});
      recorder.add(milliseconds(20), record::EventKind::noted,
                   record::RemarkBody{.text = "qqremark"});
      recorder.add(milliseconds(30), record::EventKind::questioned, record::TextBody{"closing"},
                   R"({"age": 34, "words": "qqremark", "which": )" + std::to_string(i % 2) + "}");
      if (i == 5)
        recorder.add(milliseconds(40), record::EventKind::stopped,
                     record::StopBody{.text = "qqstopped"});
    };
    session.complete = i != 5;
    study.add(session);
  }
  record::StudyStore& store = study.store();
  store.unblind(seconds(1'769'860'800), "qqlook", true);
  store.look_at("qqbert", seconds(1'769'860'900), "qqperson");
  store.exclude(3, seconds(1'769'861'000), "qqexcluded");
  store.note(1, seconds(1'769'861'100), "qqcode", "qqnote");
  store.withdraw(4, seconds(1'769'861'200), "qqwithdrew", record::Retention::data);
  store.replace(6, "qqafter", seconds(1'769'861'300), "qqreplace");
  store.close_study(seconds(1'769'861'400));
  store.unblind(seconds(1'769'861'500), "qqunblind", false);
}

/// Everything that a report writes, except what gnuplot draws from the scripts.
std::string everything(const StudyReport& report, const analysis::Provenance& provenance) {
  const analysis::Document document = study_document(report, provenance);
  std::string all = analysis::document_text(document) + analysis::page_html(document) +
                    analysis::document_markdown(analysis::tables_only(document), "") +
                    analysis::tables_latex(document) + report_json(report);
  for (const analysis::Figure& figure : report_figures(report)) {
    all += figure.id + figure.caption + figure.alt;
    for (const auto& [name, content] : analysis::redraw_files(figure)) all += content;
  }
  return all;
}

std::size_t found_in(const std::string& text) {
  std::size_t found = 0;
  for (const std::string& planted : kPlanted) found += contains(text, planted) ? 1 : 0;
  return found;
}

}  // namespace

TEST_CASE("a public report names nobody and holds nothing that a person wrote") {
  FakeStudy study({.simulated = false});
  add_people_and_texts(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  analysis::Provenance provenance = analysis::provenance_of(study.store(), "study.db");
  const std::string whole = everything(make_report(outcomes), provenance);
  CHECK(found_in(whole) >= 12);  // a report that hides nothing has most of them

  const analysis::Outcomes bare = analysis::without_identities(outcomes);
  provenance.state = bare.state;
  const std::string text = everything(make_report(bare), provenance);
  for (const std::string& planted : kPlanted) {
    INFO(planted);
    CHECK_FALSE(contains(text, planted));
  }
  // The codes that the program gives stay, the experimenter's own do not.
  CHECK_THAT(text, holds_text("no-curtain"));
  CHECK_THAT(text, holds_text("other (2)"));
  CHECK_THAT(text, names("1 session"));
}

TEST_CASE("every code of the data dictionary stays in a public report") {
  std::string page = text_of(
      read_file(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "data-dictionary.md"));
  page.erase(0, page.find("Codes of deviations"));
  page.erase(page.find("| any other |"));
  analysis::Outcomes outcomes;
  analysis::SessionRecord& session = outcomes.collection.sessions.emplace_back();
  const std::regex code("`([^`]+)`");
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    line.erase(line.find(" | "));
    for (std::sregex_iterator one(line.begin(), line.end(), code), end; one != end; ++one) {
      session.deviations.push_back({(*one)[1], "in words"});
    }
  }
  REQUIRE(session.deviations.size() > 20);
  const auto kept = analysis::without_identities(outcomes).collection.sessions[0].deviations;
  REQUIRE(kept.size() == session.deviations.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    CHECK(kept[i].code == session.deviations[i].code);
    CHECK(kept[i].text.empty());
  }
}

TEST_CASE("a public report has the numbers of the other one, by rank of accuracy") {
  FakeStudy study(study::identification::comparison(),
                  {.simulated = false, .session = R"({"closing_questions": [
                    {"id": "which", "kind": "choice", "text": {"en": "Which was best?"},
                     "options": [{"en": "rough"}, {"en": "smooth"}]}]})"});
  add_people_and_texts(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const auto json_of = [](const analysis::Outcomes& of) {
    return nlohmann::json::parse(report_json(make_report(of)));
  };
  nlohmann::json whole = json_of(outcomes);
  nlohmann::json open = json_of(analysis::without_identities(outcomes));
  CHECK(whole["public"] == false);
  CHECK(open["public"] == true);
  CHECK(open["collection"]["sessions"].empty());
  const nlohmann::json& people = open["methods"][0]["per_participant"];
  REQUIRE(people.size() == whole["methods"][0]["per_participant"].size());
  CHECK(people.front()["participant"] == "1");
  for (nlohmann::json* json : {&whole, &open}) {
    for (nlohmann::json& method : (*json)["methods"]) method.erase("per_participant");
  }
  for (const char* part :
       {"methods", "pairs", "comparison", "participants", "trials", "exploration"}) {
    INFO(part);
    CHECK(open[part] == whole[part]);
  }
  // Four people count, too few to show what each of them said.
  REQUIRE(whole["said"].size() == 2);
  CHECK(whole["said"][0]["options"][0]["participants"] == 2);
  CHECK(whole["said"][0]["options"][1]["option"] == "smooth");
  CHECK(whole["said"][1]["texts"].size() == 4);
  CHECK(open["said"][0]["options"].empty());
  CHECK(open["said"][0]["others"] == 4);
  CHECK(open["said"][1]["answered"] == 4);
  CHECK(open["said"][1]["texts"].empty());
  CHECK(open["primary"]["choices"] == whole["primary"]["choices"]);
  CHECK(open["primary"]["p"] == whole["primary"]["p"]);
}

}  // namespace touchtrial
