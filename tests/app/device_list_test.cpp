#include "app/device_folder.hpp"
#include "support/catch.hpp"

#include <algorithm>

using namespace touchtrial;

namespace {

/// The row of a table in which this member has this value.
json row_with(const json& rows, const std::string& key, const std::string& value) {
  const auto found = std::ranges::find_if(rows, [&](const json& row) { return row[key] == value; });
  REQUIRE(found != rows.end());
  return *found;
}

}  // namespace

TEST_CASE("device list names every driver and which devices are ready, as text and as JSON") {
  const DeviceFolder folder;
  CHECK_THAT(succeeded(folder.device("list")).output, holds_text("driver") && holds_text("state") &&
                                                          holds_text("simulated") &&
                                                          holds_text("ready"));
  const json devices = json::parse(succeeded(folder.device("list --json")).output).at("devices");
  const json simulated = row_with(devices, "driver", "simulated");
  CHECK(simulated.at("present") == true);
  CHECK(simulated.at("ready") == true);
  CHECK(simulated.at("missing").empty());
  CHECK(simulated.at("products").empty());
  for (const char* key : {"model", "serial", "where"}) CHECK(simulated.at(key).is_string());
  CHECK(row_with(devices, "driver", "dhd").at("products").at(0).at("name") == "omega");
}

TEST_CASE("device list shows a device's rendering limits") {
  const DeviceFolder folder(json{{"openhaptics", {{"library", TOUCHTRIAL_FAKE_HD}}}});
  CHECK_THAT(succeeded(folder.device("list")).output, holds_text("0.4 N/mm"));
}

TEST_CASE("device list refuses settings that break their schema with the place") {
  const DeviceFolder folder(json{{"falcon", {{"firmwear", "x"}}}});
  check_refused(folder.device("list"), 2, {"/falcon/firmwear", "firmware"});
}

TEST_CASE("device models lists the shipped models, with a mark at every guess") {
  const DeviceFolder folder;
  CHECK_THAT(folder.done("device models").output, holds_text("touch") &&
                                                      holds_text("Novint Falcon") &&
                                                      holds_text("0.15?") && holds_text("6.5"));
  const json models = folder.printed("device models --json").at("models");
  const json falcon = row_with(models, "name", "falcon");
  CHECK(falcon.at("max_force_n") == 6.5);
  CHECK(falcon.at("provenance").at("max_force_n").at("confidence") == "derived");
}

TEST_CASE("the command device requires a command of its own") {
  check_refused(DeviceFolder().type("device"), 2, {"device --help"});
}
