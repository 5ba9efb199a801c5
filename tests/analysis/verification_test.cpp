#include "analysis/verification.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
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

}  // namespace

TEST_CASE("verify_study passes every check of an untouched study") {
  FakeStudy study(Protocol::comparison, {.with_pack = true});
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::confusing(0, 1)});
  const Pack pack(study.pack_folder());
  const Verification verification = verify_study(study.store(), &study.key(), &pack);
  const std::vector<std::string> names{"chain",     "seal",     "configuration", "schedule",
                                       "responses", "payloads", "traces",        "pack"};
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
  CHECK(json["checks"].size() == 8);
  CHECK(json["checks"][0]["name"] == "chain");
  CHECK(json["checks"][0]["state"] == "passed");
  CHECK(json["checks"][7]["state"] == "not-checked");
  const std::string text = verification_text(verification);
  CHECK(text.starts_with("SIMULATED"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 9);
}

}  // namespace touchtrial
