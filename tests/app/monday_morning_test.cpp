// What docs/when-something-goes-wrong.md says to type, typed in the situation that it is for.
#include "app/study_folder.hpp"
#include "core/files.hpp"
#include "record/study_store.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

using namespace touchtrial;

namespace {

const std::string kDead = "The machine has died";
const std::string kOlder = "The backup is older, or there is none";
const std::string kNoKey = "Lost key";
const std::string kNoStation = "The station's file is lost";
const std::string kWrong = "The wrong person sat down, or the wrong id was typed";
const std::string kWithdrawn = "Somebody withdraws at trial 12";
const std::string kFull = "The disk is full";
const std::string kClock = "The clock is wrong";
const std::string kLog = "The write-ahead log is damaged";

/// One case of the page.
struct MondayCase {
  int lines = 0;                                 ///< of text and commands
  std::vector<std::vector<std::string>> blocks;  ///< of commands
};

/// The cases of docs/when-something-goes-wrong.md by their headings, and what stands before the
/// first under "".
std::map<std::string, MondayCase> monday_cases() {
  std::istringstream page(
      content(fs::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "when-something-goes-wrong.md"));
  std::map<std::string, MondayCase> cases;
  std::string heading;
  bool in_block = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      in_block = line.size() > 3;
      if (in_block) cases[heading].blocks.emplace_back();
    } else if (line.starts_with("## ")) {
      heading = line.substr(3);
      cases[heading] = {};
    } else if (!line.empty()) {
      ++cases[heading].lines;
      if (in_block) cases[heading].blocks.back().push_back(line);
    }
  }
  return cases;
}

/// A case's block of commands, from 0. The test fails if the page has none.
std::vector<std::string> monday_block(const std::string& heading, std::size_t block) {
  const std::map<std::string, MondayCase> cases = monday_cases();
  INFO(heading << ", block " << block);
  REQUIRE(cases.contains(heading));
  REQUIRE(block < cases.at(heading).blocks.size());
  return cases.at(heading).blocks[block];
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  for (std::size_t at = text.find(old); at != std::string::npos;
       at = text.find(old, at + with.size())) {
    text.replace(at, old.size(), with);
  }
  return text;
}

void make_program(const fs::path& path, const std::string& script) {
  replace_file(path, "#!/bin/sh\n" + script);
  fs::permissions(path, fs::perms::owner_all);
}

/// A station and what belongs to it: folders `home/study` (where one is), `home/investigator`,
/// which alone has the key, and `media/stick` and `media/backup`, which commands call /media/stick
/// and /media/backup. `run` presents simulated participants.
class MondayDesk {
 public:
  /// Prepares a study of 18 trials.
  MondayDesk();

  [[nodiscard]] const fs::path& root() const { return folder_.path(); }
  [[nodiscard]] fs::path study() const { return root() / "home" / "study"; }
  [[nodiscard]] fs::path investigator() const { return root() / "home" / "investigator"; }

  /// Types one command.
  ProgramResult type(const std::string& command, const std::string& input = "");
  /// Types a block's commands, of which all must succeed.
  /// \return what the last one printed
  ProgramResult type_all(const std::vector<std::string>& commands);
  void go_to(const fs::path& folder) { here_ = folder; }

  /// A session from its beginning to its end.
  void complete(const std::string& participant);
  /// A session that a signal ends after a trial.
  /// \return what was printed
  std::string break_off(const std::string& participant, int trial, int signal);

  /// What is wrong with the machine while programs run; 0: nothing. `sudo date` mends the clock.
  void set_clock_ahead(long seconds);
  void fill_disk_after(long bytes);

 private:
  [[nodiscard]] std::string script(const std::string& command) const;

  TempFolder folder_;
  fs::path here_;
};

