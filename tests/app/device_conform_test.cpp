// touchtrial device conform as the author of a driver runs it. Times are the machine's own, so that
// only what does not depend on them is expected.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using nlohmann::json;

namespace {

ProgramResult conform(const TempFolder& folder, const json& settings,
                      const std::vector<std::string>& more) {
  replace_file(folder.path() / "devices.json", settings.dump());
  std::vector<std::string> words = {"device",     "conform",
                                    "--seconds",  "0.5",
                                    "--settings", (folder.path() / "devices.json").string()};
  words.insert(words.end(), more.begin(), more.end());
  return run_touchtrial(folder.path(), words);
}

std::string outcome(const json& report, const std::string& check) {
  for (const json& row : report.at("checks")) {
    if (row.at("check") == check) return row.at("outcome");
  }
  return "no such check";
}

/// Checks that a machine under load can fail.
bool is_of_time(const json& row) {
  static const std::set<std::string> kOfTime = {"rate", "no gaps", "short calls",
                                                "zero without a servo", "zero after halt"};
  return kOfTime.count(row.at("check")) > 0;
}

}  // namespace

TEST_CASE("device conform checks a plug-in's file, with force if that is permitted") {
  const TempFolder folder;
  const ProgramResult result =
      conform(folder, json::object(), {TOUCHTRIAL_EXAMPLE_PLUGIN, "--force", "--yes", "--json"});
  INFO(result.output << result.errors);
  const json report = json::parse(result.output);
  CHECK(report.at("target") == TOUCHTRIAL_EXAMPLE_PLUGIN);
  CHECK(report.at("checks").size() == 21);
  bool all_pass = true;
  for (const json& row : report.at("checks")) {
    INFO(row.dump());
    all_pass = all_pass && row.at("outcome") != "failed";
    if (is_of_time(row) || row.at("check") == "zero before ready") continue;
    CHECK(row.at("outcome") == "passed");
  }
  CHECK(report.at("conforms") == all_pass);
  CHECK(result.exit_code == (all_pass ? 0 : 1));
}

TEST_CASE("device conform sends no force unless it is told to, and asks before it does") {
  const TempFolder folder;
  const ProgramResult plain =
      conform(folder, json::object(), {TOUCHTRIAL_EXAMPLE_PLUGIN, "--json"});
  INFO(plain.output << plain.errors);
  CHECK(outcome(json::parse(plain.output), "sends what it is told") == "not_observed");
  CHECK(outcome(json::parse(plain.output), "zero when told zero") == "passed");
  const ProgramResult asked =
      conform(folder, json::object(), {TOUCHTRIAL_EXAMPLE_PLUGIN, "--force"});
  CHECK(asked.exit_code == 2);
  CHECK_THAT(asked.errors, holds_text("forces of 0.3 N") && holds_text("nothing was done"));
}

TEST_CASE("device conform fails a broken plug-in with the check, and the exit code says so") {
  const TempFolder folder;
  const json settings = {
      {"plugin", {{"library", TOUCHTRIAL_BROKEN_PLUGIN}, {"settings", {{"fault", "workspace"}}}}}};
  const ProgramResult result = conform(folder, settings, {"plugin"});
  INFO(result.output << result.errors);
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.output, holds_text("FAILED        inside its workspace"));
  CHECK_THAT(result.output, holds_text("DOES NOT CONFORM"));
  const ProgramResult none = conform(folder, settings, {"./none.so", "--json"});
  CHECK(none.exit_code == 1);
  CHECK(outcome(json::parse(none.output), "interface") == "failed");
  CHECK(outcome(json::parse(none.output), "opens") == "not_observed");
}

TEST_CASE("device conform finds a plug-in beside it that is named without a folder") {
  const TempFolder folder;
  std::filesystem::copy_file(TOUCHTRIAL_EXAMPLE_PLUGIN, folder.path() / "mine.so");
  replace_file(folder.path() / "devices.json", "{}");
  testing::ChildProcess program({TOUCHTRIAL_PROGRAM, "device", "conform", "mine.so", "--json",
                                 "--seconds", "0.2", "--settings", "devices.json"},
                                {}, folder.path().string());
  const int code = program.finish();
  INFO(program.output());
  CHECK((code == 0 || code == 1));
  CHECK(outcome(json::parse(program.output()), "interface") == "passed");
}

TEST_CASE("device conform checks the program's drivers too, but neither a mouse nor their motors") {
  const TempFolder folder;
  const ProgramResult simulated = conform(folder, json::object(), {"simulated", "--json"});
  INFO(simulated.output << simulated.errors);
  CHECK(outcome(json::parse(simulated.output), "velocity fits position") == "passed");
  CHECK(outcome(json::parse(simulated.output), "interface") == "no such check");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"mouse"},
                                                {"simulated", "--force", "--yes"},
                                                {"plugn"},
                                                {"simulated", "--seconds", "nan"}}) {
    const ProgramResult refused = conform(folder, json::object(), words);
    INFO(refused.errors);
    CHECK(refused.exit_code == 2);
    CHECK(line_count(refused.errors) == 1);
  }
}
