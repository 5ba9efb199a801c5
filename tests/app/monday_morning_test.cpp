// What docs/monday-morning.md says to type, typed in the situation that it is for.
#include "app/monday_page.hpp"
#include "core/files.hpp"
#include "protocols/store/study_store.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <set>

using namespace touchtrial;

namespace {

const std::string kDead = "The machine has died";
const std::string kOlder = "The backup is older, or there is none";
const std::string kNoKey = "The investigator's key is lost";
const std::string kNoStation = "The station's file is lost";
const std::string kWrong = "The wrong person sat down, or the wrong id was typed";
const std::string kWithdrawn = "Somebody withdraws at trial 12";
const std::string kFull = "The disk is full";
const std::string kClock = "The clock is wrong";
const std::string kLog = "The write-ahead log is damaged";

/// The desk with one complete session, of P01.
struct MondayStation : MondayDesk {
  MondayStation() { complete("P01"); }

  /// A block of the page in which all commands succeed.
  ProgramResult follow(const std::string& heading, std::size_t block = 0) {
    return type_all(monday_block(heading, block));
  }
  /// The page's command that is refused here, for these reasons.
  void check_refusal(const std::string& command, const std::vector<std::string>& words) {
    const ProgramResult refused = type(command);
    INFO(command << "\n" << refused.output << refused.errors);
    CHECK(refused.exit_code == 1);
    CHECK(line_count(refused.errors) == 1);
    for (const std::string& word : words) CHECK_THAT(refused.errors, holds_text(word));
  }
  /// Everything in the database holds, with the investigator's key.
  ProgramResult check_holds() {
    const fs::path folder = study();
    ProgramResult verified = type("touchtrial verify " + (folder / "study.db").string() +
                                  " --key " + (investigator() / "study.key").string());
    INFO(verified.output << verified.errors);
    CHECK(verified.exit_code == 0);
    return verified;
  }
  void lose_machine() {
    go_to(root());
    fs::remove_all(study());
  }
};

void check_went_on(const ProgramResult& ran, const std::string& participant) {
  INFO(ran.output << ran.errors);
  CHECK(ran.exit_code == 0);
  CHECK_THAT(ran.output, holds_text("of participant " + participant + ": complete, 18 trials"));
}

void flip_one_bit(const fs::path& file, double place) {
  Bytes bytes = read_file(file);
  bytes[static_cast<std::size_t>(place * static_cast<double>(bytes.size()))] ^= 1U;
  replace_file(file, ByteView(bytes));
}

/// What the database keeps of a session's key.
Bytes key_of_session(const fs::path& database, const std::string& participant) {
  const store::StudyStore store =
      store::StudyStore::open(database, store::StudyStore::Access::read_only);
  return store.wrapped_key(store.session_of(participant).value().session).value();
}

/// Whether a file in or below the folder contains the bytes.
bool has_bytes(const fs::path& folder, ByteView bytes) {
  return std::ranges::any_of(fs::recursive_directory_iterator(folder), [&](const auto& entry) {
    if (!entry.is_regular_file() || entry.file_size() == 0) return false;
    const Bytes file = read_file(entry.path());
    return std::search(file.begin(), file.end(), bytes.begin(), bytes.end()) != file.end();
  });
}

}  // namespace

TEST_CASE("monday morning's page has a rehearsal of each case, which takes ten lines at most") {
  const std::set<std::string> rehearsed = {"",     kDead,      kOlder, kNoKey, kNoStation,
                                           kWrong, kWithdrawn, kFull,  kClock, kLog};
  std::set<std::string> headings;
  for (const auto& [heading, of_page] : monday_cases()) {
    INFO(heading);
    headings.insert(heading);
    CHECK(of_page.blocks.size() >= 1);
    if (!heading.empty()) CHECK(of_page.lines <= 10);
  }
  CHECK(headings == rehearsed);
}

TEST_CASE("when the machine has died, another one goes on from the backup") {
  MondayStation desk;
  desk.break_off("P07", 2, SIGKILL);
  desk.follow("");
  desk.lose_machine();
  const ProgramResult resumed = desk.follow(kDead);
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  CHECK(desk.check_holds().output.find("a loss was accepted") == std::string::npos);
}

