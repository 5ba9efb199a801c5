#include "analysis/checkers/checkers.hpp"
#include "analysis/exports/bids/bids_motion.hpp"
#include "analysis/exports/bids/export_bids.hpp"
#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_psych_ds.hpp"
#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

const std::vector<std::string> kNoFaults;

void fill(FakeStudy& study) {
  study.add({.participant = "P-01", .enrolment = 1, .answers = FakeStudy::confusing(0, 1)});
  study.add({.participant = "Z_2+", .enrolment = 2, .answers = [](const study::Trial& shown) {
               return shown.place.trial == 7 ? std::nullopt
                                             : std::optional(shown.field().class_index);
             }});
  study.add({.participant = "P03", .enrolment = 3, .complete = false, .stop_after = 2});
}

/// An unblinded study, and everything that an export of it needs.
struct OpenStudy {
  explicit OpenStudy(FakeStudy& study)
      : outcomes(analysis::load_outcomes(study.store(), study.key())),
        source{study.store(), &outcomes, &study.key()} {}

  analysis::Outcomes outcomes;
  analysis::DatasetSource source;
};

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      all[entry.path().lexically_relative(folder).generic_string()] = text_of_file(entry.path());
    }
  }
  return all;
}

}  // namespace

TEST_CASE("participant_label gives different ids different labels of letters and digits") {
  CHECK(analysis::participant_label("P07") == "P07");
  CHECK(analysis::participant_label("P-07") == "PZd07");
  CHECK(analysis::participant_label("P_07") == "PZu07");
  CHECK(analysis::participant_label("P+07") == "PZp07");
  CHECK(analysis::participant_label("PZd07") == "PZZd07");
  CHECK(analysis::plain_label("comparison-textures") == "comparisontextures");
  CHECK(analysis::plain_label("--") == "study");
}

TEST_CASE("A study as BIDS keeps to the specification, with traces, database and without") {
  FakeStudy study(study::identification::comparison(), {.label = "bark \"old\""});
  fill(study);
  study.close_and_unblind();
  const OpenStudy open(study);
  const fs::path out = study.folder() / "bids";
  analysis::DatasetOptions options{
      .authors = {"A. Author"}, .license = "CC0", .institution = "A lab"};
  analysis::export_bids(open.source, options, out);
  CHECK(bids_faults(out) == kNoFaults);
  options.traces = true;
  options.database = study.database();
  analysis::export_bids(open.source, options, out);
  CHECK(bids_faults(out) == kNoFaults);
  const fs::path copy = out / "sourcedata" / "study.db";
  CHECK(record::StudyStore::open(copy, record::StudyStore::Access::read_only).trials() ==
        study.store().trials());
  CHECK_FALSE(path_exists(copy.string() + ".key"));
  const std::string report = text_of_file(out / "derivatives/touchtrial/results.json");
  CHECK(report == analysis::identification::report_json(
                      analysis::identification::make_report(open.outcomes)));
}

TEST_CASE("A BIDS run holds the trace of its trial, and tells when and what was felt") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const OpenStudy open(study);
  const fs::path out = study.folder() / "bids";
  analysis::export_bids(open.source, {.traces = true}, out);
  CHECK(bids_faults(out) == kNoFaults);
  const fs::path person = out / "sub-PZd01";
  const std::string run =
      (person / "motion/sub-PZd01_task-single_tracksys-stylus_run-002_").string();
  const std::string rows = text_of_file(run + "motion.tsv");
  CHECK(rows.starts_with(
      "0.000000\t0.000\t0.000\t-0.500\t0.0000\t0.0000\t0.2500\n0.001000\t0.100\t"));
  CHECK(std::count(rows.begin(), rows.end(), '\n') == 20);
  const auto sidecar = nlohmann::json::parse(text_of_file(run + "motion.json"));
  CHECK(sidecar["SamplingFrequency"] == 1000.0);
  CHECK(sidecar["TaskName"] == "single");
  CHECK(contains(sidecar["TrackingSystemName"].get<std::string>(), "(SIMULATED)"));
  const std::string trials = text_of_file(person / "beh/sub-PZd01_task-single_beh.tsv");
  CHECK(contains(trials, "motion/sub-PZd01_task-single_tracksys-stylus_run-002_motion.tsv"));
  const auto scans = text_of_file(person / "sub-PZd01_scans.tsv");
  CHECK(contains(scans, "run-002_motion.tsv\t1920-01-01T00:00:20.000000\n"));
  const std::string events = text_of_file(run + "events.tsv");
  CHECK(events.starts_with("onset\tduration\ttrial_type\tincident\texploration\n0\t0.02\t"));
  CHECK(contains(events, "\tplane-on\t1\n0.5\t0\t"));
  CHECK(contains(events, "\tcontact\tn/a\n4.25\t0\t"));
  CHECK(events.ends_with("\tanswered\tn/a\n"));
  const std::string other =
      text_of_file(out /
                   "sub-ZZZu2Zp/motion/"
                   "sub-ZZZu2Zp_task-single_tracksys-stylus_run-007_events.tsv");
  CHECK(other.ends_with("\ttime-up\tn/a\n"));
}

