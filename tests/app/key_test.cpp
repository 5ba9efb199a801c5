// The investigator's key: checked, copied and protected, as a user does it.
#include "app/study_folder.hpp"
#include "study/key_protection.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

const std::string kSecret = "a passphrase of words";

/// A prepared study.
struct KeyedStudy : StudyFolder {
  explicit KeyedStudy(const std::vector<std::string>& options = {}) {
    replace_file(path() / "one.txt", kSecret + "\nnot this line\n", FileMode::owner_only);
    replace_file(path() / "two.txt", "quite another passphrase\n", FileMode::owner_only);
    done("prepare @cloths.json", options);
  }
  /// `touchtrial key COMMAND ...`
  [[nodiscard]] ProgramResult key(std::vector<std::string> words) const {
    words.insert(words.begin(), "key");
    return run_touchtrial(path(), words);
  }
};

}  // namespace

TEST_CASE("key check proves a prepared study, and says where the key lies") {
  const KeyedStudy study;
  const ProgramResult beside = study.done("key check @cloths.json");
  CHECK_THAT(beside.output, holds_text("cloths.key"));
  CHECK(names_in_order(beside.output, "main " + study.in("cloths.station")));
  CHECK_THAT(beside.errors, holds_text("cloths.key"));
  study.done("key check @cloths.key");

  fs::create_directory(study.path() / "stick");
  fs::rename(study.path() / "cloths.key", study.path() / "stick" / "cloths.key");
  const ProgramResult away = study.done("key check @cloths.json --key @stick/cloths.key");
  CHECK(away.errors.empty());
  check_refused(study.type("key check @cloths.json"), 1, {"--key"});
  check_refused(study.type("key check @stick/cloths.key"), 2, {"--station-file"});
}

