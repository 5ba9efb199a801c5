// A study from its file to its tables, run as a user runs it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

constexpr const char* kOnIdeal = "simulated on: ideal ";

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

json registered_looks(const std::vector<int>& looks) {
  return {{"registration", {{"participants", 8}, {"estimand", "mean-accuracy"}, {"looks", looks}}}};
}

}  // namespace

TEST_CASE("a study goes from its file to an accuracy table that adds up") {
  const StudyFolder study;
  const ProgramResult simulated = succeeded(study.simulate("a.db"));
  CHECK(simulated.output.find("SIMULATED") != std::string::npos);
  CHECK(first_line(simulated.output).starts_with(kOnIdeal));

  const json report = study.printed("report @a.db --json");
  CHECK(report.at("participants") == 4);
  CHECK(report.at("trials") == 4 * 6);
  CHECK(report.at("classes") == json(kLabels));
  CHECK(report.at("simulated") == true);
  CHECK(report.at("simulated_on").get<std::string>().starts_with("ideal "));
  const json& method = report.at("methods").at(0);
  int correct = 0;
  for (std::size_t i = 0; i < kLabels.size(); ++i) {
    int row = method.at("no_response").at(i).get<int>();
    for (const json& count : method.at("confusion").at(i)) row += count.get<int>();
    CHECK(row == 8);  // every class twice for each participant
    correct += method.at("confusion").at(i).at(i).get<int>();
  }
  CHECK(method.at("overall").at("correct") == correct);
  CHECK(method.at("overall").at("n") == 24);

  const ProgramResult text = study.done("report @a.db");
  CHECK(text.output.find("SIMULATED") != std::string::npos);
  CHECK(first_line(text.output).starts_with(kOnIdeal));
  CHECK(text.output.find("corduroy") != std::string::npos);
}

TEST_CASE("numbers name the modelled device that they were simulated on, blind or not") {
  const StudyFolder study;
  const ProgramResult simulated =
      succeeded(study.simulate("t.db", {"--on", "omni", "--keep-blind", "--json"}));
  CHECK(json::parse(simulated.output).at("simulated_on").get<std::string>().ends_with(" touch"));
  const auto reported = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"report", study.in("t.db")});
    return study.run(more).output;
  };
  CHECK(first_line(reported({})).ends_with(" touch"));
  CHECK(
      json::parse(reported({"--json"})).at("simulated_on").get<std::string>().ends_with(" touch"));
  study.done("close @t.db --yes");
  study.done("unblind @t.db --reason done --yes");
  CHECK(first_line(reported({})).ends_with(" touch"));
  CHECK(
      json::parse(reported({"--json"})).at("simulated_on").get<std::string>().ends_with(" touch"));
  study.done("report @t.db --out @page");
  CHECK_THAT(content(study.path() / "page" / "report.html"), holds_text("simulated on: "));
  study.done("export @t.db --format csv --out @csv");
  CHECK(json::parse(content(study.path() / "csv" / "export.json"))
            .at("simulated_on")
            .get<std::string>()
            .ends_with(" touch"));
}

TEST_CASE("exports and reports are the same bytes for a seed, whatever the number of jobs") {
  const StudyFolder study("comparison");
  succeeded(study.simulate("one.db", {"--jobs", "1"}));
  succeeded(study.simulate("three.db", {"--jobs", "3"}));
  for (const std::string format : {"csv", "json"}) {
    study.done("export @one.db --out @1 --format " + format);
    study.done("export @three.db --out @3 --format " + format);
  }
  int files = 0;
  for (const auto& entry : fs::directory_iterator(study.path() / "1")) {
    INFO(entry.path());
    CHECK(content(entry.path()) == content(study.path() / "3" / entry.path().filename()));
    ++files;
  }
  CHECK(files >= 5);
  CHECK(study.type("report @one.db --json").output == study.type("report @three.db --json").output);
}