TEST_CASE("what an older backup lacks is named, and accepted where somebody waits") {
  MondayStation desk;
  desk.follow("");
  desk.complete("P02");
  desk.lose_machine();
  const std::vector<std::string> restored = monday_block(kDead, 0);
  desk.type_all({restored.at(0)});
  desk.check_refusal(restored.at(1), {"18 acknowledged answers are missing: the database has 18, "
                                      "the head file knows 36",
                                      "--accept-loss"});
  check_went_on(desk.follow(kOlder), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text("a loss was accepted (the disk died)"));
}

TEST_CASE("a database that is gone is begun anew only if that is wanted") {
  MondayStation desk;
  for (const char* const name : {"study.db", "study.db.head"}) fs::remove(desk.study() / name);
  const std::string waiting = monday_block(kDead, 0).at(1);
  desk.check_refusal(waiting, {"study.db: is not there", "media/stick/study.db.head",
                               "18 answers acknowledged", "--accept-loss"});
  CHECK_FALSE(fs::exists(desk.study() / "study.db"));
  check_went_on(desk.follow(kOlder), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text("18 acknowledged answers are missing"));
}

TEST_CASE("a head file that is gone is made anew from the other one, which knows the same") {
  MondayStation desk;
  fs::remove(desk.study() / "study.db.head");
  desk.check_refusal("touchtrial run study.json --participant P02 --db study.db",
                     {"its head file study.db.head is gone"});
  desk.complete("P02");
  CHECK(fs::exists(desk.study() / "study.db.head"));
  CHECK(desk.check_holds().output.find("a loss was accepted") == std::string::npos);
}

TEST_CASE("a loss that two head files know is named once") {
  MondayStation desk;
  desk.type_all({"cp study.db older.db"});
  desk.complete("P02");
  desk.type_all({"cp study.db.head between.head"});
  desk.complete("P03");
  desk.type_all({"cp older.db study.db", "cp between.head study.db.head"});
  const ProgramResult refused = desk.type(monday_block(kDead, 0).at(1));
  CHECK(refused.exit_code == 1);
  const std::size_t first = refused.errors.find("acknowledged answers are missing");
  INFO(refused.errors);
  CHECK_THAT(refused.errors, holds_text("36 acknowledged answers are missing"));
  CHECK(refused.errors.find("acknowledged answers are missing", first + 1) == std::string::npos);
}

TEST_CASE("the investigator's key is typed from its sheet, and sessions need none") {
  MondayStation desk;
  desk.go_to(desk.investigator());
  desk.type_all({"touchtrial key sheet study.key --out sheet.txt"});
  const std::string sheet = content(desk.investigator() / "sheet.txt");
  desk.type_all({"rm study.key sheet.txt"});
  desk.go_to(desk.study());
  check_went_on(desk.type("touchtrial run study.json --participant P02 --db study.db"), "P02");
  check_refused(desk.type("touchtrial unblind study.db --interim --reason look"), 1,
                {"there is no key beside the database; name it with --key"});

  desk.go_to(desk.investigator());
  desk.type_all({"cp ../study/study.db ."});
  const std::vector<std::string> commands = monday_block(kNoKey, 0);
  succeeded(desk.type(commands.at(0), sheet));
  const ProgramResult checked = desk.type_all({commands.begin() + 1, commands.end()});
  CHECK_THAT(checked.output, holds_text("opens 2 sessions"));
}

TEST_CASE("a station's file that is lost is written again, and the open session goes on") {
  MondayStation desk;
  desk.break_off("P07", 2, SIGKILL);
  const std::string station = content(desk.study() / "study.station");
  fs::remove(desk.study() / "study.station");
  const std::vector<std::string> commands = monday_block(kNoStation, 0);
  check_refused(desk.type(commands.back()), 2,
                {"study.station: there is no such station file", "investigator's machine"});
  desk.go_to(desk.investigator());
  desk.type_all({commands.at(0)});
  desk.go_to(desk.study());
  const ProgramResult resumed = desk.type_all({commands.begin() + 1, commands.end()});
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  CHECK(content(desk.study() / "study.station") == station);
  desk.check_holds();
}

TEST_CASE("prepare without the key leaves the station's file and the pack as they are") {
  MondayStation desk;
  const std::string station = content(desk.study() / "study.station");
  const std::vector<std::string> words = {"study.key: is not here", "was made with it",
                                          "lay the key here"};
  desk.check_refusal("touchtrial prepare study.json", words);
  CHECK(content(desk.study() / "study.station") == station);
  CHECK_FALSE(fs::exists(desk.study() / "study.key"));
  fs::remove(desk.study() / "study.station");
  desk.check_refusal("touchtrial prepare study.json", words);
  CHECK_FALSE(fs::exists(desk.study() / "study.key"));
}