MondayDesk::MondayDesk() {
  for (const char* const name :
       {"home/study", "home/investigator", "media/stick", "media/backup", "bin"}) {
    fs::create_directories(root() / name);
  }
  go_to(study());
  json document = study_of("classification");
  document["trials"]["repeats"] = 6;
  document["trials"]["explore_limit_s"] = 1.0;
  document["trials"]["validity"] = {{"exploring_s", 1.0}, {"contact_s", 1.0}, {"path_mm", 100.0}};
  for (std::size_t i = 0; i < kLabels.size(); ++i) {
    engine::write_png(study() / (kLabels[i] + "-photo.png"), texture_number(static_cast<int>(i)));
  }
  replace_file(study() / "study.json", document.dump());
  replace_file(root() / "quick.json",
               R"({"feature_noise": 0.1, "explore_s": 0.5, "training_passes": 2})");
  // `run` has a participant, who takes as long as a person would if the desk asks for that; nobody
  // is there whom `withdraw` could ask.
  make_program(
      root() / "bin" / "touchtrial",
      fmt::format("if [ -f {0}/clock ]; then export FAKE_CLOCK_AHEAD_S=$(cat {0}/clock); fi\n"
                  "if [ -f {0}/disk ]; then export FAKE_DISK_BYTES=$(cat {0}/disk); fi\n"
                  "if [ \"$1\" = run ]; then\n"
                  "  set -- \"$@\" --subject {0}/quick.json $PACE\n"
                  "fi\n"
                  "if [ \"$1\" = withdraw ]; then set -- \"$@\" --yes; fi\n"
                  "export LD_PRELOAD={1}\n"
                  "exec {2} \"$@\"\n",
                  root().string(), TOUCHTRIAL_FAKE_MACHINE, TOUCHTRIAL_PROGRAM));
  make_program(root() / "bin" / "sudo",
               fmt::format("test \"$1\" = date && rm {}/clock\n", root().string()));
  type_all({"touchtrial prepare study.json", "cp -a . ../investigator", "rm study.key",
            "rm ../investigator/study.station"});
}

std::string MondayDesk::script(const std::string& command) const {
  return fmt::format(
             "export HOME='{0}/home' PATH='{0}/bin':\"$PATH\" "
             "ASAN_OPTIONS=\"$ASAN_OPTIONS:verify_asan_link_order=0\"\ncd '{1}' && ",
             root().string(), here_.string()) +
         replaced(command, "/media/", (root() / "media").string() + "/");
}

ProgramResult MondayDesk::type(const std::string& command, const std::string& input) {
  // What the shell was left in is where the next command is typed.
  const std::string where = (root() / "here.txt").string();
  const ProgramResult result = run_program(
      "/bin/sh", root(),
      {"-c", fmt::format("{}\nstatus=$?\npwd > '{}'\nexit $status", script(command), where)},
      input);
  std::string here = content(where);
  here.pop_back();
  here_ = here;
  return result;
}

ProgramResult MondayDesk::type_all(const std::vector<std::string>& commands) {
  ProgramResult last;
  for (const std::string& command : commands) {
    last = type(command);
    INFO(command << "\n" << last.output << last.errors);
    REQUIRE(last.exit_code == 0);
  }
  return last;
}

void MondayDesk::complete(const std::string& participant) {
  const ProgramResult result = type("touchtrial run study.json --participant " + participant +
                                    " --db study.db --heads /media/stick");
  INFO(result.output << result.errors);
  REQUIRE(result.exit_code == 0);
}

std::string MondayDesk::break_off(const std::string& participant, int trial, int signal) {
  testing::ChildProcess program(
      {"/bin/sh", "-c",
       script("exec env PACE=--real-time touchtrial run study.json --participant " + participant +
              " --db study.db --heads /media/stick")},
      {});
  const bool came_there = program.says(fmt::format("trial {} acknowledged\n", trial));
  program.send_signal(signal);
  static_cast<void>(program.finish());
  INFO(program.output());
  REQUIRE(came_there);
  return program.output();
}

void MondayDesk::set_clock_ahead(long seconds) {
  replace_file(root() / "clock", std::to_string(seconds));
}

void MondayDesk::fill_disk_after(long bytes) {
  if (bytes == 0) {
    fs::remove(root() / "disk");
  } else {
    replace_file(root() / "disk", std::to_string(bytes));
  }
}

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
    for (const std::string& word : words) CHECK(names_in_order(refused.errors, word));
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
  CHECK_THAT(ran.output, holds_text(participant) && holds_text("18"));
}

