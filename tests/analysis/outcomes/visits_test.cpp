/// Studies with several visits and groups: who counts, the primary test, breakdowns, exports, and
/// what is verified.
#include "analysis/checkers/checkers.hpp"
#include "analysis/exports/bids/export_bids.hpp"
#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_psych_ds.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/fake_study.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/verification/verification.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using analysis::identification::StudyReport;
using std::chrono::hours;
using std::chrono::seconds;

constexpr const char* kWeek = R"({"visits": {"count": 2, "least_days": 7}})";

/// The first `right` of a session's 12 trials are right, the others wrong.
FakeAnswers right_in_visit(int right) {
  return [right](const study::Trial& shown) {
    return std::optional((shown.field().class_index + (shown.place.trial <= right ? 0 : 1)) % 3);
  };
}

void add_visit(FakeStudy& study, int person, int visit, int right, hours after = hours(0)) {
  study.add({.participant = "P" + std::to_string(person),
             .enrolment = person,
             .answers = right_in_visit(right),
             .visit = visit,
             .after = after});
}

StudyReport report_on(FakeStudy& study) {
  return analysis::identification::make_report(analysis::load_outcomes(study.store(), study.key()));
}

/// Three people: 6 and 12 of 12 right, 3 and 9, and one without a second visit.
void add_three(FakeStudy& study) {
  add_visit(study, 1, 1, 6);
  add_visit(study, 2, 1, 3);
  add_visit(study, 3, 1, 12);
  add_visit(study, 1, 2, 12, hours(7 * 24));
  add_visit(study, 2, 2, 9, hours(7 * 24));
}

FakeOptions with(const std::string& sections, const std::string& registration = "") {
  return {.registration = registration, .sections = sections};
}

const analysis::Check& check_named(const analysis::Verification& found, const std::string& name) {
  return *std::ranges::find(found.checks, name, &analysis::Check::name);
}

std::string header_of(const std::filesystem::path& file) {
  const std::string text = text_of(read_file(file));
  return text.substr(0, text.find('\n'));
}

}  // namespace

TEST_CASE("a participant's visits are pooled, and who lacks one does not count") {
  FakeStudy study(with(kWeek));
  add_three(study);
  study.close_and_unblind();
  const StudyReport report = report_on(study);
  CHECK(report.participants == 2);
  CHECK(report.trials == 48);
  CHECK(report.methods[0].mean.mean == Approx(0.5 * (18 / 24.0 + 12 / 24.0)));
  CHECK(report.collection.flow.enrolled == 3);
  CHECK(report.collection.flow.analysed == 2);
  CHECK(report.collection.flow.open == 1);
  REQUIRE(report.methods[0].prevalence);
  CHECK(report.methods[0].prevalence->participants == 2);
}

TEST_CASE("the registered choice decides which visits enter the primary test") {
  const auto primary = [](const std::string& visits) {
    FakeStudy study(with(
        kWeek, R"({"participants": 3, "estimand": "mean-accuracy", "visits": ")" + visits + "\"}"));
    add_three(study);
    study.close_and_unblind();
    return report_on(study).primary.value().registered();
  };
  CHECK(primary("all").estimate == Approx(0.5 * (18 / 24.0 + 12 / 24.0)));
  CHECK(primary("all").participants == 2);
  CHECK(primary("first").estimate == Approx((6 + 3 + 12) / 36.0));
  CHECK(primary("first").participants == 3);
  CHECK(primary("last").estimate == Approx((12 + 9) / 24.0));
  CHECK(primary("last").participants == 2);
}

TEST_CASE("visits and groups are breakdowns, with intervals over participants") {
  FakeStudy study(
      with(R"({"visits": {"count": 2}, "groups": {"labels": ["trained", "control"]}})"));
  add_three(study);
  study.close_and_unblind();
  const nlohmann::json report =
      nlohmann::json::parse(analysis::identification::report_json(report_on(study)));
  const nlohmann::json& breakdowns = report["methods"][0]["breakdowns"];
  const nlohmann::json& visits = breakdowns["visit"];
  REQUIRE(visits.size() == 2);
  CHECK(visits[0]["participants"] == 2);
  CHECK(visits[0]["mean"] == Approx(4.5 / 12));
  CHECK(visits[1]["mean"] == Approx(10.5 / 12));
  CHECK(visits[1]["interval"].is_array());
  std::set<std::string> labels;
  int people = 0;
  for (const nlohmann::json& group : breakdowns["group"]) {
    labels.insert(group["group"].get<std::string>());
    people += group["participants"].get<int>();
  }
  CHECK(people == 2);
  CHECK(labels == std::set<std::string>{"control", "trained"});
  CHECK(report["collection"]["prescription"]["visits"] == 2);
  CHECK(report["primary"]["choices"][0]["participants"] == 2);
}

TEST_CASE("methods that are divided between visits are compared within participants") {
  FakeStudy study(study::identification::comparison(),
                  with(R"({"visits": {"count": 2, "methods": "divided"}})"));
  for (int visit = 1; visit <= 2; ++visit) {
    for (int person = 1; person <= 4; ++person) add_visit(study, person, visit, 6 * visit);
  }
  study.close_and_unblind();
  const StudyReport report = report_on(study);
  REQUIRE(report.comparison);
  CHECK(report.comparison->participants == 4);
  REQUIRE(report.primary);
  REQUIRE(report.primary->crossover);
  CHECK(report.primary->crossover->first_first == 2);
  CHECK(report.primary->crossover->second_first == 2);
  // Half of the answers are right at the first visit and all at the second, whatever the method.
  CHECK(report.primary->registered().estimate == Approx(0.0).margin(1e-12));
}