TEST_CASE(
    "the key that was named is found again by its database's place, and nothing else is kept") {
  const KeyedStudy study;
  succeeded(study.session("P01"));
  const fs::path memory = study.path() / ".config/touchtrial/keys.json";
  fs::create_directory(study.path() / "stick");
  fs::rename(study.path() / "cloths.key", study.path() / "stick/cloths.key");
  const std::string look = "unblind @study.db --interim --reason look --yes";
  check_refused(study.type(look), 1, {"--key"});
  CHECK_FALSE(fs::exists(memory));
  study.done(look + " --key @stick/cloths.key");
  const json kept = json::parse(content(memory));
  CHECK(kept == json{{fs::canonical(study.path() / "study.db").string(),
                      fs::canonical(study.path() / "stick/cloths.key").string()}});
  CHECK(fs::status(memory).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  study.done("report @study.db");
  fs::rename(study.path() / "stick/cloths.key", study.path() / "elsewhere.key");
  check_refused(study.type("report @study.db"), 1, {"stick/cloths.key", "--key"});
  replace_file(memory, std::string("[damaged"));
  check_refused(study.type("report @study.db"), 1, {"--key"});
}

TEST_CASE("key check names the station whose file does not hold") {
  const KeyedStudy study;
  study.done("plan @cloths.json --participants 4 --stations 2");
  fs::copy_file(study.path() / "cloths.1.station", study.path() / "older.station");
  study.done("plan @cloths.json --participants 9 --extend");
  const ProgramResult both = study.done("key check @cloths.json --json");
  CHECK(json::parse(both.output).at("stations").size() == 2);
  fs::copy_file(study.path() / "older.station", study.path() / "cloths.1.station",
                fs::copy_options::overwrite_existing);
  const ProgramResult stale = study.type("key check @cloths.json");
  CHECK(stale.exit_code == 3);
  CHECK_THAT(stale.output, holds_text("cloths.1.station"));
  CHECK_THAT(stale.output, holds_text("cloths.2.station"));
  study.done("key check @cloths.json --station 2");
  CHECK(study.type("key check @cloths.json --station 1").exit_code == 3);
  const ProgramResult other = study.type("key check @cloths.json --station-file @older.station");
  CHECK(other.exit_code == 3);
}

TEST_CASE("a protected key opens with its passphrase alone, and stays protected") {
  const StudyFolder unprepared;
  replace_file(unprepared.path() / "open.txt", kSecret + "\n");
  check_refused(unprepared.type("prepare @cloths.json --passphrase --passphrase-file @open.txt"), 1,
                {"open.txt"});
  check_refused(unprepared.type("prepare @cloths.json --passphrase"), 2, {"terminal"});
  CHECK_FALSE(fs::exists(unprepared.path() / "cloths.key"));

  TempFolder secrets;
  const std::string one = (secrets.path() / "one.txt").string();
  replace_file(one, kSecret + "\n", FileMode::owner_only);
  const KeyedStudy study({"--passphrase", "--passphrase-file", one});
  CHECK(study::is_protected(study.path() / "cloths.key"));
  CHECK_FALSE(study::is_protected(study.path() / "cloths.station"));
  const std::vector<std::string> check = {"check", study.in("cloths.json")};
  check_refused(study.key(check), 1, {"--passphrase-file"});
  check_refused(study.type("key check @cloths.json --passphrase-file @two.txt"), 1, {"cloths.key"});
  const ProgramResult checked =
      succeeded(study.key({"check", study.in("cloths.json"), "--passphrase-file",
                           study.in("two.txt"), "--passphrase-file", one}));
  CHECK_THAT(checked.output, holds_text("cloths.key"));

  study.write_study({{"trials", {{"repeats", 3}}}});
  succeeded(study.run({"prepare", study.in("cloths.json"), "--passphrase-file", one}));
  int keys = 0;
  for (const auto& file : fs::directory_iterator(study.path())) {
    if (file.path().filename().string().find(".key") == std::string::npos) continue;
    CHECK(study::is_protected(file.path()));
    ++keys;
  }
  CHECK(keys == 2);  // the new one, and the one from before the change
}

TEST_CASE("a copy has a passphrase of its own, and opens the same") {
  const KeyedStudy study;
  const std::string key = study.in("cloths.key");
  const std::string copy = study.in("colleague.key");
  succeeded(study.key({"protect", key, "--new-passphrase-file", study.in("one.txt")}));
  const std::vector<std::string> plain_copy = {
      "copy", key, "--out", copy, "--passphrase-file", study.in("one.txt")};
  check_refused(study.key(plain_copy), 2, {"--passphrase"});
  std::vector<std::string> own_copy = plain_copy;
  own_copy.insert(own_copy.end(), {"--new-passphrase-file", study.in("two.txt")});
  succeeded(study.key(own_copy));
  check_refused(study.key(own_copy), 2, {copy});
  check_refused(study.key({"check", copy, "--passphrase-file", study.in("one.txt")}), 1,
                {"colleague.key"});
  succeeded(study.key({"protect", copy, "--remove", "--passphrase-file", study.in("two.txt")}));
  succeeded(study.key({"protect", key, "--remove", "--passphrase-file", study.in("one.txt")}));
  CHECK(content(copy) == content(key));
}

TEST_CASE("run and prepare open a station's file with its passphrase") {
  const KeyedStudy study;
  const std::string station = study.in("cloths.station");
  succeeded(study.key({"protect", station, "--new-passphrase-file", study.in("two.txt")}));
  check_refused(study.session("P01"), 1, {"cloths.station", "--passphrase-file"});
  succeeded(study.session("P01", {"--passphrase-file", study.in("two.txt")}));
  check_refused(study.type("prepare @cloths.json"), 1, {"cloths.station"});
  study.done("prepare @cloths.json --passphrase-file @two.txt");
  CHECK(study::is_protected(station));
}

TEST_CASE("a protected file of another station is refused before its passphrase is asked for") {
  const KeyedStudy study;
  study.done("plan @cloths.json --participants 4 --stations 2");
  const std::string other = study.in("cloths.2.station");
  succeeded(study.session("P01", {"--station", "1"}));
  succeeded(study.key({"protect", other, "--new-passphrase-file", study.in("two.txt")}));
  check_refused(study.session("P02", {"--station", "2"}), 1, {"cloths.2.station"});
  check_refused(
      study.type("note @study.db --participant P01 late --station-file @cloths.2.station"), 1,
      {"cloths.2.station 1"});
  // Without a name, the file of the database's own station is found, whatever lies beside it.
  study.done("note @study.db --participant P01 late");
  fs::copy_file(other, study.path() / "cloths.1.station", fs::copy_options::overwrite_existing);
  const ProgramResult checked = study.type("key check @cloths.json --station 1");
  CHECK(checked.exit_code == 3);
  CHECK_THAT(checked.output, holds_text("cloths.1.station: FAILED: "));
}

TEST_CASE("a terminal asks for passphrases and shows nothing of them") {
  const StudyFolder study;
  {
    TerminalRun run({"prepare", study.in("cloths.json"), "--passphrase"});
    run.answer("cloths.key: ", kSecret);
    run.answer(": ", kSecret + "x");
    CHECK(run.finish() == 2);
    CHECK_FALSE(fs::exists(study.path() / "cloths.key"));
  }
  {
    TerminalRun run({"prepare", study.in("cloths.json"), "--passphrase"});
    run.answer("cloths.key: ", "\x15wrong\x15" + kSecret + "xx\x7f\x7f");
    run.answer(": ", kSecret);
    CHECK(run.finish() == 0);
    CHECK(run.shown().find(kSecret.substr(0, 6)) == std::string::npos);
    CHECK(study::is_protected(study.path() / "cloths.key"));
  }
  {
    TerminalRun run({"key", "check", study.in("cloths.json")});
    run.answer("cloths.key: ", "not this one");
    run.answer("cloths.key: ", kSecret);
    CHECK(run.finish() == 0);
    CHECK_THAT(run.shown(), holds_text("cloths.station"));
  }
  {
    TerminalRun run({"key", "check", study.in("cloths.json")});
    run.answer("cloths.key: ", "\x03");
    CHECK(run.finish() == 2);
  }
}