TEST_CASE("A BIDS recording keeps a trace's steps distinct, and writes no zero with a sign") {
  record::Trace trace;
  for (int i = -9000; i <= 9000; i += 7) {
    trace.samples.push_back({{i / 1000.0, -0.0004, 0.0}, {i / 4096.0, 1 / 4096.0, -0.00004}});
  }
  record::TrialRow row;
  row.rate_hz = trace.rate_hz;
  row.samples = static_cast<std::int64_t>(trace.samples.size());
  const std::string text = analysis::motion_text(trace, analysis::recording_of(row, {}));
  CHECK(text.starts_with(
      "0.000000\t-9.000\t0.000\t0.000\t-2.1973\t0.0002\t0.0000\n0.001000\t-8.993\t"));
  std::istringstream lines(text);
  for (int i = -9000; i <= 9000; i += 7) {
    std::array<double, 7> read{};
    for (double& number : read) lines >> number;
    CHECK(std::lround(read[1] * 1000.0) == i);
    CHECK(std::lround(read[4] * 4096.0) == i);
  }
}

TEST_CASE("Latencies of a recording skip the time between explorations, where it is known") {
  record::Trace trace;
  trace.rate_hz = 3000.0;
  trace.samples.resize(5);
  record::TrialRow row;
  row.rate_hz = trace.rate_hz;
  row.samples = 5;
  row.presented_at = milliseconds(7000);
  record::TraceBody body{.explorations = {2, 3}};
  const auto latencies = [&] {
    const analysis::Recording recording = analysis::recording_of(row, body);
    std::istringstream lines(analysis::motion_text(trace, recording));
    std::vector<std::string> first;
    for (std::string line; std::getline(lines, line);)
      first.push_back(line.substr(0, line.find('\t')));
    return first;
  };
  CHECK(latencies() == std::vector<std::string>{"0.000000", "0.000333", "n/a", "n/a", "n/a"});
  CHECK(analysis::recording_of(row, body).first_sample == milliseconds(7000));
  body.began_ns = {1'500'000, 4'251'500'000};
  CHECK(latencies() ==
        std::vector<std::string>{"0.000000", "0.000333", "4.250000", "4.250333", "4.250667"});
  CHECK(analysis::recording_of(row, body).first_sample == std::chrono::microseconds(7'001'500));
}

TEST_CASE("A BIDS dataset loses its traces and withdrawn participants when it is exported again") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const fs::path out = study.folder() / "bids";
  analysis::export_bids(OpenStudy(study).source, {.traces = true}, out);
  CHECK(path_exists(out / "sub-PZd01"));
  study.store().withdraw(1, milliseconds(2000), "asked to");
  analysis::export_bids(OpenStudy(study).source, {}, out);
  CHECK(bids_faults(out) == kNoFaults);
  CHECK_FALSE(path_exists(out / "sub-PZd01"));
  for (const auto& [name, text] : contents(out)) {
    INFO(name);
    CHECK_FALSE(contains(text, "P-01"));
    CHECK_FALSE(contains(name, "motion"));
    CHECK_FALSE(name.ends_with("scans.tsv"));
  }
}