TEST_CASE("a wrong person is stopped and replaced, a wrong id is noted and begins again") {
  MondayStation desk;
  CHECK_THAT(desk.break_off("P07", 1, SIGINT), holds_text("left open"));
  check_went_on(desk.follow(kWrong, 0), "P21");
  desk.break_off("P08", 1, SIGINT);
  check_went_on(desk.follow(kWrong, 1), "P08");
  const ProgramResult reported = succeeded(desk.type("touchtrial report study.db --json"));
  const json sessions = json::parse(reported.output).at("sessions");
  CHECK(sessions.at("completed") == 4);  // P01, P21, P09, P08
  CHECK(sessions.at("replaced") == 2);
  CHECK(sessions.at("open") == 0);
  desk.check_holds();
}

TEST_CASE(
    "who withdraws at trial 12 has the data erased, or lets them be used, and is not resumed") {
  MondayStation desk;
  const std::string resume =
      "touchtrial run study.json --db study.db --on-existing resume --participant ";
  desk.break_off("P07", 12, SIGINT);
  const Bytes key = key_of_session(desk.study() / "study.db", "P07");
  desk.follow("");
  REQUIRE(has_bytes(desk.root() / "media", key));
  desk.follow(kWithdrawn, 0);
  CHECK_FALSE(has_bytes(desk.study(), key));
  CHECK_FALSE(has_bytes(desk.root() / "media", key));
  desk.check_refusal(resume + "P07", {"participant P07 has withdrawn"});
  desk.check_holds();

  std::string keep = monday_block(kWithdrawn, 1).at(0);
  desk.break_off("P08", 12, SIGINT);
  desk.type_all({keep.replace(keep.find("P07"), 3, "P08")});
  desk.check_refusal(resume + "P08", {"participant P08 has withdrawn"});
  desk.check_refusal(
      "touchtrial run study.json --db study.db --on-existing restart --participant P08",
      {"participant P08 has withdrawn"});
  desk.type_all({monday_block(kWrong, 0).at(1)});
  check_went_on(desk.type(monday_block(kWrong, 0).at(2)), "P21");
  const ProgramResult reported = succeeded(desk.type("touchtrial report study.db --json"));
  CHECK(json::parse(reported.output).at("sessions").at("completed") == 2);  // P01, P21
  desk.check_holds();
}

TEST_CASE("a disk that gets full ends a session in one line, and it goes on when there is room") {
  MondayStation desk;
  const std::vector<std::string> commands = monday_block(kFull, 0);
  desk.fill_disk_after(600'000);
  const ProgramResult full = desk.type(commands.back());
  INFO(full.output << full.errors);
  CHECK(full.exit_code == 1);
  CHECK(line_count(full.errors) == 1);
  CHECK_THAT(full.errors, holds_text("free space"));
  CHECK_THAT(full.output, holds_text("trial 1 acknowledged"));
  desk.fill_disk_after(0);
  const ProgramResult resumed = desk.follow(kFull);
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  desk.check_holds();
}

TEST_CASE("a clock that is years ahead or a day behind is named, and the session goes on") {
  MondayStation desk;
  desk.break_off("P07", 1, SIGINT);
  const std::vector<std::string> commands = monday_block(kClock, 0);
  constexpr long kDay_s = 86'400;
  desk.set_clock_ahead(-kDay_s);
  CHECK_THAT(desk.break_off("P08", 1, SIGINT),
             holds_text("which is before the last entry of study.db"));
  desk.set_clock_ahead(5 * 365 * kDay_s);
  desk.check_refusal(commands.back(),
                     {"by this machine's clock, which shows 20", "set the clock if it is wrong"});
  check_went_on(desk.follow(kClock), "P07");
  desk.check_holds();
}

TEST_CASE("what a damaged log lost is named, and presented again where it is accepted") {
  MondayStation desk;
  desk.break_off("P07", 4, SIGKILL);
  flip_one_bit(desk.study() / "study.db-wal", 0.5);
  const std::vector<std::string> commands = monday_block(kLog, 0);
  desk.type_all({commands.at(0)});
  desk.check_refusal(commands.at(1),
                     {"of participant P07", "acknowledged answer", "missing", "--accept-loss"});
  check_went_on(desk.follow(kLog, 1), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text("a loss was accepted (a damaged log)"));
}
