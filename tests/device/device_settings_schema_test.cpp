// Holds the JSON Schema of device settings against their reader.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/registry.hpp"
#include "support/catch.hpp"
#include "support/schema_against_reader.hpp"

#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;

json schema_of_settings() {
  return json::parse(text_of(read_file(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) /
                                       "config/schema/devices.schema.json")));
}

SchemaAgainstReader settings() {
  const auto refusal = [](const json& file) -> std::string {
    try {
      static_cast<void>(device::parse_device_settings(file.dump(), "/lab", "devices.json"));
    } catch (const StudyError& error) {
      return error.what();
    }
    return "";
  };
  const auto complete = [](const SchemaAgainstReader::Pointer& place, json& file) {
    if (place.to_string().starts_with("/instruments/serial")) {
      file["instruments"]["serial"]["port"] = "/dev/ttyS0";
    }
  };
  return {schema_of_settings(), refusal, complete};
}

}  // namespace

TEST_CASE("the reader keeps keys, bounds, types and words of the schema of device settings") {
  const SchemaAgainstReader both = settings();
  CHECK(both.objects().size() == 1 + 8 + 8 + 5 + 3);
  both.check_keys();
  both.check_values();
  CHECK(both.check_bounds() == 2 * (5 + 1 + 5 + 3 + 8 * 4 + 5 + 3 + 5 * 4 + 1));
}

TEST_CASE("in the schema of device settings a product's section is that of its driver") {
  const json schema = schema_of_settings();
  int products = 0;
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    for (const std::string_view name : driver.names()) {
      if (name == driver.name) continue;
      INFO(name);
      CHECK(schema.at("properties").at(std::string(name)).at("$ref") ==
            "#/properties/" + driver.name);
      ++products;
    }
  }
  CHECK(products > 10);
}

TEST_CASE("the reader takes a scale as a number or as a list of three, as the schema does") {
  const SchemaAgainstReader both = settings();
  int scales = 0;
  for (const SchemaAgainstReader::Place& leaf : both.leaves()) {
    if (!leaf.is_one_of) continue;
    INFO(leaf.pointer.to_string());
    CHECK(both.refusal(leaf.pointer, 1.5).empty());
    CHECK(both.refusal(leaf.pointer, json::array({0.5, 1, 2})).empty());
    for (const json& value : {json("1"), json(true), json::object(), json(), json::array()})
      CHECK_FALSE(both.refusal(leaf.pointer, value).empty());
    ++scales;
  }
  CHECK(scales == 5 * 4);
}

TEST_CASE("the defaults of the schema of device settings are the reader's") {
  json file = settings().defaults();
  file["instruments"]["serial"]["port"] = "/dev/ttyS0";
  const device::DeviceSettings written =
      device::parse_device_settings(file.dump(), "/lab", "devices.json");
  const device::DeviceSettings bare;
  CHECK(written.instruments.serial.baud == bare.instruments.serial.baud);
  CHECK(written.instruments.serial.format == bare.instruments.serial.format);
  CHECK(written.instruments.serial.width == bare.instruments.serial.width);
  CHECK(written.instruments.serial.reset_ms == bare.instruments.serial.reset_ms);
  CHECK(written.instruments.lsl.name == bare.instruments.lsl.name);
  CHECK(written.falcon.serial == bare.falcon.serial);
  CHECK(written.falcon.gravity_bias_n == bare.falcon.gravity_bias_n);
  CHECK(written.falcon.led_order == bare.falcon.led_order);
  CHECK(written.falcon.motor_peak == bare.falcon.motor_peak);
  CHECK(written.falcon.motor_continuous == bare.falcon.motor_continuous);
  CHECK(written.falcon.motor_peak_s == bare.falcon.motor_peak_s);
  CHECK(written.openhaptics.library == bare.openhaptics.library);
  CHECK(written.openhaptics.device == bare.openhaptics.device);
  CHECK(written.openhaptics.rate_hz == bare.openhaptics.rate_hz);
  CHECK(written.dhd.library == bare.dhd.library);
  CHECK(written.dhd.index == bare.dhd.index);
  CHECK(written.dhd.gravity_compensation == bare.dhd.gravity_compensation);
  CHECK(written.dhd.effector_mass_kg == bare.dhd.effector_mass_kg);
  CHECK(written.plugin.settings == bare.plugin.settings);
  CHECK(written.inverse3.host == bare.inverse3.host);
  CHECK(written.inverse3.port == bare.inverse3.port);
  CHECK(written.inverse3.events_port == bare.inverse3.events_port);
  CHECK(written.inverse3.http_port == bare.inverse3.http_port);
  CHECK(written.inverse3.device_id == bare.inverse3.device_id);
  CHECK(written.inverse3.max_force_n == bare.inverse3.max_force_n);
}

}  // namespace touchtrial
