#include "analysis/verification/verification.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/verification/study_files.hpp"
#include "attacks/forger.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>

#include <SQLiteCpp/Database.h>
#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace analysis;

const Check& check_of(const Verification& verification, const std::string& name) {
  const auto found = std::find_if(verification.checks.begin(), verification.checks.end(),
                                  [&](const Check& check) { return check.name == name; });
  REQUIRE(found != verification.checks.end());
  return *found;
}

void flip_last_byte(const std::filesystem::path& path) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(-1, std::ios::end);
  const char last = static_cast<char>(file.peek());
  file.seekp(-1, std::ios::end);
  file.put(static_cast<char>(last ^ 1));
}

}  // namespace

TEST_CASE("a clock that went back is noted with its place, and is no fault") {
  using namespace std::chrono_literals;
  for (const bool simulated : {false, true}) {
    FakeStudy study(study::identification::comparison(), {.simulated = simulated});
    study.add({.participant = "P01", .enrolment = 1});
    const record::Event last = study.store().events(0).back();
    study.store().note(1, last.at + 2h, "", "before the clock is set");
    study.store().note(1, last.at + 1h, "", "after it");
    study.store().note(1, last.at + 1h - 1s, "", "by another program at once");
    const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
    CHECK(verification.holds());
    const QualityReport quality = make_quality(study.store());
    CHECK(verification.notes == quality.notes);
    REQUIRE(verification.notes.size() == (simulated ? 0 : 1));
    if (simulated) continue;
    const std::string place = "the file's chain, event " + std::to_string(last.sequence + 2);
    CHECK(names(verification.notes[0], place + " 3600"));
    CHECK(names(verification_text(verification), place));
    const auto object = nlohmann::json::parse(verification_json(verification));
    CHECK(object.at("notes").size() == 1);
  }
}

TEST_CASE("verify_study passes every check of an untouched study") {
  FakeStudy study(study::identification::comparison(), {.with_pack = true});
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::confusing(0, 1)});
  const engine::Pack pack(study.pack_folder());
  const Verification verification = analysis::verify_study(study.store(), &study.key(), &pack);
  const std::vector<std::string> expected{"chain",         "key",      "seal",
                                          "configuration", "schedule", "responses",
                                          "payloads",      "traces",   "pack"};
  REQUIRE(verification.checks.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO(verification.checks[i].detail);
    CHECK(verification.checks[i].name == expected[i]);
    CHECK(verification.checks[i].state == CheckState::passed);
  }
  CHECK(verification.holds());
  CHECK(names(check_of(verification, "traces").detail, "48"));
}

TEST_CASE("verify_study without key and pack says what it did not check") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  const Verification verification = analysis::verify_study(study.store(), nullptr, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  for (const char* name :
       {"seal", "configuration", "schedule", "responses", "payloads", "traces", "pack"}) {
    CHECK(check_of(verification, name).state == CheckState::not_checked);
  }
  CHECK(verification.holds());
}

TEST_CASE("verify_study finds a key of another study") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  SeededEntropy entropy(99);
  const study::StudyKey foreign = study::make_study_key(study.key().study, entropy, true);
  const Verification verification = analysis::verify_study(study.store(), &foreign, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  CHECK(check_of(verification, "key").state == CheckState::failed);
  // What a key of another study does not open is no damage.
  for (const char* name : {"seal", "configuration", "schedule", "payloads", "traces"}) {
    CHECK(check_of(verification, name).state == CheckState::not_checked);
  }
  CHECK_FALSE(verification.holds());
}

TEST_CASE("verify_study finds a key whose study was changed after the first trial") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  study::Study other = study.key().study;
  other.classes.front().label = "bark, renamed";
  const study::StudyKey changed = study::rekeyed(study.key(), other);
  const Verification verification = analysis::verify_study(study.store(), &changed, nullptr);
  CHECK(check_of(verification, "seal").state == CheckState::failed);
  CHECK(check_of(verification, "configuration").state == CheckState::failed);
  CHECK(check_of(verification, "schedule").state == CheckState::failed);
}

TEST_CASE("verify_study finds a session whose schedule its enrolment number does not get") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  study::StudyKey other = study.key();
  other.stations.front().secret[0] ^= 1U;
  const Verification verification = analysis::verify_study(study.store(), &other, nullptr);
  CHECK(check_of(verification, "seal").state == CheckState::passed);
  CHECK(check_of(verification, "schedule").state == CheckState::failed);
  CHECK(names(check_of(verification, "schedule").detail, "1"));
}