void flip_one_bit(const fs::path& file, double place) {
  Bytes bytes = read_file(file);
  bytes[static_cast<std::size_t>(place * static_cast<double>(bytes.size()))] ^= 1U;
  replace_file(file, ByteView(bytes));
}

/// What the database keeps of a session's key.
Bytes key_of_session(const fs::path& database, const std::string& participant) {
  const record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
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

TEST_CASE("the page on problems has a rehearsal of each case, of ten lines at most") {
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

TEST_CASE("after a machine failure, another one continues from the backup") {
  MondayStation desk;
  desk.break_off("P07", 2, SIGKILL);
  desk.follow("");
  desk.lose_machine();
  const ProgramResult resumed = desk.follow(kDead);
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  CHECK(desk.check_holds().output.find("--accept-loss") == std::string::npos);
}

TEST_CASE("losses of an older backup are named, and can be accepted") {
  MondayStation desk;
  desk.follow("");
  desk.complete("P02");
  desk.lose_machine();
  const std::vector<std::string> restored = monday_block(kDead, 0);
  desk.type_all({restored.at(0)});
  desk.check_refusal(restored.at(1), {"18 18 36", "--accept-loss"});
  check_went_on(desk.follow(kOlder), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text("(the disk died)"));
}

TEST_CASE("a missing database is recreated only on request") {
  MondayStation desk;
  for (const char* const name : {"study.db", "study.db.head"}) fs::remove(desk.study() / name);
  const std::string waiting = monday_block(kDead, 0).at(1);
  desk.check_refusal(waiting, {"study.db: ", "media/stick/study.db.head", "18 answers acknowledged",
                               "--accept-loss"});
  CHECK_FALSE(fs::exists(desk.study() / "study.db"));
  check_went_on(desk.follow(kOlder), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text(" 18 "));
}

TEST_CASE("a missing head file is recreated from the other one") {
  MondayStation desk;
  fs::remove(desk.study() / "study.db.head");
  desk.check_refusal("touchtrial run study.json --participant P02 --db study.db",
                     {"study.db.head"});
  desk.complete("P02");
  CHECK(fs::exists(desk.study() / "study.db.head"));
  CHECK(desk.check_holds().output.find("--accept-loss") == std::string::npos);
}

TEST_CASE("a loss recorded in two head files is reported once") {
  MondayStation desk;
  desk.type_all({"cp study.db older.db"});
  desk.complete("P02");
  desk.type_all({"cp study.db.head between.head"});
  desk.complete("P03");
  desk.type_all({"cp older.db study.db", "cp between.head study.db.head"});
  const ProgramResult refused = desk.type(monday_block(kDead, 0).at(1));
  CHECK(refused.exit_code == 1);
  INFO(refused.errors);
  CHECK(names(refused.errors, "36"));
  CHECK_FALSE(names_in_order(refused.errors, "36 36"));
}

TEST_CASE("the investigator's key comes back from its copy, and sessions need none") {
  MondayStation desk;
  desk.go_to(desk.investigator());
  desk.type_all({"touchtrial key copy study.key --out /media/stick/copy.key", "rm study.key"});
  desk.go_to(desk.study());
  check_went_on(desk.type("touchtrial run study.json --participant P02 --db study.db"), "P02");
  check_refused(desk.type("touchtrial unblind study.db --interim --reason look"), 1, {"--key"});

  desk.go_to(desk.investigator());
  desk.type_all({"cp ../study/study.db ../study/study.db.head ."});
  const ProgramResult verified = desk.type_all(monday_block(kNoKey, 0));
  CHECK_THAT(verified.output, holds_text("responses"));
}

TEST_CASE("a lost station's file is rewritten, and the open session continues") {
  MondayStation desk;
  desk.break_off("P07", 2, SIGKILL);
  const std::string station = content(desk.study() / "study.station");
  fs::remove(desk.study() / "study.station");
  const std::vector<std::string> commands = monday_block(kNoStation, 0);
  check_refused(desk.type(commands.back()), 2, {"study.station: ", "investigator's"});
  desk.go_to(desk.investigator());
  desk.type_all({commands.at(0)});
  desk.go_to(desk.study());
  const ProgramResult resumed = desk.type_all({commands.begin() + 1, commands.end()});
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  CHECK(content(desk.study() / "study.station") == station);
  desk.check_holds();
}

TEST_CASE("prepare without the key does not change the station's file and the pack") {
  MondayStation desk;
  const std::string station = content(desk.study() / "study.station");
  const std::vector<std::string> words = {"study.key"};
  desk.check_refusal("touchtrial prepare study.json", words);
  CHECK(content(desk.study() / "study.station") == station);
  CHECK_FALSE(fs::exists(desk.study() / "study.key"));
  fs::remove(desk.study() / "study.station");
  desk.check_refusal("touchtrial prepare study.json", words);
  CHECK_FALSE(fs::exists(desk.study() / "study.key"));
}

TEST_CASE("a wrong person is stopped and replaced, a wrong id is noted and begins again") {
  MondayStation desk;
  static_cast<void>(desk.break_off("P07", 1, SIGINT));
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
    "a participant who withdraws at trial 12 has the data erased or kept, and is not resumed") {
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
  desk.check_refusal(resume + "P07", {"P07"});
  desk.check_holds();

  std::string keep = monday_block(kWithdrawn, 1).at(0);
  desk.break_off("P08", 12, SIGINT);
  desk.type_all({keep.replace(keep.find("P07"), 3, "P08")});
  desk.check_refusal(resume + "P08", {"P08"});
  desk.check_refusal(
      "touchtrial run study.json --db study.db --on-existing restart --participant P08", {"P08"});
  desk.type_all({monday_block(kWrong, 0).at(1)});
  check_went_on(desk.type(monday_block(kWrong, 0).at(2)), "P21");
  const ProgramResult reported = succeeded(desk.type("touchtrial report study.db --json"));
  CHECK(json::parse(reported.output).at("sessions").at("completed") == 2);  // P01, P21
  desk.check_holds();
}

TEST_CASE("a full disk ends a session with one line, and it can be resumed when there is space") {
  MondayStation desk;
  const std::vector<std::string> commands = monday_block(kFull, 0);
  desk.fill_disk_after(600'000);
  const ProgramResult full = desk.type(commands.back());
  INFO(full.output << full.errors);
  CHECK(full.exit_code == 1);
  CHECK(line_count(full.errors) == 1);
  CHECK_THAT(full.output, holds_text("trial 1 acknowledged"));
  desk.fill_disk_after(0);
  const ProgramResult resumed = desk.follow(kFull);
  check_went_on(resumed, "P07");
  CHECK(resumed.output.find("trial 1 acknowledged") == std::string::npos);
  desk.check_holds();
}

TEST_CASE("a clock years ahead or a day behind is reported, and the session continues") {
  MondayStation desk;
  desk.break_off("P07", 1, SIGINT);
  const std::vector<std::string> commands = monday_block(kClock, 0);
  constexpr long kDay_s = 86'400;
  desk.set_clock_ahead(-kDay_s);
  CHECK_THAT(desk.break_off("P08", 1, SIGINT), holds_text("study.db"));
  desk.set_clock_ahead(5 * 365 * kDay_s);
  desk.check_refusal(commands.back(), {"P07", "24 h", "--on-existing restart"});
  check_went_on(desk.follow(kClock), "P07");
  desk.check_holds();
}

TEST_CASE("trials lost in a damaged log are named, and presented again once the loss is accepted") {
  MondayStation desk;
  desk.break_off("P07", 4, SIGKILL);
  flip_one_bit(desk.study() / "study.db-wal", 0.5);
  const std::vector<std::string> commands = monday_block(kLog, 0);
  desk.type_all({commands.at(0)});
  desk.check_refusal(commands.at(1), {"P07", "--accept-loss"});
  check_went_on(desk.follow(kLog, 1), "P07");
  CHECK_THAT(desk.check_holds().output, holds_text("(a damaged log)"));
}
