// Messages as the service's documentation shows them, and others.
#include "device/drivers/inverse3/service_messages.hpp"

#include "support/catch.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using device::inverse3::BadMessage;
using device::inverse3::ServiceVersion;
using nlohmann::json;

constexpr ServiceVersion kOld{3, 1};
constexpr ServiceVersion kNew{3, 5};

/// An inventory of version 3.5.
json new_inventory() {
  return json::parse(R"({
    "session_id": 7,
    "inverse3": [{
      "device_id": "049D",
      "config": {
        "type": "inverse3", "port": "COM12", "handedness": "right",
        "device_info": {"major_version": 7, "minor_version": 4, "id": "049D", "device_type": 4},
        "gravity_compensation": {"enabled": true, "scaling_factor": 0.8},
        "torque_scaling": {"enabled": true},
        "preset": "defaults", "basis": {"permutation": "XYZ"},
        "mount": {"position": {"x": 0, "y": 0, "z": 0},
                  "rotation": {"w": 1, "x": 0, "y": 0, "z": 0},
                  "scale": {"x": 1, "y": 1, "z": 1}},
        "filters": {"force_gate": {"gain": 0.3}, "damping": {"scalar": 0.0}}},
      "state": {
        "cursor_position": {"x": 0.01, "y": -0.12, "z": 0.15},
        "cursor_velocity": {"x": 0.0, "y": 0.5, "z": 0},
        "current_cursor_force": {"x": 0.0, "y": 0.0, "z": 1.5},
        "transform": {"position": {"x": 0, "y": 0, "z": 0}, "scale": {"x": 1, "y": 1, "z": 1}}},
      "status": {"calibrated": true, "in_use": true, "power_supply": true, "ready": true,
                 "started": true}}]})");
}

TEST_CASE("an Inverse3's inventory gives place, status and configuration") {
  const auto report = device::inverse3::parse_report(new_inventory().dump());
  CHECK(report.session_id == 7);
  REQUIRE(report.devices.size() == 1);
  const auto& device = report.devices[0];
  CHECK(device.id == "049D");
  CHECK(device.position_m == Vec3{0.01, -0.12, 0.15});
  CHECK(device.velocity_m_s == Vec3{0.0, 0.5, 0.0});
  CHECK(device.delivered_n == Vec3{0.0, 0.0, 1.5});
  REQUIRE(device.status);
  CHECK(device.status->is_usable());
  REQUIRE(device.config);
  CHECK(device.config->firmware == "7.4");
  CHECK(device.config->preset == "defaults");
  CHECK(device.config->force_gate == 0.3);
  CHECK(device.config->damping == 0.0);
  CHECK(device.config->torque_scaling == true);
  CHECK(device.config->gravity_compensation == 0.8);
  CHECK(device.config->handedness == "right");
  CHECK_FALSE(device.config->home_return);
  CHECK(device.config->plain_frame);
}

TEST_CASE("an Inverse3 is usable if it has power and is calibrated, ready and started") {
  for (const char* const key : {"calibrated", "power_supply", "ready", "started"}) {
    json inventory = new_inventory();
    inventory["inverse3"][0]["status"][key] = false;
    INFO(key);
    CHECK_FALSE(device::inverse3::parse_report(inventory.dump()).devices[0].status->is_usable());
  }
  json inventory = new_inventory();
  inventory["inverse3"][0]["status"]["in_use"] = false;
  CHECK(device::inverse3::parse_report(inventory.dump()).devices[0].status->is_usable());
}

TEST_CASE("a frame of an Inverse3 that somebody has turned or scaled is no plain one") {
  const std::vector<std::pair<std::string, json>> changes = {
      {"/inverse3/0/config/basis/permutation", "XZY"},
      {"/inverse3/0/config/mount/scale/y", 0.5},
      {"/inverse3/0/state/transform/scale/x", 2.0}};
  for (const auto& [place, value] : changes) {
    json inventory = new_inventory();
    inventory[json::json_pointer(place)] = value;
    INFO(place);
    CHECK_FALSE(device::inverse3::parse_report(inventory.dump()).devices[0].config->plain_frame);
  }
}

