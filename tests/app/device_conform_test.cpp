// touchtrial device conform as the author of a driver runs it. Times are the machine's own, so that
// only what does not depend on them is expected.
#include "app/device_folder.hpp"
#include "support/catch.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;

namespace {

ProgramResult conform(const DeviceFolder& folder, const std::string& options) {
  return folder.device("conform --seconds 0.5 " + options);
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
  const ProgramResult result =
      conform(DeviceFolder(), TOUCHTRIAL_EXAMPLE_PLUGIN " --force --yes --json");
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

TEST_CASE("device conform sends force only on request, and asks for confirmation first") {
  const DeviceFolder folder;
  const json plain = json::parse(conform(folder, TOUCHTRIAL_EXAMPLE_PLUGIN " --json").output);
  CHECK(outcome(plain, "sends what it is told") == "not_observed");
  CHECK(outcome(plain, "zero when told zero") == "passed");
  check_refused(conform(folder, TOUCHTRIAL_EXAMPLE_PLUGIN " --force"), 2, {"0.3 N"});
}

TEST_CASE("device conform fails a broken plug-in with the check, and the exit code says so") {
  const DeviceFolder folder(json{
      {"plugin", {{"library", TOUCHTRIAL_BROKEN_PLUGIN}, {"settings", {{"fault", "workspace"}}}}}});
  const ProgramResult result = conform(folder, "plugin");
  INFO(result.output << result.errors);
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.output, holds_text("FAILED "));
  CHECK_THAT(result.output, holds_text("DOES NOT CONFORM"));
  const ProgramResult none = conform(folder, "./none.so --json");
  CHECK(none.exit_code == 1);
  CHECK(outcome(json::parse(none.output), "interface") == "failed");
  CHECK(outcome(json::parse(none.output), "opens") == "not_observed");
}

TEST_CASE("device conform finds a plug-in beside it that is named without a folder") {
  const DeviceFolder folder;
  fs::copy_file(TOUCHTRIAL_EXAMPLE_PLUGIN, folder.path() / "mine.so");
  testing::ChildProcess program = folder.start("conform mine.so --json --seconds 0.2");
  const int code = program.finish();
  INFO(program.output());
  CHECK((code == 0 || code == 1));
  CHECK(outcome(json::parse(program.output()), "interface") == "passed");
}

TEST_CASE("device conform checks the program's drivers too, but neither a mouse nor their motors") {
  const DeviceFolder folder;
  const json simulated = json::parse(conform(folder, "simulated --json").output);
  CHECK(outcome(simulated, "velocity fits position") == "passed");
  CHECK(outcome(simulated, "interface") == "no such check");
  const std::vector<std::pair<std::string, std::string>> refused = {
      {"mouse", "mouse"},
      {"simulated --force --yes", "'simulated' --force"},
      {"plugn", "plugn plugin"},
      {"simulated --seconds nan", "--seconds nan"}};
  for (const auto& [options, places] : refused) {
    INFO(options);
    check_refused(conform(folder, options), 2, {places});
  }
}