TEST_CASE("Participants with several sessions have folders for them") {
  FakeStudy study({.simulated = false, .session = R"({"closing_questions": [
                    {"id": "hard", "kind": "number", "text": {"en": "How hard was it?"}}]})"});
  FakeSession first = talkative("P01", 1, R"({"hard":7})");
  first.complete = false;
  first.stop_after = 3;
  first.after = std::chrono::hours(30);
  study.add(first);
  study.store().replace(1, "P01", std::chrono::hours(31), "the device failed");
  FakeSession second = talkative("P01", 1, R"({"hard":5})");
  second.after = std::chrono::hours(24 * 9);
  study.add(second);
  study.add({.participant = "P02", .enrolment = 2, .after = std::chrono::hours(24 * 10)});
  study.close_and_unblind();
  const fs::path out = study.folder() / "bids";
  analysis::export_bids(OpenStudy(study).source, {.traces = true}, out);
  CHECK(bids_faults(out) == kNoFaults);
  CHECK(path_exists(out / "sub-P01/ses-2/beh/sub-P01_ses-2_task-single_beh.tsv"));
  CHECK(path_exists(out / "sub-P02/ses-1/beh/sub-P02_ses-1_task-single_beh.tsv"));
  CHECK(path_exists(out / "sub-P01/sub-P01_sessions.tsv"));
  CHECK(text_of_file(out / "participants.tsv")
            .starts_with("participant_id\tparticipant\thandedness"));
  const fs::path run =
      out / "sub-P01/ses-1/motion/sub-P01_ses-1_task-single_tracksys-stylus_run-003_motion.tsv";
  CHECK(path_exists(run));
  CHECK(text_of_file(out / "phenotype/closing_session_1.tsv") ==
        "participant_id\thard\nsub-P01\t7\n");
  CHECK(text_of_file(out / "phenotype/closing_session_2.tsv") ==
        "participant_id\thard\nsub-P01\t5\n");
  const auto first_scan = [&](const char* file) { return text_of_file(out / file).substr(0, 200); };
  CHECK(contains(first_scan("sub-P01/ses-1/sub-P01_ses-1_scans.tsv"), "\t1920-01-01T00:00:00"));
  CHECK(contains(first_scan("sub-P01/ses-2/sub-P01_ses-2_scans.tsv"), "\t1920-01-09T00:00:00"));
  CHECK(contains(first_scan("sub-P02/ses-1/sub-P02_ses-1_scans.tsv"), "\t1920-01-01T00:00:00"));
}