TEST_CASE("a blind study's database and pack name no class and no picture") {
  const StudyFolder study;
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  std::vector<fs::path> files = {study.path() / "a.db"};
  for (const auto& entry : fs::directory_iterator(study.path() / "cloths.sim.pack")) {
    files.push_back(entry.path());
  }
  REQUIRE(files.size() >= 1 + 1 + kLabels.size());
  for (const fs::path& file : files) {
    const std::string bytes = content(file);
    for (const std::string& label : kLabels) {
      INFO(file << " and " << label);
      CHECK(bytes.find(label) == std::string::npos);
      CHECK(file.filename().string().find(label) == std::string::npos);
    }
    CHECK(bytes.find("photo") == std::string::npos);
  }
}

TEST_CASE("before unblinding, report and export show quality and no outcome") {
  const StudyFolder study;
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  const ProgramResult reported = study.done("report @a.db --json");
  const json quality = json::parse(reported.output);
  CHECK(quality.at("participants") == 4);
  CHECK_FALSE(quality.contains("methods"));
  for (const std::string& label : kLabels) {
    CHECK(reported.output.find(label) == std::string::npos);
  }
  study.done("export @a.db --out @csv");
  for (const std::string format : {"r", "events"}) {
    check_refused(study.type("export @a.db --out @none --format " + format), 1, {"unblind"});
    CHECK_FALSE(fs::exists(study.path() / "none"));
  }
  const std::string trials = content(study.path() / "csv" / "trials.csv");
  const std::string header = trials.substr(0, trials.find('\n'));
  for (const std::string column : {"class", "exemplar", "method", "response", "correct"}) {
    CHECK(("," + header + ",").find("," + column + ",") == std::string::npos);
  }
  CHECK_FALSE(fs::exists(study.path() / "csv" / "confusion_adaptive.csv"));
}

TEST_CASE("outcomes show only after closing and unblinding, which are recorded") {
  const StudyFolder study;
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  CHECK(study.type("unblind @a.db --reason curious --yes").exit_code == 1);
  CHECK(study.type("unblind @a.db --yes").exit_code == 2);
  study.done("close @a.db --yes");
  CHECK(study.type("close @a.db --yes").exit_code == 1);
  study.done("unblind @a.db --reason 'collection is over' --yes");
  const json report = study.printed("report @a.db --json");
  CHECK(report.contains("methods"));
  study.done("verify @a.db");
}

TEST_CASE("an interim look is possible before closing, if it is declared as one") {
  const StudyFolder study;
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  study.done("unblind @a.db --reason safety --interim --yes");
  CHECK(study.printed("report @a.db --json").contains("methods"));
}

TEST_CASE("a registered look shows the registered question alone") {
  const StudyFolder study;
  study.write_study(registered_looks({4}));
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  const auto look = [&](const std::vector<std::string>& more) {
    return study.type("unblind @a.db --interim --reason plan --yes", more);
  };
  succeeded(look({}));

  const json report = study.printed("report @a.db --json");
  CHECK(report.at("question_alone") == true);
  CHECK(report.at("looks").at(0).at("kind") == "registered");
  CHECK(report.at("primary").at("choices").size() == 1);
  CHECK(report.at("primary").at("level") < report.at("primary").at("alpha"));
  CHECK(report.at("prevalence").is_null());
  CHECK_FALSE(report.contains("methods"));
  const std::string text = study.type("report @a.db").output;
  CHECK_THAT(text, holds_text("INTERIM LOOK"));
  CHECK_THAT(text, !holds_text("granite  "));
  study.done("report @a.db -o @page");
  CHECK_FALSE(fs::exists(study.path() / "page" / "figures"));

  study.done("export @a.db --out @csv");
  CHECK_FALSE(fs::exists(study.path() / "csv" / "confusion_adaptive.csv"));
  CHECK_THAT(content(study.path() / "csv" / "trials.csv"), !holds_text("granite"));
  CHECK_THAT(content(study.path() / "csv" / "participants.csv"), !holds_text("order_block"));
  for (const char* const blind : {"export @a.db --format r --out @r", "fit @a.db",
                                  "export @a.db --participant P001 --key @a.db.key --out @one"}) {
    CHECK(study.type(blind).exit_code != 0);
  }

  CHECK(study.type("status @a.db").exit_code == 0);
  const json quoted = study.printed("report @a.db --json");
  succeeded(look({"--unregistered"}));
  const json all = study.printed("report @a.db --json");
  CHECK(all.contains("methods"));
  CHECK(all.at("looks").at(1).at("kind") == "unregistered");
  CHECK_FALSE(all.at("departures").empty());
  CHECK(all.at("primary").at("estimate") == quoted.at("primary").at("estimate"));
}

