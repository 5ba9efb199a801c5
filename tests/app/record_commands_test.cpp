// The commands that record something beside the sessions: consent, exclude, replace, withdraw,
// note.
#include "app/study_folder.hpp"
#include "core/cipher.hpp"
#include "record/payload_json.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"
#include "study/deviation_codes.hpp"
#include "study/study_key.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>

using namespace touchtrial;
using namespace touchtrial::study;
using namespace touchtrial::record;

namespace {

/// A blind study of four simulated participants, P001 to P004, in `study.db`.
struct PeopleStudy : StudyFolder {
  PeopleStudy() { succeeded(simulate("study.db", {"--keep-blind"})); }

  [[nodiscard]] fs::path database() const { return path() / "study.db"; }

  /// `COMMAND study.db --participant ID ...`
  /// \param line  "COMMAND ID ..."
  [[nodiscard]] ProgramResult people(const std::string& line,
                                     std::vector<std::string> more = {}) const {
    const std::size_t id = line.find(' ');
    const std::string command = line.substr(0, id);
    if (command == "withdraw" || command == "unblind") more.emplace_back("--yes");
    return type(command + " @study.db --participant" + line.substr(id), more);
  }
  void put_person(const std::string& participant, const std::string& contact) const {
    PersonalData(personal_data_path(database()))
        .put({.participant = participant,
              .consent_version = "3",
              .consented_utc = "2026-01-02T03:04:05Z",
              .age = 30,
              .gender = "",
              .contact = contact});
  }
  [[nodiscard]] StudyStore store() const {
    return StudyStore::open(database(), StudyStore::Access::read_only);
  }
  [[nodiscard]] json quality() const { return printed("report @study.db --json"); }
  [[nodiscard]] json outcomes() const {
    done("close @study.db --yes");
    done("unblind @study.db --reason test --yes");
    return quality();
  }
};

/// Checks that there are as many answers as trials, and that all checks of `verify` pass.
void check_verified(const PeopleStudy& study) {
  CHECK(study.printed("verify @study.db --json").at("complete") == true);
}

SessionRow session_of(const StudyStore& store, const std::string& participant) {
  return store.sessions_of(participant).at(0);
}

StudyKey key_of(const PeopleStudy& study) {
  return load_study_key(study.path() / "study.db.key");
}

/// The files in and below the study's folder that contain these bytes.
std::set<std::string> files_with(const PeopleStudy& study, ByteView bytes) {
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(study.path())) {
    if (!entry.is_regular_file()) continue;
    const Bytes file = read_file(entry.path());
    if (std::search(file.begin(), file.end(), bytes.begin(), bytes.end()) != file.end()) {
      found.insert(entry.path().filename().string());
    }
  }
  return found;
}

/// The number of a session's sealed event parts and traces that a key opens.
struct Opened {
  int parts = 0;
  int questionnaires = 0;
  int traces = 0;
};

Opened opened_by(const StudyStore& store, int session, const SecretKey& key) {
  Opened opened;
  for (const Event& event : store.events(session)) {
    if (!event.sealed.empty() && unsealed(event, key)) {
      ++opened.parts;
      if (event.kind == EventKind::questioned) ++opened.questionnaires;
    }
    if (event.kind != EventKind::trace_stored) continue;
    const auto body = json::parse(event.body);
    const int trial = body.at("trial");
    const auto box = store.sealed_trace(session, trial);
    if (box && unsealed_trace(*box, key)) ++opened.traces;
  }
  return opened;
}

TEST_CASE("consent is recorded in a file of its own that only its owner may read") {
  const ProgramFolder folder;
  succeeded(folder.type("consent @study.db --participant P07 --version 2026-03 --details -", {},
                        "age: 34\n\ngender:  woman \n"));
  const fs::path file = personal_data_path(folder.in("study.db"));
  CHECK((fs::status(file).permissions() & fs::perms(0777)) == fs::perms(0600));
  const auto record = PersonalData(file).find("P07");
  REQUIRE(record);
  CHECK(record->consent_version == "2026-03");
  CHECK(record->age == 34);
  CHECK(record->gender == "woman");
  CHECK(record->contact.empty());
  CHECK_FALSE(fs::exists(folder.in("study.db")));
}