TEST_CASE("verify_study names the first broken link") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2});
  {
    SQLite::Database database(study.database().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TRIGGER events_no_update");
    database.exec(
        "UPDATE events SET at_ns = at_ns + 1 WHERE session = 2 AND kind = 'answered' "
        "AND body LIKE '%\"trial\":3}'");
  }
  const Verification verification = analysis::verify_study(study.store(), nullptr, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::failed);
  // The opening, four events of each trial before, and two of this one.
  CHECK(names(check_of(verification, "chain").detail, "2 11"));
  CHECK_FALSE(verification.holds());
}

TEST_CASE("verify_study finds a field that is not what was prepared") {
  FakeStudy study({.with_pack = true});
  study.add({.participant = "P01"});
  const std::string code = study.key().stimuli[1].code;
  flip_last_byte(study.pack_folder() / (code + ".field"));
  const engine::Pack pack(study.pack_folder());
  const Verification verification = analysis::verify_study(study.store(), nullptr, &pack);
  CHECK(check_of(verification, "pack").state == CheckState::failed);
  CHECK(contains(check_of(verification, "pack").detail, code));
}

TEST_CASE("verify_study finds a pack that was exchanged as a whole") {
  FakeStudy study({.with_pack = true});
  engine::PackManifest manifest = engine::Pack(study.pack_folder()).manifest();
  manifest.entries.front().gains.normal_n *= 2.0;
  engine::write_manifest(study.pack_folder(), manifest);
  const engine::Pack stronger(study.pack_folder());
  CHECK(check_of(analysis::verify_study(study.store(), nullptr, &stronger), "pack").state ==
        CheckState::failed);
}

TEST_CASE("A verification says the same in JSON and in text") {
  FakeStudy study(study::identification::classification());
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  const auto json = nlohmann::json::parse(verification_json(verification));
  CHECK(json["stamp"] == "SIMULATED");
  CHECK(json["holds"] == true);
  CHECK(json["checks"].size() == 9);
  CHECK(json["checks"][0]["name"] == "chain");
  CHECK(json["checks"][0]["state"] == "passed");
  CHECK(json["checks"][8]["state"] == "not-checked");
  const std::string text = verification_text(verification);
  CHECK(text.starts_with("SIMULATED"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 13);
  CHECK(json["complete"] == false);
  CHECK(names(text, "1 9 pack"));
  CHECK(json["head"]["length"] == 1);
  CHECK(contains(text, json["head"]["hash"].get<std::string>()));
}

TEST_CASE("verify_study finds a head that is no longer on the file's chain") {
  FakeStudy study(study::identification::classification());
  const record::ChainHead before = study.store().file_head();
  study.add({.participant = "P01"});
  const Verification kept =
      analysis::verify_study(study.store(), nullptr, nullptr, to_hex(before.hash).substr(0, 16));
  CHECK(check_of(kept, "head").state == CheckState::passed);
  CHECK(kept.head->length == 3);
  const Verification cut =
      analysis::verify_study(study.store(), nullptr, nullptr, to_hex(Digest{1}));
  CHECK(check_of(cut, "head").state == CheckState::failed);
}

TEST_CASE("verify_study with the key finds a chain that was rebuilt and signed without it") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  attacks::Forgery forged(study.database());
  attacks::set(forged.first(1, record::EventKind::answered), "forged", "1");
  const Signer station = study::station_key(study.key(), study::kOnlyStation).signer();
  forged.relink(&station);
  forged.write();
  CHECK(analysis::verify_study(study.store(), nullptr, nullptr).holds());
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  CHECK(check_of(verification, "payloads").state == CheckState::failed);
  CHECK_FALSE(check_of(verification, "payloads").detail.empty());
}

