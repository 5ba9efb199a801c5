#include "analysis/verification/verification.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/verification/study_files.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <fstream>

#include <SQLiteCpp/Database.h>
#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

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

void store_hashes(SQLite::Database& database, const Event& event) {
  SQLite::Statement update(database,
                           "UPDATE events SET body = ?, previous = ?, hash = ? "
                           "WHERE session = ? AND sequence = ?");
  update.bind(1, event.body);
  update.bind(2, event.previous.data(), static_cast<int>(event.previous.size()));
  update.bind(3, event.hash.data(), static_cast<int>(event.hash.size()));
  update.bind(4, event.session);
  update.bind(5, static_cast<std::int64_t>(event.sequence));
  update.exec();
}

/// Alters every answer and computes all hashes anew, the file's chain included, as somebody without
/// the key could.
void forge_answers(const std::filesystem::path& path) {
  StudyStore store = StudyStore::open(path, StudyStore::Access::read_write);
  std::vector<Event> chain = store.events(1);
  std::vector<Event> file = store.events(0);
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
  const std::string trigger =
      database.execAndGet("SELECT sql FROM sqlite_schema WHERE name = 'events_no_update'")
          .getString();
  database.exec("DROP TRIGGER events_no_update");
  Digest previous{};
  for (Event& event : chain) {
    if (event.kind == EventKind::answered) event.body.insert(1, "\"forged\":1,");
    event.previous = previous;
    previous = event.hash = event_hash(event);
    store_hashes(database, event);
  }
  previous = {};
  for (Event& event : file) {
    if (event.kind == EventKind::session_closed) {
      auto body = nlohmann::json::parse(event.body);
      body["head"] = to_hex(chain.back().hash);
      event.body = body.dump();
    }
    event.previous = previous;
    previous = event.hash = event_hash(event);
    store_hashes(database, event);
  }
  database.exec(trigger);
}

}  // namespace

TEST_CASE("verify_study passes every check of an untouched study") {
  FakeStudy study(Protocol::comparison, {.with_pack = true});
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::confusing(0, 1)});
  const Pack pack(study.pack_folder());
  const Verification verification = verify_study(study.store(), &study.key(), &pack);
  const std::vector<std::string> names{"chain",         "key",      "seal",
                                       "configuration", "schedule", "responses",
                                       "payloads",      "traces",   "pack"};
  REQUIRE(verification.checks.size() == names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    INFO(verification.checks[i].detail);
    CHECK(verification.checks[i].name == names[i]);
    CHECK(verification.checks[i].state == CheckState::passed);
  }
  CHECK(verification.holds());
  CHECK(contains(check_of(verification, "traces").detail, "48 traces"));
}

TEST_CASE("verify_study without key and pack says what it did not check") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  const Verification verification = verify_study(study.store(), nullptr, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  CHECK(check_of(verification, "responses").state == CheckState::passed);
  for (const char* name : {"seal", "configuration", "schedule", "payloads", "traces", "pack"}) {
    CHECK(check_of(verification, name).state == CheckState::not_checked);
  }
  CHECK(verification.holds());
}

TEST_CASE("verify_study finds a key of another study") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  SeededEntropy entropy(99);
  const StudyKey foreign = make_study_key(study.key().study, entropy, true);
  const Verification verification = verify_study(study.store(), &foreign, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  for (const char* name : {"seal", "configuration", "schedule", "payloads", "traces"}) {
    CHECK(check_of(verification, name).state == CheckState::failed);
  }
  CHECK_FALSE(verification.holds());
}

TEST_CASE("verify_study finds a key whose study was changed after the first trial") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  Study other = study.key().study;
  other.seed += 1;
  const StudyKey changed = rekeyed(study.key(), other);
  const Verification verification = verify_study(study.store(), &changed, nullptr);
  CHECK(check_of(verification, "seal").state == CheckState::failed);
  CHECK(check_of(verification, "configuration").state == CheckState::passed);
  CHECK(check_of(verification, "schedule").state == CheckState::failed);
  CHECK(contains(check_of(verification, "schedule").detail, "session 1"));
}

TEST_CASE("verify_study names the first broken link") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::always_right()});
  {
    SQLite::Database database(study.database().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TRIGGER events_no_update");
    database.exec(
        "UPDATE events SET at_ns = at_ns + 1 WHERE session = 2 AND kind = 'answered' "
        "AND body LIKE '%\"trial\":3}'");
  }
  const Verification verification = verify_study(study.store(), nullptr, nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::failed);
  // The opening, four events of each trial before, and two of this one.
  CHECK(contains(check_of(verification, "chain").detail, "session 2, event 11:"));
  CHECK_FALSE(verification.holds());
}