TEST_CASE("every consent is kept, and an id that may be mistyped is asked about") {
  const ProgramFolder folder;
  const auto consent = [&](const std::string& options, const std::string& input = "") {
    return folder.type("consent @study.db " + options, {}, input);
  };
  succeeded(
      consent("--participant P07 --version 1 --details -", "age: 34\ncontact: ann@example.org\n"));
  const ProgramResult again = succeeded(consent("--participant P07 --version 2"));
  CHECK_THAT(again.output, holds_text(" 1 of 20"));
  const PersonalData kept(personal_data_path(folder.in("study.db")));
  const auto record = kept.find("P07");
  REQUIRE(record);
  CHECK(record->consent_version == "2");
  CHECK(record->age == 34);
  CHECK(record->contact == "ann@example.org");
  const std::vector<PersonalRecord> all = kept.all();
  REQUIRE(all.size() == 2);
  CHECK(all[0].consent_version == "1");
  CHECK(all[0].age == 34);
  CHECK_FALSE(all[1].age);

  // The next in the row is nobody's slip; other capitals, zeros and swapped digits may be one.
  succeeded(consent("--participant P08 --version 2"));
  for (const std::string id : {"p07", "P7", "P007", "P70", "PP07", "O07"}) {
    check_refused(consent("--version 2 --participant " + id), 2, {id, "P07", "--yes"});
  }
  succeeded(consent("--participant P70 --version 2 --yes"));
  check_refused(consent("--version 2"), 2, {"--participant"});
}

TEST_CASE("consent refuses details that it cannot read") {
  const ProgramFolder folder;
  const auto [input, words] = GENERATE(
      table<std::string, std::vector<std::string>>({{"", {}},
                                                    {"age: 34\nphone: 12345\n", {"2 contact"}},
                                                    {"age: 34\nage: 35\n", {"2"}},
                                                    {"age: old\n", {"age 0 130"}},
                                                    {"age: 131\n", {"age 0 130"}}}));
  check_refused(
      folder.type("consent @study.db --participant P07 --version 1 --details -", {}, input), 2,
      words);
  CHECK_FALSE(fs::exists(personal_data_path(folder.in("study.db"))));
}

