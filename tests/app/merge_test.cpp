// The program merges several stations' databases into one.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <algorithm>

#include <SQLiteCpp/Database.h>

using namespace touchtrial;

namespace {

/// Four participants simulated as two stations with two each, and as one.
struct SimulatedStations : StudyFolder {
  SimulatedStations() {
    succeeded(simulate("one.db"));
    for (const std::string first : {"1", "3"}) {
      done("simulate @cloths.json --participants 2 --seed 3 --subject @quick.json --db @s" + first +
           ".db --first-participant " + first);
    }
  }
  [[nodiscard]] ProgramResult merge(const std::vector<std::string>& names,
                                    const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"merge"};
    for (const std::string& name : names) arguments.push_back(in(name));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return StudyFolder::run(arguments);
  }
};

/// The report's JSON without stations as strata, which one station does not have, and without head
/// files, which a merged database does not have.
json without_strata(const std::string& text) {
  json report = json::parse(text);
  report["primary"].erase("stations");
  report.erase("vouched");
  return report;
}

/// Every row of a table without the column "station"; no field before it has a comma.
std::string without_station(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::string kept;
  std::optional<std::ptrdiff_t> at;
  for (bool first = true; std::getline(lines, line); first = false) {
    if (first) {
      const std::size_t found = ("," + line + ",").find(",station,");
      if (found == std::string::npos) return text;
      at = std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(found), ',');
    }
    std::size_t begin = 0;
    for (std::ptrdiff_t i = 0; i < *at; ++i) begin = line.find(',', begin) + 1;
    kept += line.erase(begin, line.find(',', begin) - begin) + '\n';
  }
  return kept;
}

/// An exported file's text, in which a participant's station does not appear.
std::string comparable(const fs::path& path) {
  const std::string text = content(path);
  if (path.extension() == ".csv") return without_station(text);
  if (path.filename() == "report.json") return without_strata(text).dump();
  if (path.filename() != "study.json") return text;
  json document = json::parse(text);
  document["report"]["primary"].erase("stations");
  for (json& row : document["participants"]) row.erase("station");
  return document.dump();
}

/// Every file of an export by name.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).generic_string()] = comparable(entry.path());
  }
  return files;
}

}  // namespace

TEST_CASE("merged stations give the same report and export as one station with all participants") {
  const SimulatedStations study;
  succeeded(study.merge({"s3.db", "s1.db"}, {"-o", study.in("C.db")}));
  const ProgramResult one = study.type("report @one.db --json");
  const ProgramResult merged = study.done("report @C.db --json");
  CHECK(json::parse(merged.output).at("participants") == 4);
  CHECK(json::parse(merged.output).at("/primary/stations/stations"_json_pointer) == 2);
  CHECK(without_strata(merged.output) == without_strata(one.output));
  for (const std::string format : {"csv", "json", "r", "psych-ds", "events"}) {
    for (const std::string name : {"one", "C"}) {
      const ProgramResult ran = study.run({"export", study.in(name + ".db"), "--format", format,
                                           "-o", study.in(name + "-" + format)});
      INFO(format << ": " << ran.errors);
      REQUIRE(ran.exit_code == 0);
    }
    CHECK(files_of(study.in("C-" + format)) == files_of(study.in("one-" + format)));
  }
}

TEST_CASE("a merged study verifies with its key, its pack and its traces, and exports those") {
  const SimulatedStations study;
  succeeded(study.merge({"s1.db", "s3.db"}, {"-o", study.in("C.db")}));
  const json report = study.printed("verify @C.db --json");
  for (const json& check : report.at("checks")) {
    CHECK(check.at("state") == "passed");
  }
  const ProgramResult bids =
      study.done("export @C.db --format bids --traces --with-database -o @bids");
  int recordings = 0;
  int copies = 0;
  for (const auto& [name, text] : files_of(study.in("bids"))) {
    if (name.find("sub-") == 0 && name.ends_with("_motion.tsv")) ++recordings;
    if (!name.ends_with(".db")) continue;
    succeeded(study.run({"verify", study.in("bids/" + name), "--key", study.in("C.db.key")}));
    ++copies;
  }
  CHECK(copies == 1);
  CHECK(recordings == 4 * 6);
}

TEST_CASE("the summary of a merge lists the collected sessions and the key") {
  const SimulatedStations study;
  const ProgramResult ran =
      succeeded(study.merge({"s1.db", "s3.db", "s1.db"}, {"-o", study.in("C.db"), "--json"}));
  const json summary = json::parse(ran.output);
  CHECK(summary.at("stations") == 2);
  CHECK(summary.at("sessions") == 4);
  CHECK(summary.at("left_out") == json::array());
  CHECK(summary.at("superfluous") == json::array({study.in("s1.db")}));
  CHECK(summary.at("key") == study.in("C.db.key"));
  CHECK(content(study.in("C.db.key")) == content(study.in("s1.db.key")));
  CHECK_THAT(ran.errors, holds_text("s1.db"));
}

TEST_CASE("a merged study has the consents beside its stations, and nothing else of the people") {
  const SimulatedStations study;
  for (const std::string consent :
       {"@s1.db --participant P001 --version 3", "@s1.db --participant P001 --version 4",
        "@s3.db --participant P003 --version 4"}) {
    succeeded(study.type("consent " + consent + " --details -", {},
                         "age: 34\ncontact: ann@example.org\n"));
  }
  const ProgramResult ran =
      succeeded(study.merge({"s1.db", "s3.db", "s1.db"}, {"-o", study.in("C.db"), "--json"}));
  CHECK(json::parse(ran.output).at("consents") == 3);
  study.done("export @C.db --format csv -o @out");
  CHECK(content(study.in("out/consents.csv")) ==
        "participant,consent,consent_version,simulated\nP001,1,3,1\nP001,2,4,1\nP003,1,4,1\n");
  const std::string kept = content(study.in("C.db.personal"));
  CHECK(kept.find("P003") != std::string::npos);
  CHECK(kept.find("ann@") == std::string::npos);
  study.done("export @C.db --participant P003 --out @one");
  CHECK(content(study.in("one/P003_personal.csv")).ends_with(",,,\n"));
}