TEST_CASE("Datasets have what people said, and what they typed only if that is wanted") {
  FakeStudy study({.simulated = false, .session = R"({"closing_questions": [
                    {"id": "How-hard", "kind": "number", "text": {"en": "How hard was it?"}},
                    {"id": "which", "kind": "choice", "text": {"en": "Which was best?"},
                     "options": [{"en": "rough"}, {"en": "smooth"}]}]})"});
  study.add(talkative("P01", 1, R"({"How-hard":7,"age":34,"remarks":"it is Anna's","which":1})"));
  study.add(talkative("P02", 2, R"({"which":0})"));
  study.add({.participant = "P03", .enrolment = 3});
  study.close_and_unblind();
  const OpenStudy open(study);
  analysis::DatasetOptions options{.consents = {{.participant = "P01", .consent_version = "2"}}};
  const fs::path bids = study.folder() / "bids";
  const fs::path psych = study.folder() / "psych";
  analysis::export_bids(open.source, options, bids);
  analysis::export_psych_ds(open.source, options, psych);
  CHECK(bids_faults(bids) == kNoFaults);
  CHECK(psych_ds_faults(psych) == kNoFaults);
  CHECK(text_of_file(bids / "phenotype/closing.tsv") ==
        "participant_id\thow_hard\twhich\nsub-P01\t7\t1\nsub-P02\tn/a\t0\n");
  const auto sidecar = nlohmann::json::parse(text_of_file(bids / "phenotype/closing.json"));
  CHECK(sidecar["how_hard"]["Description"] == "How hard was it?");
  CHECK(sidecar["which"]["Levels"]["1"] == "smooth");
  CHECK(path_exists(bids / "phenotype/handedness.tsv"));
  const std::string events = text_of_file(bids / "sub-P01/beh/sub-P01_task-single_events.tsv");
  CHECK(
      events.starts_with("onset\tduration\tincident\ttrial\tcode\tsafety_fault\tdevice_fault\n"
                         "0.02\tn/a\tpaused\tn/a"));
  CHECK(contains(events, "1.5\tn/a\tinterrupted\t1\tcomfort stop"));
  CHECK_FALSE(path_exists(bids / "sub-P03/beh/sub-P03_task-single_events.tsv"));
  const std::string people = text_of_file(bids / "participants.tsv");
  CHECK(contains(people, "interruptions\tpauses"));
  CHECK(contains(people, "consent_version"));
  for (const fs::path& folder : {bids, psych}) {
    for (const auto& [name, text] : contents(folder)) {
      INFO(name);
      for (const char* words : {"Anna", "phone", "wears"}) {
        CHECK_FALSE(contains(text, words));
      }
    }
  }
  options.free_text = analysis::FreeText::shown;
  analysis::export_bids(open.source, options, bids);
  analysis::export_psych_ds(open.source, options, psych);
  CHECK(bids_faults(bids) == kNoFaults);
  CHECK(psych_ds_faults(psych) == kNoFaults);
  CHECK(contains(text_of_file(bids / "phenotype/closing.tsv"), "it is Anna's"));
  CHECK(
      contains(text_of_file(bids / "sub-P01/beh/sub-P01_task-single_events.tsv"), "a phone rang"));
  CHECK(contains(text_of_file(psych / "data/study-single_description-answers_data.csv"), "Anna"));
}

TEST_CASE("Before unblinding datasets have no word of what was presented or answered") {
  FakeStudy study(study::identification::comparison(), {.label = "petrified wood"});
  fill(study);
  const analysis::DatasetSource source{study.store()};
  const fs::path bids = study.folder() / "bids";
  const fs::path psych = study.folder() / "psych";
  analysis::export_bids(source, {.database = study.database()}, bids);
  analysis::export_psych_ds(source, {}, psych);
  CHECK(bids_faults(bids) == kNoFaults);
  CHECK(psych_ds_faults(psych) == kNoFaults);
  for (const fs::path& folder : {bids, psych}) {
    for (const auto& [name, text] : contents(folder)) {
      INFO(name);
      if (name == "sourcedata/study.db") continue;  // other tests check what a database reveals
      for (const char* secret : {"petrified", "cloth", "straw", "tv-gabor", "trial_type"}) {
        CHECK_FALSE(contains(text, secret));
      }
    }
  }
  CHECK_THROWS_AS(analysis::export_bids(source, {.traces = true}, bids), UsageError);
  CHECK_THROWS_AS(analysis::export_bids(source, {.stimuli = true}, bids), UsageError);
}

TEST_CASE("A study as Psych-DS keeps to the schema") {
  FakeStudy study(study::identification::comparison(),
                  {.label = "bark, \"old\"", .trials = R"({"lead_in": 1, "catch": 1})"});
  fill(study);
  study.store().withdraw(3, milliseconds(900), "asked to");
  study.close_and_unblind();
  const fs::path out = study.folder() / "psych";
  analysis::export_psych_ds(OpenStudy(study).source, {.authors = {"A. Author"}, .license = "CC0"},
                            out);
  CHECK(psych_ds_faults(out) == kNoFaults);
  for (const auto& [name, text] : contents(out)) CHECK_FALSE(contains(text, "P03"));
  const std::string description = text_of_file(out / "dataset_description.json");
  CHECK(contains(description, "SIMULATED"));
}

TEST_CASE("A dataset names the program that exported it, and the one that recorded it") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const OpenStudy open(study);
  const fs::path bids = study.folder() / "bids";
  const fs::path psych = study.folder() / "psych";
  analysis::export_bids(open.source, {}, bids);
  analysis::export_psych_ds(open.source, {}, psych);
  const std::string exporter(program_version());
  for (const fs::path& folder : {bids, bids / "derivatives/touchtrial"}) {
    const auto description =
        nlohmann::json::parse(text_of_file(folder / "dataset_description.json"));
    CHECK(description["GeneratedBy"][0]["Version"] == exporter);
  }
  CHECK(names(text_of_file(psych / "CHANGES.md"), exporter));
  const std::string recorder =
      "recorded with Touchtrial " + open.source.store.commitment().program_version;
  CHECK(contains(text_of_file(bids / "README"), recorder));
  CHECK(contains(text_of_file(psych / "README.md"), recorder));
}

