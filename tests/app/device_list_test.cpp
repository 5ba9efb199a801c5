#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using nlohmann::json;

namespace {

/// The test's own settings, so that the user's settings do not matter.
std::string settings_in(const TempFolder& folder, const std::string& text = "{}") {
  const auto file = folder.path() / "devices.json";
  replace_file(file, text);
  return file.string();
}

}  // namespace

TEST_CASE("device list names every driver and which devices are ready") {
  const TempFolder folder;
  const ProgramResult result =
      run_touchtrial(folder.path(), {"device", "list", "--settings", settings_in(folder)});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.output, holds_text("driver") && holds_text("state"));
  CHECK_THAT(result.output, holds_text("simulated") && holds_text("ready"));
}

TEST_CASE("device list prints the same as JSON") {
  const TempFolder folder;
  const ProgramResult result = run_touchtrial(
      folder.path(), {"device", "list", "--json", "--settings", settings_in(folder)});
  REQUIRE(result.exit_code == 0);
  const json devices = json::parse(result.output).at("devices");
  const auto simulated = std::ranges::find_if(
      devices, [](const json& device) { return device.at("driver") == "simulated"; });
  REQUIRE(simulated != devices.end());
  CHECK(simulated->at("present") == true);
  CHECK(simulated->at("ready") == true);
  CHECK(simulated->at("missing").empty());
  CHECK(simulated->at("products").empty());
  const auto dhd = std::ranges::find_if(
      devices, [](const json& device) { return device.at("driver") == "dhd"; });
  REQUIRE(dhd != devices.end());
  CHECK(dhd->at("products").at(0).at("name") == "omega");
  for (const char* key : {"model", "serial", "where"}) CHECK(simulated->at(key).is_string());
}

TEST_CASE("device list says what a device renders, for studies") {
  const TempFolder folder;
  const std::string settings =
      settings_in(folder, R"({"openhaptics": {"library": ")" TOUCHTRIAL_FAKE_HD R"("}})");
  const ProgramResult result =
      run_touchtrial(folder.path(), {"device", "list", "--settings", settings});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.output, holds_text("renders a stiffness of at most 0.4 N/mm and a damping of"));
}

TEST_CASE("device list refuses settings that break their schema with the place") {
  const TempFolder folder;
  const std::string settings = settings_in(folder, R"({"falcon": {"firmwear": "x"}})");
  const ProgramResult result =
      run_touchtrial(folder.path(), {"device", "list", "--settings", settings});
  CHECK(result.exit_code == 2);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("/falcon/firmwear") && holds_text("firmware"));
}

TEST_CASE("device models lists the shipped models, with a mark at every guess") {
  const TempFolder folder;
  const ProgramResult table = run_touchtrial(folder.path(), {"device", "models"});
  REQUIRE(table.exit_code == 0);
  CHECK_THAT(table.output, holds_text("touch") && holds_text("Novint Falcon"));
  CHECK_THAT(table.output, holds_text("0.15?") && holds_text("6.5"));
  const ProgramResult result = run_touchtrial(folder.path(), {"device", "models", "--json"});
  REQUIRE(result.exit_code == 0);
  const json models = json::parse(result.output).at("models");
  const auto falcon =
      std::ranges::find_if(models, [](const json& model) { return model.at("name") == "falcon"; });
  REQUIRE(falcon != models.end());
  CHECK(falcon->at("max_force_n") == 6.5);
  CHECK(falcon->at("provenance").at("max_force_n").at("confidence") == "derived");
}

TEST_CASE("the command device requires a command of its own") {
  const TempFolder folder;
  CHECK(run_touchtrial(folder.path(), {"device"}).exit_code == 2);
  const ProgramResult help = run_touchtrial(folder.path(), {"device", "--help"});
  CHECK(help.exit_code == 0);
  CHECK_THAT(help.output, holds_text("list"));
}