TEST_CASE("a session of a study that is not prepared names the command that prepares it") {
  const StudyFolder study;
  check_refused(study.type("run @cloths.json --participant P01 --db @study.db"), 2,
                {"touchtrial prepare "});
  CHECK_FALSE(fs::exists(study.path() / "study.db"));
}

TEST_CASE("an interim look at a number of participants that was not registered is refused") {
  const StudyFolder study;
  study.write_study(registered_looks({3, 6}));
  succeeded(study.simulate("a.db", {"--keep-blind"}));
  check_refused(study.type("unblind @a.db --interim --reason curious"), 1,
                {"4 participants", "3 and 6"});
  CHECK_FALSE(study.printed("report @a.db --json").contains("primary"));
}

TEST_CASE("outcomes need the study's own key") {
  const StudyFolder study;
  succeeded(study.simulate("a.db"));
  fs::rename(study.path() / "a.db.key", study.path() / "elsewhere.key");
  check_refused(study.type("report @a.db"), 1, {"a.db.key --key"});
  study.done("report @a.db --key @elsewhere.key");

  study.write_study({{"seed", 12}}, "other.json");
  study.done("simulate @other.json --participants 1 --db @other.db --subject @quick.json");
  check_refused(study.type("report @a.db --key @other.db.key"), 3, {"other.db.key"});
  CHECK(study.type("verify @a.db --key @other.db.key").exit_code == 3);
}

TEST_CASE("verify reports another head and a truncated database as findings, with exit 3") {
  const StudyFolder study;
  succeeded(study.simulate("a.db"));
  const auto verified = [&](const std::vector<std::string>& more) {
    return study.type("verify @a.db --json", more);
  };
  const json whole = json::parse(verified({}).output);
  CHECK(whole.at("complete") == true);
  const std::string head = whole.at("head").at("hash");
  succeeded(verified({"--head", head}));
  CHECK(verified({"--head", std::string(64, '0')}).exit_code == 3);
  CHECK(verified({"--head", "12"}).exit_code == 2);

  fs::resize_file(study.path() / "a.db", fs::file_size(study.path() / "a.db") / 2);
  const ProgramResult cut = verified({});
  CHECK(cut.exit_code == 3);
  CHECK(json::parse(cut.output).at("checks").at(0).at("state") == "failed");
  CHECK(study.type("verify @none.db").exit_code == 1);
}

TEST_CASE("a bad study file is refused with exit 2, its name and the place") {
  const StudyFolder study;
  study.write_study({{"trials", {{"repeat", 5}}}}, "bad.json");
  for (const std::string line : {"prepare @bad.json", "simulate @bad.json --db @bad.db"}) {
    check_refused(study.type(line), 2, {"bad.json", "/trials/repeat", "repeats"});
  }
  CHECK_FALSE(fs::exists(study.path() / "bad.db"));
}

TEST_CASE("simulate does not replace a key that belongs to something else") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  const std::string key = content(study.path() / "cloths.key");
  check_refused(study.simulate("cloths"), 1, {"cloths.key"});
  CHECK(content(study.path() / "cloths.key") == key);
  CHECK_FALSE(fs::exists(study.path() / "cloths"));
}

TEST_CASE("a removed database can be made again beside its key") {
  const StudyFolder study;
  succeeded(study.simulate("a.db"));
  fs::remove(study.path() / "a.db");
  succeeded(study.simulate("a.db"));
}

TEST_CASE("a seed that is not a 64-bit whole number is refused") {
  const StudyFolder study;
  for (const std::string seed : {"-1", "18446744073709551616", "0x10", "1.5", ""}) {
    INFO(seed);
    check_refused(study.simulate("a.db", {}, seed), 2, {"--seed"});
  }
}