TEST_CASE("a database that lacks records of its head file is not merged") {
  const StudyFolder study;
  const std::string two = "simulate @cloths.json --participants 2 --seed 3 --subject @quick.json ";
  study.done(two + "--db @s1.db");
  study.done(two + "--first-participant 3 --db @s3.db");
  fs::copy_file(study.in("s1.db"), study.in("older.db"));
  study.done("note @s1.db --participant P001 late");
  fs::copy_file(study.in("older.db"), study.in("s1.db"), fs::copy_options::overwrite_existing);
  const auto merge = [&] { return study.type("merge @s1.db @s3.db -o @C.db"); };
  check_refused(merge(), 3, {"s1.db"});
  CHECK_FALSE(fs::exists(study.in("C.db")));
  study.done("note @s1.db --participant P001 late --accept-loss 'an older copy'");
  succeeded(merge());
  fs::remove(study.in("C.db"));
  fs::copy_file(study.in("older.db"), study.in("s1.db"), fs::copy_options::overwrite_existing);
  fs::remove(study.in("s1.db.head"));
  succeeded(merge());
}

TEST_CASE("the key of a study with people is not copied") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  int number = 0;
  for (const std::string participant : {"P01", "P02"}) {
    succeeded(study.session(participant, {"--enrolment", std::to_string(++number), "--yes"},
                            participant + ".db"));
    fs::copy_file(study.in("cloths.key"), study.in(participant + ".db.key"));
  }
  const ProgramResult ran = study.done("merge @P01.db @P02.db -o @C.db");
  CHECK(ran.output.find("--key") != std::string::npos);
  CHECK_FALSE(fs::exists(study.in("C.db.key")));
  study.done("verify @C.db --key @cloths.key");
  check_refused(study.session("P03", {}, "C.db"), 1, {"C.db"});
}

TEST_CASE("a merge of an altered station file ends like its verification") {
  const SimulatedStations study;
  {
    SQLite::Database raw(study.in("s3.db"), SQLite::OPEN_READWRITE);
    raw.exec("UPDATE participant_keys SET wrapped = x'00' WHERE session = 1");
  }
  check_refused(study.merge({"s1.db", "s3.db"}, {"-o", study.in("C.db")}), 3, {"s3.db"});
  CHECK(study.type("verify @s3.db").exit_code == 3);
  CHECK_FALSE(fs::exists(study.in("C.db")));
}

TEST_CASE("a refused merge names the file, and makes none") {
  const SimulatedStations study;
  study.write_study({{"seed", 12}}, "other.json");
  study.done("simulate @other.json --participants 1 --subject @quick.json --db @other.db");
  check_refused(study.merge({"s1.db", "other.db"}, {"-o", study.in("C.db")}), 1,
                {"s1.db other.db", "[other-study]"});
  check_refused(study.merge({"s1.db", "one.db"}, {"-o", study.in("C.db")}), 1, {"s1.db one.db"});
  CHECK_FALSE(fs::exists(study.in("C.db")));
  check_refused(study.merge({"s1.db", "s3.db"}, {"-o", study.in("one.db")}), 1, {"one.db: exists"});
  replace_file(study.in("D.db.key"), content(study.in("other.db.key")), FileMode::owner_only);
  check_refused(study.merge({"s1.db", "s3.db"}, {"-o", study.in("D.db")}), 1, {"D.db.key: "});
  CHECK_FALSE(fs::exists(study.in("D.db")));
  CHECK(study.merge({"s1.db"}).exit_code == 2);
  CHECK(study.merge({}, {"-o", study.in("C.db")}).exit_code == 2);
}

TEST_CASE("a merged database that lacks a station, or a station's end, is named by a head file") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  study.done("plan @cloths.json --participants 6 --names attic,cellar");
  const auto come = [&](const std::string& participant, const std::string& station) {
    study.done("run @cloths.json --participant " + participant + " --station " + station +
               " --db @" + station + ".db --subject @quick.json");
  };
  come("P01", "attic");
  come("P02", "cellar");
  study.done("merge @attic.db @cellar.db -o @all.db");
  study.done("merge @attic.db -o @attic-alone.db");
  const auto stations = [&](const std::string& database, const std::vector<std::string>& heads) {
    std::vector<std::string> more;
    for (const std::string& head : heads) more.insert(more.end(), {"--head-file", study.in(head)});
    const ProgramResult result =
        study.type("verify @" + database + " --key @cloths.key --json", more);
    const json verified = json::parse(result.output);
    for (const json& check : verified.at("checks")) {
      if (check.at("name") != "stations") continue;
      CHECK(result.exit_code == (check.at("state") == "failed" ? 3 : 0));
      return check.at("state").get<std::string>();
    }
    return std::string();
  };
  const std::vector<std::string> both = {"attic.db.head", "cellar.db.head"};
  CHECK(stations("all.db", {}) == "passed");
  CHECK(stations("all.db", both) == "passed");
  CHECK(stations("attic-alone.db", {}) == "not-checked");
  CHECK(stations("attic-alone.db", {"attic.db.head"}) == "not-checked");
  CHECK(stations("attic-alone.db", both) == "failed");
  come("P03", "attic");
  CHECK(stations("all.db", {}) == "passed");
  CHECK(stations("all.db", both) == "failed");
}