TEST_CASE("the directional part of an Inverse3's damping counts too") {
  json inventory = new_inventory();
  inventory["inverse3"][0]["config"]["filters"]["damping"]["vector"] = {
      {"x", 0.0}, {"y", -1.5}, {"z", 0.0}};
  CHECK(device::inverse3::parse_report(inventory.dump()).devices[0].config->damping == 1.5);
}

TEST_CASE("a state of an Inverse3 without configuration or force is whole") {
  json state = new_inventory();
  state["inverse3"][0].erase("config");
  state["inverse3"][0].erase("status");
  state["inverse3"][0]["state"].erase("current_cursor_force");
  state.erase("session_id");
  const auto report = device::inverse3::parse_report(state.dump());
  CHECK_FALSE(report.session_id);
  CHECK_FALSE(report.devices[0].config);
  CHECK_FALSE(report.devices[0].status);
  CHECK_FALSE(report.devices[0].delivered_n);
  CHECK(device::inverse3::parse_report("{}").devices.empty());
}

TEST_CASE("messages of an Inverse service that make no sense are refused") {
  const std::vector<std::pair<std::string, json>> changes = {
      {"/inverse3", "049D"},
      {"/inverse3/0", 3},
      {"/inverse3/0/device_id", 49},
      {"/inverse3/0/state", json::array()},
      {"/inverse3/0/state/cursor_position", nullptr},
      {"/inverse3/0/state/cursor_position/x", "0"},
      {"/inverse3/0/state/cursor_velocity/z", nullptr},
      {"/inverse3/0/state/current_cursor_force/z", nullptr},
      {"/inverse3/0/status/calibrated", 1},
      {"/inverse3/0/status", 1},
      {"/inverse3/0/config/filters/force_gate", 0.3},
      {"/inverse3/0/config/filters/damping", nullptr}};
  for (const auto& [place, value] : changes) {
    json inventory = new_inventory();
    inventory[json::json_pointer(place)] = value;
    INFO(place);
    CHECK_THROWS_AS(device::inverse3::parse_report(inventory.dump()), BadMessage);
  }
  const std::string whole = new_inventory().dump();
  for (const std::string& text :
       {std::string(), std::string("7"), std::string("[]"), std::string("nonsense"),
        whole.substr(0, whole.size() / 2), std::string(100'000, '[')}) {
    CHECK_THROWS_AS(device::inverse3::parse_report(text), BadMessage);
  }
  // What is nested deeply, and of no concern, exhausts nothing.
  json deep = new_inventory();
  std::string nested = deep.dump();
  nested.insert(1, "\"more\": " + std::string(200'000, '[') + std::string(200'000, ']') + ", ");
  CHECK(device::inverse3::parse_report(nested).devices.size() == 1);
  CHECK(device::inverse3::parse_report(R"({"ok": true, "data": )" + nested + "}").devices.size() ==
        1);
  // Not JSON, though some programs write it.
  std::string infinite = whole;
  infinite.replace(infinite.find("1.5"), 3, "Infinity");
  CHECK_THROWS_AS(device::inverse3::parse_report(infinite), BadMessage);
  infinite.replace(infinite.find("Infinity"), 8, "1e999");
  CHECK_THROWS_AS(device::inverse3::parse_report(infinite), BadMessage);
}

TEST_CASE("buttons of a grip beside an Inverse3 are bits, and odd grips have none") {
  const auto buttons = [](const char* grips) {
    return device::inverse3::parse_report(grips).buttons;
  };
  CHECK(buttons(R"({"wireless_verse_grip": [{"state": {"buttons": {"a": true, "c": true}}}]})") ==
        5);
  CHECK(buttons(R"({"verse_grip": [{"state": {"button": true}}]})") == 1);
  CHECK(buttons(R"({"verse_grip": [{"state": {"button": 1}}]})") == 0);
  CHECK(buttons(R"({"wireless_verse_grip": [7], "verse_grip": "none"})") == 0);
}

TEST_CASE("the version of an Inverse service is read with and without an envelope") {
  const auto version = device::inverse3::parse_version(
      R"({"git_tag": "3.5.0", "project_version": "3.5.1.0", "project_name": "x"})");
  CHECK(version.text() == "3.5");
  CHECK(version.has_filters());
  CHECK(device::inverse3::parse_version(R"({"ok": true, "data": {"git_tag": "3.1.1"}})").text() ==
        "3.1");
  CHECK_FALSE(kOld.has_filters());
  CHECK(kOld.is_supported());
  CHECK_FALSE(ServiceVersion{3, 0}.is_supported());
  CHECK_FALSE(ServiceVersion{4, 0}.is_supported());
  for (const char* const text : {R"({"project_version": "main"})", R"({"project_version": "3"})",
                                 R"({"project_version": "3.x"})", "{}", "3.5"}) {
    CHECK_THROWS_AS(device::inverse3::parse_version(text), BadMessage);
  }
}

TEST_CASE("sessions of an Inverse service are counted and named") {
  const auto names = device::inverse3::parse_sessions(
      R"({"ok": true, "data": {"session_count": 2,
          "sessions": [{"session_id": 7, "profile": {"name": "touchtrial"}}, {"session_id": 3}]}})");
  CHECK(names == std::vector<std::string>{"touchtrial", ""});
  CHECK_THROWS_AS(device::inverse3::parse_sessions(R"({"ok": false, "error": "no"})"), BadMessage);
}

TEST_CASE("an event of an Inverse service names the event and the device") {
  const auto event = device::inverse3::parse_event(
      R"({"name": "device-safety-triggered", "category": "device", "level": "error",
          "data": {"device_family": "inverse", "device_id": "049D",
                   "safety_type": "ebrake_triggered"}, "message": "brake"})");
  CHECK(event.name == "device-safety-triggered");
  CHECK(event.safety_type == "ebrake_triggered");
  CHECK(event.device_id == "049D");
  CHECK_THROWS_AS(device::inverse3::parse_event("{}"), BadMessage);
}

TEST_CASE("a force for an Inverse3 is a vector from version 3.5 on, and values before") {
  const json ours = json::parse(device::inverse3::force_message(kNew, "049D", {1.0, -2.0, 0.5}));
  CHECK(ours == json::parse(R"({"inverse3": [{"device_id": "049D", "commands": {"set_cursor_force":
      {"vector": {"x": 1.0, "y": -2.0, "z": 0.5}}}}]})"));
  const json old = json::parse(device::inverse3::force_message(kOld, "049D", {1.0, -2.0, 0.5}));
  CHECK(old.at("/inverse3/0/commands/set_cursor_force"_json_pointer) ==
        json::parse(R"({"values": {"x": 1.0, "y": -2.0, "z": 0.5}})"));
}

TEST_CASE("the first message to an Inverse service identifies us and switches filters off") {
  const json first = json::parse(device::inverse3::first_message(kNew, "049D"));
  CHECK(first == json::parse(R"({
      "session": {"configure": {"profile": {"name": "touchtrial"}}},
      "inverse3": [{"device_id": "049D",
        "configure": {"preset": {"preset": "arm_front_centered"}, "force_gate": {"gain": 0.0},
                      "damping": {"scalar": 0.0, "vector": {"x": 0.0, "y": 0.0, "z": 0.0}}},
        "commands": {"set_cursor_force": {"vector": {"x": 0.0, "y": 0.0, "z": 0.0}}}}]})"));
  const json old = json::parse(device::inverse3::first_message(kOld, "049D"));
  CHECK(old == json::parse(R"({"inverse3": [{"device_id": "049D", "commands": {"set_cursor_force":
      {"values": {"x": 0.0, "y": 0.0, "z": 0.0}}}}]})"));
  const json request = json::parse(device::inverse3::inventory_request(kNew, "049D"));
  CHECK(request.at("session") == json::parse(R"({"force_render_full_state": {}})"));
}

}  // namespace
}  // namespace touchtrial