TEST_CASE("exports have columns of visits and groups, and others' exports do not") {
  FakeStudy study(
      with(R"({"visits": {"count": 2}, "groups": {"labels": ["trained", "control"]}})"));
  add_three(study);
  const auto folder = study.folder() / "blind";
  static_cast<void>(analysis::export_csv(study.store(), std::nullopt, folder));
  CHECK(header_of(folder / "trials.csv").ends_with(",overruns,paused,visit,group"));
  CHECK(header_of(folder / "participants.csv").ends_with(",visit,group"));
  for (const CsvRow& row : rows_of(folder / "participants.csv")) CHECK(row.at("group").empty());
  for (const CsvRow& row : rows_of(folder / "trials.csv")) CHECK(row.at("group").empty());
  study.close_and_unblind();
  const auto shown = study.folder() / "shown";
  static_cast<void>(analysis::export_csv(
      study.store(), analysis::load_outcomes(study.store(), study.key()), shown));
  for (const CsvRow& row : rows_of(shown / "participants.csv")) {
    const int number = std::stoi(row.at("enrolment"));
    const int group = study.key().group_of(number, study::Draws::rehearsal).value();
    CHECK(row.at("group") == study.key().study.groups.labels[static_cast<std::size_t>(group)]);
    CHECK(row.at("counted") == (number == 3 ? "0" : "1"));
    CHECK(row.at("visit") == (std::stoi(row.at("session")) > 3 ? "2" : "1"));
  }
  CHECK(rows_of(shown / "trials.csv").size() == 60);
  FakeStudy usual(study::identification::classification());
  static_cast<void>(analysis::export_csv(usual.store(), std::nullopt, usual.folder() / "out"));
  CHECK(header_of(usual.folder() / "out" / "trials.csv").ends_with(",overruns,paused"));
}

TEST_CASE("datasets for archives tell visits, and groups once outcomes are shown") {
  FakeStudy study(
      with(R"({"visits": {"count": 2}, "groups": {"labels": ["trained", "control"]}})"));
  add_three(study);
  const auto bids = study.folder() / "bids";
  const auto psych = study.folder() / "psych";
  const auto groups_in = [&] {
    CHECK(bids_faults(bids).empty());
    CHECK(psych_ds_faults(psych).empty());
    CHECK_THAT(text_of(read_file(bids / "sub-P1/sub-P1_sessions.tsv")),
               holds_text("\tpauses\tvisit\n"));
    const std::string people = text_of(read_file(bids / "participants.tsv"));
    CHECK_THAT(people, holds_text("participant_id\tparticipant\tgroup"));
    return people.find("trained") != std::string::npos ||
           people.find("control") != std::string::npos;
  };
  const analysis::DatasetSource blind{study.store()};
  static_cast<void>(analysis::export_bids(blind, {}, bids));
  static_cast<void>(analysis::export_psych_ds(blind, {}, psych));
  CHECK_FALSE(groups_in());
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::DatasetSource shown{study.store(), &outcomes, &study.key()};
  static_cast<void>(analysis::export_bids(shown, {}, bids));
  static_cast<void>(analysis::export_psych_ds(shown, {}, psych));
  CHECK(groups_in());
}

TEST_CASE("before outcomes are shown nothing in the database has a group that is not open") {
  for (const bool open : {false, true}) {
    FakeStudy study(with(std::string(R"({"groups": {"labels": ["trained", "control"], "open": )") +
                         (open ? "true" : "false") + "}}"));
    for (int person = 1; person <= 6; ++person) add_visit(study, person, 1, 6);
    std::set<std::string> told;
    std::set<std::size_t> sizes;
    study.store().for_each(record::EventKind::opened, [&](const record::Event& event) {
      told.insert(record::from_json<record::SessionOpening>(event.body).group);
      sizes.insert(event.body.size());
    });
    if (open) {
      CHECK(told == std::set<std::string>{"control", "trained"});
    } else {
      CHECK(told == std::set<std::string>{""});
      CHECK(sizes.size() == 1);
    }
    CHECK(analysis::verify_study(study.store(), &study.key(), nullptr).holds());
  }
}

TEST_CASE("verify replays every visit, and holds the days between visits against the study") {
  for (const int days : {7, 6}) {
    FakeStudy study({.simulated = false, .sections = kWeek});
    add_visit(study, 1, 1, 6);
    add_visit(study, 1, 2, 6, hours(24 * days));
    const analysis::Verification found =
        analysis::verify_study(study.store(), &study.key(), nullptr);
    CHECK(check_named(found, "chain").state == analysis::CheckState::passed);
    const analysis::Check& schedule = check_named(found, "schedule");
    if (days == 7) {
      CHECK(schedule.state == analysis::CheckState::passed);
    } else {
      CHECK(schedule.state == analysis::CheckState::failed);
      CHECK_THAT(schedule.detail, names("2 6.00"));
    }
  }
}

TEST_CASE("quality counts people by their last visit, and interim looks by complete people") {
  FakeStudy study(with(kWeek, R"({"participants": 4, "estimand": "mean-accuracy", "looks": [2]})"));
  add_three(study);
  CHECK(analysis::make_quality(study.store()).participants == 2);
  study.store().unblind(hours(8 * 24), "look", true);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  REQUIRE(outcomes.look_record.looks.size() == 1);
  CHECK(outcomes.look_record.looks[0].participants == 2);
}

}  // namespace touchtrial
