// Databases that cannot be used: one line says what is wrong, where, and what to do.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <utility>

#include <SQLiteCpp/Database.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace touchtrial;

namespace {

ProgramResult note(const StudyFolder& study, const std::string& database) {
  return study.type("note @" + database + " --participant P001 'came late'");
}

/// Runs the program as an ordinary user, because permissions do not bind root.
ProgramResult run_as_ordinary_user(const StudyFolder& study,
                                   const std::vector<std::string>& arguments) {
  if (::geteuid() != 0) return study.run(arguments);
  std::vector<std::string> words = {"--reuid=65534", "--regid=65534", "--clear-groups",
                                    TOUCHTRIAL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program("/usr/bin/setpriv", study.path(), words);
}

}  // namespace

TEST_CASE("a database that another program writes is refused, and is not changed") {
  const StudyFolder study;
  succeeded(study.simulate("study.db", {"--keep-blind"}));
  {
    SQLite::Database other(study.in("study.db"), SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");
    check_refused(note(study, "study.db"), 1, {"study.db: "});
    study.done("report @study.db");  // reading still works
    other.exec("ROLLBACK");
  }
  succeeded(note(study, "study.db"));
}

TEST_CASE("every command names a database with a corrupted page as damaged") {
  const StudyFolder study;
  succeeded(study.simulate("study.db", {"--keep-blind"}));
  Bytes bytes = read_file(study.path() / "study.db");
  constexpr std::size_t kPage = 8192;
  REQUIRE(bytes.size() > 3 * kPage);
  // The first page contains the schema, the second the root of the events.
  for (std::size_t i = kPage; i < 2 * kPage; ++i) bytes[i] = 0xa5;
  replace_file(study.path() / "study.db", ByteView(bytes));
  check_refused(note(study, "study.db"), 3, {"study.db: ", "backup"});
  check_refused(study.type("report @study.db"), 3, {"study.db: ", "backup"});
  const ProgramResult verified = study.type("verify @study.db");
  CHECK(verified.exit_code == 3);
  CHECK_THAT(verified.output, holds_text("damaged"));
}

TEST_CASE("a session is not put into another study's database") {
  const StudyFolder study;
  succeeded(study.simulate("study.db", {"--keep-blind"}));
  study.write_study({{"study", "others"}, {"seed", 12}}, "others.json");
  study.done("prepare @others.json");
  const std::string before = content(study.path() / "study.db");
  const ProgramResult refused = study.type(
      "run @others.json --participant P009 --db @study.db --station-file @others.station --pack "
      "@others.pack --subject @quick.json");
  check_refused(refused, 1, {"study.db", "--db"});
  CHECK(content(study.path() / "study.db") == before);
}

TEST_CASE("a file that is not a study's database is refused, and is not changed") {
  const StudyFolder study;
  replace_file(study.path() / "letter.db", std::string(300, 'x'));
  {
    SQLite::Database(study.in("others.db"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE birds(name)");
  }
  fs::create_directory(study.path() / "folder.db");
  check_refused(note(study, "letter.db"), 1, {"letter.db [not-a-database]"});
  check_refused(note(study, "others.db"), 1, {"others.db [not-a-database]"});
  check_refused(note(study, "folder.db"), 1, {"folder.db"});
  check_refused(study.session("P009", {}, "letter.db"), 1, {"letter.db"});
  CHECK(content(study.path() / "letter.db") == std::string(300, 'x'));
}

TEST_CASE("in a read-only folder, reading works and writing fails with a clear error") {
  const StudyFolder study;
  REQUIRE(::chmod(study.path().c_str(), 0755) == 0);
  if (run_as_ordinary_user(study, {"--version"}).exit_code != 0) {
    WARN("not tested: root may write everywhere, and the program cannot be run as somebody else");
    return;
  }
  succeeded(study.simulate("study.db", {"--keep-blind"}));
  REQUIRE(::chmod(study.in("study.db").c_str(), 0644) == 0);
  REQUIRE(::chmod(study.path().c_str(), 0555) == 0);
  const auto as_user = [&](const std::string& line) {
    return run_as_ordinary_user(study, typed_words(line, study.path()));
  };
  const ProgramResult reported = as_user("report @study.db --json");
  const ProgramResult noted = as_user("note @study.db --participant P001 late");
  REQUIRE(::chmod(study.in("study.db").c_str(), 0666) == 0);  // and nothing beside it
  const ProgramResult file_only = as_user("note @study.db --participant P001 late");
  const ProgramResult simulated =
      as_user("simulate @cloths.json --participants 1 --db @new.db --subject @quick.json");
  REQUIRE(::chmod(study.path().c_str(), 0755) == 0);
  INFO(reported.errors);
  CHECK(reported.exit_code == 0);
  CHECK(json::parse(reported.output).at("participants") == 4);
  check_refused(noted, 1, {"study.db: "});
  check_refused(file_only, 1, {"study.db: "});
  check_refused(simulated, 1, {study.path().string()});
}

TEST_CASE("a refusal prints file names in any script, and bytes that are not text as numbers") {
  const ProgramFolder folder;
  const std::vector<std::pair<std::string, std::string>> names = {
      {"t\u00e4st-\u20ac-\U0001f600.db", "t\u00e4st-\u20ac-\U0001f600.db"},
      {"a\xff.db", "a\\xff.db"},
      {"a\xc3.db", "a\\xc3.db"},
      {"\xe2\x82", "\\xe2\\x82"},
      {"\xc0\xaf.db", "\\xc0\\xaf.db"},
      {"\xed\xa0\x80.db", "\\xed\\xa0\\x80.db"},
      {"\xf4\x90\x80\x80.db", "\\xf4\\x90\\x80\\x80.db"}};
  for (const auto& [name, printed] : names) {
    INFO(printed);
    const ProgramResult refused = folder.run({"verify", name});
    CHECK(refused.exit_code != 0);
    CHECK(line_count(refused.errors) == 1);
    CHECK(refused.errors.find(printed) != std::string::npos);
  }
}