TEST_CASE("verify_study with the key opens each trace and counts its samples") {
  using namespace std::chrono_literals;
  enum class Fault { none, samples, key };
  const Fault fault = GENERATE(Fault::none, Fault::samples, Fault::key);
  record::Trace trace;
  trace.samples.resize(5);
  const auto record_trial = [&](record::SessionRecorder& recorder) {
    recorder.presented(1s, 1, 0);
    record::TrialEvidence evidence =
        recorder.pack_evidence({.trial = 1, .rate_hz = 1000.0}, {}, trace);
    if (fault == Fault::samples) evidence.body.samples = 6;
    if (fault == Fault::key) {
      evidence.trace = record::seal_trace(1, 1, trace, SecretKey{});
      evidence.body.trace = blake2b(evidence.trace.box);
    }
    recorder.timed_out(2s, 1, evidence);
  };
  FakeStudy study(study::identification::classification());
  study.add(
      {.participant = "P01", .complete = false, .stop_after = 0, .before_trials = record_trial});
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  const Check& traces = check_of(verification, "traces");
  INFO(traces.detail);
  CHECK(traces.state == (fault == Fault::none ? CheckState::passed : CheckState::failed));
  CHECK(names(traces.detail, fault == Fault::none ? "1" : "1 1"));
}

TEST_CASE("verify_files makes a damaged key and a missing pack findings") {
  FakeStudy study({.with_pack = true});
  const auto key_path = study.folder() / "study.db.key";
  StudyFiles files{.database = study.database(), .key = key_path, .key_named = false, .pack = {}};
  CHECK(check_of(verify_files(files, {}), "key").state == CheckState::not_checked);
  study::StudyKey key = study.key();
  key.pack_folder = study.folder() / "gone.pack";
  study::save_study_key(key_path, key);
  const Verification absent = verify_files(files, {});
  CHECK(check_of(absent, "key").state == CheckState::passed);
  CHECK(check_of(absent, "pack").state == CheckState::not_checked);
  CHECK(contains(check_of(absent, "pack").detail, "gone.pack"));
  files.pack = key.pack_folder;
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::failed);
  flip_last_byte(key_path);
  const Verification damaged = verify_files(files, {});
  CHECK(check_of(damaged, "chain").state == CheckState::passed);
  CHECK(check_of(damaged, "key").state == CheckState::failed);
  CHECK(check_of(damaged, "seal").state == CheckState::not_checked);
}

TEST_CASE("verify_files finds the pack beside the database when the key lies elsewhere") {
  FakeStudy study({.with_pack = true});
  const TempFolder stick;
  study::StudyKey key = study.key();
  key.pack_folder = stick.path() / study.pack_folder().filename();
  const auto key_path = stick.path() / "study.key";
  study::save_study_key(key_path, key);
  const StudyFiles files{
      .database = study.database(), .key = key_path, .key_named = true, .pack = {}};
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::passed);
  // Another study's pack of that name is not taken for this one's.
  engine::PackManifest manifest = engine::Pack(study.pack_folder()).manifest();
  manifest.study_id = std::string(32, '0');
  engine::write_manifest(study.pack_folder(), manifest);
  const Verification other = verify_files(files, {});
  CHECK(check_of(other, "pack").state == CheckState::not_checked);
  CHECK_FALSE(check_of(other, "pack").detail.empty());
}

TEST_CASE("verify_files compares a rebuilt pack with the study only if the pack is named") {
  FakeStudy study({.with_pack = true});
  engine::PackManifest manifest = engine::Pack(study.pack_folder()).manifest();
  manifest.study_id = std::string(32, '0');
  engine::write_manifest(study.pack_folder(), manifest);
  study::StudyKey key = study.key();
  key.pack_folder = study.pack_folder();
  const auto key_path = study.folder() / "study.db.key";
  study::save_study_key(key_path, key);
  StudyFiles files{.database = study.database(), .key = key_path, .key_named = false, .pack = {}};
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::not_checked);
  files.pack = study.pack_folder();
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::failed);
}

TEST_CASE("verify_files makes a dropped table and a missing first event findings") {
  for (const char* sql : {"DROP TABLE traces",
                          "DROP TRIGGER events_no_delete; DELETE FROM events WHERE session = 0"}) {
    FakeStudy study(study::identification::classification());
    SQLite::Database(study.database().string(), SQLite::OPEN_READWRITE).exec(sql);
    const StudyFiles files{
        .database = study.database(), .key = study.folder() / "k", .key_named = false, .pack = {}};
    const Verification verification = verify_files(files, {});
    INFO(sql);
    CHECK(check_of(verification, "chain").state == CheckState::failed);
    CHECK_FALSE(verification.holds());
  }
}

}  // namespace touchtrial