TEST_CASE("The checkers of datasets find what is wrong") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.close_and_unblind();
  const OpenStudy open(study);
  const fs::path bids = study.folder() / "bids";
  const fs::path psych = study.folder() / "psych";
  analysis::export_bids(open.source, {.traces = true}, bids);
  analysis::export_psych_ds(open.source, {}, psych);
  const auto spoilt = [](const fs::path& file, const std::string& text, const auto& faults_of) {
    const std::string before = text_of_file(file);
    replace_file(file, text);
    const bool found = !faults_of(file).empty();
    replace_file(file, before);
    return found;
  };
  const auto in_bids = [&](const fs::path&) { return bids_faults(bids); };
  const auto in_psych = [&](const fs::path&) { return psych_ds_faults(psych); };
  const fs::path trials = bids / "sub-P03/beh/sub-P03_task-single_beh.tsv";
  CHECK(spoilt(trials, text_of_file(trials) + "1\t2\n", in_bids));
  CHECK(spoilt(trials, "colour\nred\n", in_bids));
  CHECK(spoilt(trials, "stim_file\nnone.png\n", in_bids));
  CHECK(spoilt(bids / "participants.tsv", "participant_id\nsub-other\n", in_bids));
  CHECK(spoilt(bids / "task-single_beh.json", "{}", in_bids));
  CHECK(spoilt(bids / "README", "short", in_bids));
  const fs::path motion = bids / "sub-P03/motion";
  const fs::path run = motion / "sub-P03_task-single_tracksys-stylus_run-001_motion.tsv";
  const std::string rows = text_of_file(run);
  CHECK(spoilt(run, "latency\tx\ty\tz\tforce_x\tforce_y\tforce_z\n" + rows, in_bids));
  CHECK(spoilt(run, "0\t1\t2\n", in_bids));
  CHECK(spoilt(run, "0.5\t0\t0\t0\t0\t0\t0\n", in_bids));
  CHECK(spoilt(run, "0\t0\t0\t0\t0\t0\t0\n1e-3\t0\t0\t0\t0\t0\t0\n", in_bids));
  const fs::path channels = bids / "task-single_channels.tsv";
  const std::string names = text_of_file(channels);
  CHECK(spoilt(channels, std::regex_replace(names, std::regex("POS"), "pos"), in_bids));
  CHECK(spoilt(channels, std::regex_replace(names, std::regex("MISC"), "VEL"), in_bids));
  CHECK(spoilt(channels,
               std::regex_replace(names, std::regex("name\tcomponent"), "component\tname"),
               in_bids));
  CHECK(spoilt(bids / "task-single_channels.json", "{}", in_bids));
  const fs::path sidecar = motion / "sub-P03_task-single_tracksys-stylus_run-001_motion.json";
  CHECK(spoilt(sidecar, R"({"TaskName": "single"})", in_bids));
  CHECK(spoilt(bids / "sub-P03/sub-P03_scans.tsv", "filename\tacq_time\n", in_bids));
  const fs::path second = bids / "task-single_tracksys-stylus_events.json";
  replace_file(second, "{}");
  CHECK_FALSE(bids_faults(bids).empty());
  fs::remove(second);
  REQUIRE(bids_faults(bids) == kNoFaults);
  replace_file(bids / "stray.tsv", "a\n1\n");
  CHECK_FALSE(bids_faults(bids).empty());
  const fs::path table = psych / "data/study-single_description-trials_data.csv";
  CHECK(spoilt(table, "colour\nred\n", in_psych));
  CHECK(spoilt(psych / "dataset_description.json", "{}", in_psych));
  replace_file(psych / "data/notes.csv", "a\n1\n");
  CHECK_FALSE(psych_ds_faults(psych).empty());
}

}  // namespace touchtrial