TEST_CASE("verify_study finds a field that is not what was prepared") {
  FakeStudy study(Protocol::classification, {.with_pack = true});
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  const std::string code = study.key().stimuli[1].code;
  flip_last_byte(study.pack_folder() / (code + ".field"));
  const Pack pack(study.pack_folder());
  const Verification verification = verify_study(study.store(), nullptr, &pack);
  CHECK(check_of(verification, "pack").state == CheckState::failed);
  CHECK(contains(check_of(verification, "pack").detail, code));
}

TEST_CASE("verify_study finds a pack that was exchanged as a whole") {
  FakeStudy study(Protocol::classification, {.with_pack = true});
  PackManifest manifest = Pack(study.pack_folder()).manifest();
  manifest.entries.front().gains.normal_n *= 2.0;
  write_manifest(study.pack_folder(), manifest);
  const Pack stronger(study.pack_folder());
  CHECK(check_of(verify_study(study.store(), nullptr, &stronger), "pack").state ==
        CheckState::failed);
}

TEST_CASE("A verification says the same in JSON and in text") {
  FakeStudy study(Protocol::classification);
  const Verification verification = verify_study(study.store(), &study.key(), nullptr);
  const auto json = nlohmann::json::parse(verification_json(verification));
  CHECK(json["stamp"] == "SIMULATED");
  CHECK(json["holds"] == true);
  CHECK(json["checks"].size() == 9);
  CHECK(json["checks"][0]["name"] == "chain");
  CHECK(json["checks"][0]["state"] == "passed");
  CHECK(json["checks"][8]["state"] == "not-checked");
  const std::string text = verification_text(verification);
  CHECK(text.starts_with("SIMULATED"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 12);
  CHECK(json["complete"] == false);
  CHECK(contains(text, "1 of 9 checks not made: pack\n"));
  CHECK(json["head"]["length"] == 1);
  CHECK(contains(text, json["head"]["hash"].get<std::string>()));
}

TEST_CASE("verify_study finds a head that is no longer on the file's chain") {
  FakeStudy study(Protocol::classification);
  const ChainHead before = study.store().file_head();
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  const Verification kept = verify_study(study.store(), nullptr, nullptr, before.hash);
  CHECK(check_of(kept, "head").state == CheckState::passed);
  CHECK(kept.head->length == 3);
  const Verification cut = verify_study(study.store(), nullptr, nullptr, Digest{1});
  CHECK(check_of(cut, "head").state == CheckState::failed);
}

TEST_CASE("verify_study with the key finds a chain that was made anew without it") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  forge_answers(study.database());
  CHECK(verify_study(study.store(), nullptr, nullptr).holds());
  const Verification verification = verify_study(study.store(), &study.key(), nullptr);
  CHECK(check_of(verification, "chain").state == CheckState::passed);
  CHECK(check_of(verification, "payloads").state == CheckState::failed);
  CHECK(contains(check_of(verification, "payloads").detail, "made anew without the key"));
}

TEST_CASE("verify_files makes a damaged key and a missing pack findings") {
  FakeStudy study(Protocol::classification, {.with_pack = true});
  const auto key_path = study.folder() / "study.db.key";
  StudyFiles files{.database = study.database(), .key = key_path, .key_named = false, .pack = {}};
  CHECK(check_of(verify_files(files, {}), "key").state == CheckState::not_checked);
  StudyKey key = study.key();
  key.pack_folder = study.folder() / "gone.pack";
  save_study_key(key_path, key);
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

TEST_CASE("verify_files holds a pack made anew against the study only if it is named") {
  FakeStudy study(Protocol::classification, {.with_pack = true});
  PackManifest manifest = Pack(study.pack_folder()).manifest();
  manifest.study_id = std::string(32, '0');
  write_manifest(study.pack_folder(), manifest);
  StudyKey key = study.key();
  key.pack_folder = study.pack_folder();
  const auto key_path = study.folder() / "study.db.key";
  save_study_key(key_path, key);
  StudyFiles files{.database = study.database(), .key = key_path, .key_named = false, .pack = {}};
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::not_checked);
  files.pack = study.pack_folder();
  CHECK(check_of(verify_files(files, {}), "pack").state == CheckState::failed);
}

TEST_CASE("verify_files makes a dropped table and a missing first event findings") {
  for (const char* sql : {"DROP TABLE responses",
                          "DROP TRIGGER events_no_delete; DELETE FROM events WHERE session = 0"}) {
    FakeStudy study(Protocol::classification);
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