TEST_CASE("a limit on the size of files ends a command in one line, and the database holds") {
  const PeopleStudy study;
  const std::vector<std::string> note = {"note", study.in("study.db"), "--participant", "P001",
                                         std::string(20'000, 'x')};
  const ProgramResult limited = run_touchtrial_limited(study.path(), "-f 8", note);
  INFO(limited.errors);
  CHECK(limited.exit_code == 1);  // not -1: no signal ended it
  CHECK(line_count(limited.errors) == 1);
  CHECK(limited.errors.find("study.db") != std::string::npos);
  check_verified(study);
  succeeded(run_touchtrial(study.path(), note));
}

TEST_CASE("a closed output pipe ends a command silently, as shells expect") {
  const PeopleStudy study;
  const ProgramResult closed = run_program(
      "/bin/sh", study.path(),
      {"-c",
       "{ while (echo x) 2>/dev/null; do :; done; \"$0\" verify \"$1\"; echo $? >&2; } | true",
       TOUCHTRIAL_PROGRAM, study.in("study.db")});
  INFO(closed.errors);
  CHECK(closed.errors.find("touchtrial") == std::string::npos);
  CHECK(closed.errors.ends_with("141\n"));  // 128 + SIGPIPE
  for (const std::string command : {"verify", "--version", "--help"}) {
    const ProgramResult full = run_program(
        "/bin/sh", study.path(),
        {"-c",
         "\"$0\" " + command + (command == "verify" ? " \"$1\"" : "") + " > /dev/full; echo $? >&2",
         TOUCHTRIAL_PROGRAM, study.in("study.db")});
    INFO(full.errors);
    CHECK_THAT(full.errors, holds_text("(No space left"));
    CHECK(full.errors.ends_with("\n1\n"));
  }
}

}  // namespace

TEST_CASE("an excluded participant is left out of outcomes, and the reason is recorded") {
  const PeopleStudy study;
  const ProgramResult excluded = succeeded(study.people("exclude P002 --reason 'fell asleep'"));
  CHECK(excluded.output.find("P002: excluded") != std::string::npos);
  CHECK(session_of(study.store(), "P002").excluded);
  CHECK(study.store().events(0).back().body.find("fell asleep") == std::string::npos);
  CHECK_FALSE(study.store().events(0).back().sealed.empty());
  CHECK(study.quality().at("participants") == 3);
  CHECK(study.quality().at("sessions").at("excluded") == 1);
  check_verified(study);

  check_refused(study.people("exclude P002 --reason again"), 1, {"study.db"});
  check_refused(study.people("exclude P9 --reason who"), 1, {"study.db", "P9"});
  check_refused(study.people("exclude P001 --reason ''"), 1, {"reason"});
  check_refused(study.people("exclude P001"), 2, {"--reason"});
  check_refused(study.type("exclude @none.db --participant P001 --reason gone"), 1,
                {"none.db", "[no-database]"});
  CHECK(study.outcomes().at("trials") == 3 * 6);
}

TEST_CASE("an exclusion after outcomes were seen is accepted only if that is recorded") {
  const PeopleStudy study;
  CHECK(study.outcomes().at("participants") == 4);
  check_refused(study.people("exclude P001 --reason 'bad figures'"), 1,
                {"P001", "--after-outcomes"});
  succeeded(study.people("exclude P001 --reason 'bad figures' --after-outcomes"));
  CHECK(from_json<ParticipantBody>(study.store().events(0).back().body).after_outcomes);
  CHECK(study.quality().at("participants") == 3);
}

TEST_CASE("a replacement inherits the participant's enrolment number and its schedule") {
  const PeopleStudy study;
  check_refused(study.people("replace P002 --with P021 --reason ill"), 1, {"P002", "complete"});
  succeeded(study.people("exclude P002 --reason ill"));
  check_refused(study.people("replace P002 --with P003 --reason ill"), 1, {"P003"});
  check_refused(study.people("replace P002 --with 'no id' --reason ill"), 1, {"'no id'"});
  check_refused(study.people("replace P9 --with P021 --reason ill"), 1, {"P9"});
  check_refused(study.people("replace P002 --reason ill"), 2, {"--with"});
  const ProgramResult replaced = succeeded(study.people("replace P002 --with P021 --reason ill"));
  CHECK(replaced.output.find("P021") != std::string::npos);
  check_refused(study.people("replace P002 --with P022 --reason ill"), 1, {"P002", "P021"});

  succeeded(study.session("P005"));
  succeeded(study.session("P021"));
  const StudyStore store = study.store();
  CHECK(session_of(store, "P005").enrolment == 5);
  CHECK(session_of(store, "P021").enrolment == 2);
  CHECK(session_of(store, "P002").replaced_by == "P021");
  check_verified(study);
  const json quality = study.quality();
  CHECK(quality.at("participants") == 5);
  CHECK(quality.at("sessions").at("completed") == 5);
  CHECK(quality.at("sessions").at("replaced") == 1);
  CHECK(quality.at("sessions").at("excluded") == 0);
  CHECK(study.outcomes().at("participants") == 5);
}

TEST_CASE(
    "a withdrawal with concurrent readers does what is possible, reports the rest, and can be "
    "completed") {
  const PeopleStudy study;
  const fs::path personal = personal_data_path(study.database());
  study.put_person("P001", "somebody@example.org");
  const Bytes wrapped =
      study.store().wrapped_key(session_of(study.store(), "P001").session).value();
  const std::vector<std::string> reason = {"--erase", "--reason", "asked to"};
  {
    SQLite::Database reader(study.in("study.db"), SQLite::OPEN_READONLY);
    reader.exec("BEGIN");
    static_cast<void>(reader.execAndGet("SELECT count(*) FROM participant_keys").getInt());
    check_refused(study.people("withdraw P001", reason), 1, {"P001"});
    CHECK_FALSE(PersonalData(personal).find("P001"));
    CHECK(files_with(study, bytes_of("somebody@example.org")).empty());
  }
  succeeded(study.people("withdraw P001", reason));
  CHECK(files_with(study, wrapped).empty());
  CHECK(session_of(study.store(), "P001").withdrawn);

  study.put_person("P002", "else@example.org");
  {
    SQLite::Database reader(personal.string(), SQLite::OPEN_READONLY);
    reader.exec("BEGIN");
    static_cast<void>(reader.execAndGet("SELECT count(*) FROM people").getInt());
    check_refused(study.people("withdraw P002", reason), 1, {"P002", ".personal"});
    CHECK(session_of(study.store(), "P002").withdrawn);
  }
  const ProgramResult finished = succeeded(study.people("withdraw P002", reason));
  CHECK(names(finished.output, "P002"));
  CHECK(files_with(study, bytes_of("else@example.org")).empty());
  check_verified(study);
}

TEST_CASE("a session that ends while others read says and records that its key is still there") {
  const PeopleStudy study;
  {
    SQLite::Database reader(study.in("study.db"), SQLite::OPEN_READONLY);
    reader.exec("BEGIN");
    static_cast<void>(reader.execAndGet("SELECT count(*) FROM station_keys").getInt());
    const ProgramResult ended = succeeded(study.session("P009"));
    CHECK_THAT(ended.errors, holds_text("touchtrial status"));
    const StudyStore store = study.store();
    const Event last = store.events(0).back();
    CHECK(last.kind == EventKind::participant_noted);
    CHECK(from_json<NoteBody>(last.body).code == "key-not-erased");
    CHECK(fs::file_size(study.in("study.db-wal")) > 0);
  }
  succeeded(study.type("status @study.db"));
  CHECK_FALSE(fs::exists(study.in("study.db-wal")));
  check_verified(study);
  const ProgramResult alone = succeeded(study.session("P010"));
  CHECK(alone.errors.find("another program") == std::string::npos);
  CHECK(study.store().events(0).back().kind == EventKind::session_closed);
}

TEST_CASE("a withdrawal prints and records what it could not erase") {
  const PeopleStudy study;
  const ProgramResult withdrawn = study.people("withdraw P001 --erase --reason 'asked to'");
  CHECK_THAT(withdrawn.output, holds_text("P001"));
  CHECK(withdrawn.output.find("`touchtrial sync`") != std::string::npos);
  const WithdrawalBody body = from_json<WithdrawalBody>(study.store().events(0).back().body);
  CHECK(body.kept == Retention::safety_record);
  CHECK_FALSE(body.not_erased.empty());
  CHECK(body.reason.empty());  // sealed
  check_refused(study.people("withdraw P002 --erase --reason ''"), 1, {"reason"});
  check_verified(study);
}

TEST_CASE("after a withdrawal, nobody can open the person's sealed data again") {
  const PeopleStudy study;
  succeeded(study.session("P005"));
  study.put_person("P005", "somebody@example.org");
  const study::StudyKey investigator = key_of(study);
  const int session = session_of(study.store(), "P005").session;
  const Bytes wrapped = study.store().wrapped_key(session).value();
  const SecretKey lost = unwrap_participant_key(investigator.box(), session, wrapped).value();
  const Opened before = opened_by(study.store(), session, lost);
  CHECK(before.parts >= 6);
  CHECK(before.questionnaires >= 1);
  CHECK(before.traces == 6);
  REQUIRE(files_with(study, wrapped).contains("study.db"));
  REQUIRE_FALSE(files_with(study, bytes_of("somebody@example.org")).empty());

  const ProgramResult withdrawn =
      succeeded(study.people("withdraw P005 --erase --reason 'asked to'"));
  CHECK(names(withdrawn.output, "P005"));

  // No part of the key is left, wrapped or not, in any file: database, log, index, backup, or pack.
  constexpr std::size_t kPart = 16;
  for (std::size_t at = 0; at + kPart <= wrapped.size(); at += kPart) {
    CHECK(files_with(study, ByteView(wrapped).subspan(at, kPart)).empty());
  }
  for (std::size_t at = 0; at < lost.size(); at += kPart) {
    CHECK(files_with(study, ByteView(lost).subspan(at, kPart)).empty());
  }
  CHECK(files_with(study, bytes_of("somebody@example.org")).empty());
  const StudyStore store = study.store();
  CHECK_FALSE(store.wrapped_key(session));
  CHECK(session_of(store, "P005").withdrawn);
  // The boxes are still there, because the chain needs them; nothing that is left opens one.
  CHECK(opened_by(store, session, lost).parts == before.parts);
  const SecretKey station = investigator.stations.front().secret;
  std::vector<SecretKey> left = {investigator.master, investigator.box().secret_half, station,
                                 derive_key(station, "participant keys")};
  for (const SessionRow& other : store.sessions()) {
    if (const auto key = store.wrapped_key(other.session)) {
      left.push_back(unwrap_participant_key(investigator.box(), other.session, *key).value());
    }
  }
  CHECK(left.size() == 4 + 4);
  for (const SecretKey& key : left) {
    const Opened now = opened_by(store, session, key);
    CHECK(now.parts == 0);
    CHECK(now.traces == 0);
  }
  check_verified(study);
  const json quality = study.quality();
  CHECK(quality.at("participants") == 4);
  CHECK(quality.at("sessions").at("withdrawn") == 1);
  CHECK(study.outcomes().at("trials") == 4 * 6);
}

TEST_CASE("a participant who withdrew can be replaced") {
  const PeopleStudy study;
  succeeded(study.people("withdraw P001 --erase --reason 'asked to'"));
  check_refused(study.people("withdraw P001 --erase --reason again"), 1, {"P001"});
  check_refused(study.people("withdraw P9 --erase --reason who"), 1, {"P9"});
  check_refused(study.people("withdraw P002"), 2, {"--reason", "--keep-data", "--erase"});
  check_refused(study.people("withdraw P002 --erase"), 2, {"--reason"});
  check_refused(study.people("withdraw P002 --reason 'asked to'"), 2, {"--keep-data", "--erase"});
  succeeded(study.people("replace P001 --with P031 --reason 'place is wanted'"));
  check_refused(study.session("P001"), 1, {"P001"});
  succeeded(study.session("P031"));
  CHECK(session_of(study.store(), "P031").enrolment == 1);
  check_verified(study);
  const json sessions = study.quality().at("sessions");
  CHECK(sessions.at("withdrawn") == 1);
  CHECK(sessions.at("replaced") == 0);
}

TEST_CASE(
    "a withdrawn participant whose data are kept stays in the report, and can be erased later") {
  const PeopleStudy study;
  const Bytes key = study.store().wrapped_key(session_of(study.store(), "P001").session).value();
  succeeded(study.people("withdraw P001 --keep-data --reason 'moves away'"));
  check_refused(study.people("withdraw P001 --keep-data --reason again"), 1, {"P001"});
  CHECK(study.quality().at("participants") == 4);
  CHECK(study.quality().at("collection").at("flow").at("withdrawn") == 1);
  CHECK(files_with(study, key).contains("study.db"));
  check_verified(study);
  succeeded(study.people("withdraw P001 --erase --reason 'asked to'"));
  CHECK(files_with(study, key).empty());
  check_refused(study.people("withdraw P001 --keep-data --reason again"), 1, {"P001"});
  CHECK(study.quality().at("participants") == 3);
  check_verified(study);
}

TEST_CASE("the safety record of an erased person is erased by a command of its own") {
  const PeopleStudy study;
  const int session = session_of(study.store(), "P001").session;
  const Bytes safety = study.store().wrapped_keys(session).safety.value();
  check_refused(study.people("withdraw P001 --erase-safety"), 1, {"withdraw --erase"});
  succeeded(study.people("withdraw P001 --erase --reason 'asked to'"));
  CHECK(files_with(study, safety).contains("study.db"));
  // A simulated session was in 1970, so that its years have passed.
  succeeded(study.people("withdraw P001 --erase-safety"));
  CHECK(files_with(study, safety).empty());
  check_refused(study.people("withdraw P001 --erase-safety"), 1, {"P001"});
  check_verified(study);
}

TEST_CASE("one participant's outcomes are exported after a recorded look at them, and no others") {
  const PeopleStudy study;
  study.put_person("P002", "somebody@example.org");
  const std::string export_one = "export @study.db --participant P002 --out ";
  const auto text = [&](const std::string& file) { return content(study.path() / file); };
  check_refused(study.type(export_one + "@never --key @study.db.key"), 1, {"--participant P002"});
  study.done(export_one + "@clear");
  CHECK(text("clear/P002_trials.csv").find("response") == std::string::npos);
  CHECK(line_count(text("clear/P002_trials.csv")) == 1 + 6);
  CHECK(text("clear/P002_personal.csv").find("somebody@example.org") != std::string::npos);
  CHECK(line_count(text("clear/P002_sessions.csv")) == 1 + 1);
  check_refused(study.type("unblind @study.db --participant P9 --reason x --yes"), 1, {"P9"});
  study.done("unblind @study.db --participant P002 --reason 'asked for the data' --yes");
  study.done(export_one + "@whole --key @study.db.key");
  CHECK(text("whole/P002_trials.csv").find("response") != std::string::npos);
  CHECK(text("whole/P002_trials.csv").find("P001") == std::string::npos);
  CHECK(fs::exists(study.path() / "whole/P002_events.csv"));
  const json quality = study.quality();
  CHECK(quality.at("blinded") == true);
  CHECK(quality.at("collection").at("looks").at(0).at("reason") == "asked for the data");
  check_refused(study.people("exclude P002 --reason 'bad figures'"), 1,
                {"P002", "--after-outcomes"});
  succeeded(study.people("exclude P001 --reason asleep"));
  check_verified(study);
}

TEST_CASE("notes and deviations are on the file's chain, before and after closing") {
  const PeopleStudy study;
  succeeded(study.people("note P003 'came late'"));
  succeeded(study.people("note P003 --deviation no-curtain 'it was in the wash'"));
  check_refused(study.people("note P003 ''"), 1, {"study.db"});
  check_refused(study.people("note P003 --deviation no-curtian torn"), 2,
                {"no-curtain", "no-placement", "no-day-sheet-NUMBER", "--own-code"});
  check_refused(study.people("note P003 --deviation sneezed twice"), 2, {"sneezed no-curtain"});
  CHECK_THAT(study.type("note --help").output, holds_text("practice-not-passed"));
  check_refused(study.people("note P9 who"), 1, {"P9"});
  check_refused(study.people("note P003"), 2, {"TEXT"});
  const std::vector<Event> chain = study.store().events(0);
  const json deviation = json::parse(chain.back().body);
  const json remark = json::parse(chain.at(chain.size() - 2).body);
  CHECK(chain.back().kind == EventKind::participant_noted);
  CHECK(deviation.at("code") == "no-curtain");
  CHECK(remark.at("code") == "");
  for (const json& body : {deviation, remark}) CHECK_FALSE(body.contains("text"));
  for (const char* const words : {"it was in the wash", "came late"}) {
    CHECK(files_with(study, bytes_of(words)).empty());
  }
  check_verified(study);
  CHECK(study.outcomes().at("participants") == 4);
  succeeded(study.people("note P003 'wrote a letter'"));
  check_verified(study);
}

TEST_CASE("the data dictionary explains every code of a deviation") {
  const std::string page = content(fs::path(TOUCHTRIAL_SOURCE_DIR) / "docs/data-dictionary.md");
  for (const std::string_view code : study::kDeviationCodes) {
    INFO(code);
    CHECK(page.find("`" + std::string(code) + "`") != std::string::npos);
  }
}

TEST_CASE("every command that records prints the head for the day sheet") {
  const PeopleStudy study;
  const auto check_head = [&](const ProgramResult& done) {
    INFO(done.output << done.errors);
    CHECK(done.exit_code == 0);
    const std::size_t begin = done.output.rfind("head ");
    REQUIRE(begin != std::string::npos);
    CHECK(done.output.find(" acknowledged") != std::string::npos);
    const std::string head = done.output.substr(begin + 5, 19);
    succeeded(study.run({"verify", study.in("study.db"), "--head", head}));
  };
  const std::vector<std::string> reason = {"--reason", "asked to"};
  const auto withdraw = [&](const std::string& participant, const std::string& how) {
    return study.people("withdraw " + participant, {how, "--reason", "asked to"});
  };
  check_head(study.people("note P001 'came late'"));
  check_head(withdraw("P001", "--keep-data"));
  check_head(withdraw("P002", "--erase"));
  check_head(study.people("withdraw P002 --erase-safety"));
  check_head(study.people("unblind P003", reason));
  check_head(study.people("exclude P004", reason));
  check_head(study.type("close @study.db --yes"));
  check_head(study.type("unblind @study.db --reason 'the planned test' --yes"));
}

TEST_CASE("irreversible commands name the participant and the loss, and ask for confirmation") {
  const PeopleStudy study;
  study.put_person("P001", "");
  const std::vector<Event> before = study.store().events(0);
  const auto check_unasked = [&](const std::string& line, const std::vector<std::string>& words) {
    check_refused(study.type(line), 2, words);
    CHECK(study.store().events(0).size() == before.size());
    TerminalRun asked(typed_words(line, study.path()));
    asked.answer("yes", "y");
    CHECK(asked.finish() == 2);
    for (const std::string& word : words) {
      if (word != "--yes") CHECK(names(asked.shown(), word));
    }
    CHECK(study.store().events(0).size() == before.size());
  };
  const std::string erasing = "withdraw @study.db --participant P001 --erase --reason 'asked to'";
  check_unasked(erasing, {"P001", "1 6", "--yes"});
  check_unasked("withdraw @study.db --participant P002 --keep-data --reason 'moves away'",
                {"P002", "--yes"});
  check_unasked("close @study.db", {"4", "--yes"});
  check_unasked("unblind @study.db --interim --reason look", {"--yes"});
  check_unasked("unblind @study.db --participant P003 --reason look",
                {"participant P003", "--yes"});
  CHECK(PersonalData(personal_data_path(study.database())).find("P001"));
  TerminalRun agreed(typed_words(erasing, study.path()));
  agreed.answer("yes", "yes");
  CHECK(agreed.finish() == 0);
  CHECK(session_of(study.store(), "P001").erased);
  check_verified(study);
}

TEST_CASE("what is recorded is signed with a station's file or with a key, not with both") {
  const ProgramFolder study;
  check_refused(study.type("note @study.db --participant P001 late --key @study.db.key "
                           "--station-file @cloths.station"),
                2, {"--key excludes --station-file"});
}

TEST_CASE("a second look at the same sessions is refused, and one at more is not") {
  const PeopleStudy study;
  const auto look = [&] { return study.type("unblind @study.db --interim --reason look --yes"); };
  succeeded(look());
  const std::size_t events = study.store().events(0).size();
  check_refused(look(), 1, {"study.db"});
  CHECK(study.store().events(0).size() == events);
  succeeded(study.session("P005"));
  succeeded(look());
  check_verified(study);
}

TEST_CASE("a database of another version is refused with one line, and unchanged") {
  const PeopleStudy study;
  SQLite::Database(study.database().string(), SQLite::OPEN_READWRITE)
      .exec("PRAGMA user_version = 6");
  const Bytes older = read_file(study.database());
  for (const char* const command : {"report", "verify"}) {
    check_refused(study.run({command, study.in("study.db")}), 1, {"study.db", "version 6"});
  }
  CHECK(read_file(study.database()) == older);
}
