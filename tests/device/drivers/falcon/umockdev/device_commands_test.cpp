// The program itself with a Falcon on a bus of umockdev: touchtrial device list, test and bring-up.
#include "core/files.hpp"
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/drivers/falcon/umockdev/umockdev_falcon.hpp"
#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial::device::falcon {
namespace {

using nlohmann::json;
using testing::ChildProcess;
using testing::EmulatorUsbModel;
using testing::UmockdevBus;

/// Settings that name a firmware of dummy bytes, or none.
std::string settings_in(const TempFolder& folder, bool with_firmware) {
  json settings = json::object();
  if (with_firmware) settings["falcon"]["firmware"] = write_dummy_firmware(folder.path()).string();
  const auto file = folder.path() / "devices.json";
  replace_file(file, settings.dump());
  return file.string();
}

/// The Falcon's entry of `device list --json`.
json listed(const UmockdevBus& bus, const std::string& settings) {
  ChildProcess program({TOUCHTRIAL_PROGRAM, "device", "list", "--json", "--settings", settings},
                       bus.environment());
  const int code = program.finish();
  INFO(program.output());
  REQUIRE(code == 0);
  const json all = json::parse(program.output());
  for (const json& device : all.at("devices")) {
    if (device.at("driver") == "falcon") return device;
  }
  FAIL("device list does not know the falcon");
  return {};
}

TEST_CASE("device list shows whether a Falcon is present, where, and what it lacks") {
  const TempFolder folder;
  UmockdevBus bus;
  CHECK(listed(bus, settings_in(folder, true)).at("present") == false);

  FalconEmulator emulator;
  EmulatorUsbModel model(emulator);
  bus.plug(model, {.serial = "AB12"});
  const json ready = listed(bus, settings_in(folder, true));
  CHECK(ready.at("ready") == true);
  CHECK(ready.at("serial") == "AB12");
  CHECK(ready.at("where") == "USB bus 1 port 2, address 7");
  const json without = listed(bus, settings_in(folder, false));
  CHECK(without.at("present") == true);
  CHECK(without.at("ready") == false);
  CHECK_THAT(without.at("missing").at(0).get<std::string>(), holds_text("falcon.firmware"));
  CHECK(emulator.loads() == 0);
}

/// A hand that waits at the front right, and moves the grip through its range to home it.
HandModel homing_hand(std::atomic<bool>& moves) {
  return [&moves, tick = 0](Vec3) mutable {
    if (!moves.load()) return Vec3{};
    return Vec3{0.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  };
}

TEST_CASE("device test guides through homing and ends with the motors at rest") {
  const TempFolder folder;
  std::atomic<bool> moves{false};
  UmockdevBus bus;
  FalconEmulator emulator({}, homing_hand(moves));
  EmulatorUsbModel model(emulator);
  bus.plug(model);
  ChildProcess test({TOUCHTRIAL_PROGRAM, "device", "test", "falcon", "--seconds", "0.5",
                     "--settings", settings_in(folder, true)},
                    bus.environment(), folder.path().string());
  REQUIRE(test.says("falcon: move the handle slowly through its whole range"));
  CHECK_FALSE(emulator.all_homed());
  moves = true;
  const int code = test.finish();
  INFO(test.output());
  // On some machines a thousand transfers a second are too many; then the driver reports a fault.
  const auto says = [&](const char* fault) {
    return code == 1 && test.output().find(fault) != std::string::npos;
  };
  const bool too_slow = says("falcon: fault while homing: stalled") ||
                        says("falcon: fault while homing: stale_sample");
  CHECK((emulator.all_homed() || too_slow));
  CHECK(emulator.motors() == std::array<std::int16_t, 3>{});
  CHECK(emulator.image() == dummy_firmware());
  if (code == 0) {
    CHECK_THAT(test.output(), holds_text("time was up"));
  } else {
    CHECK(code == 1);
    CHECK((too_slow || says("falcon: fault in the phase")));
  }
}

TEST_CASE("device bring-up of an emulated Falcon writes a file that says so") {
  const TempFolder folder;
  std::atomic<bool> moves{true};
  UmockdevBus bus;
  FalconEmulator emulator({}, homing_hand(moves));
  EmulatorUsbModel model(emulator);
  bus.plug(model);
  const std::string out = (folder.path() / "falcon.json").string();
  ChildProcess bring_up({TOUCHTRIAL_PROGRAM, "device", "bring-up", "falcon", "--out", out,
                         "--settings", settings_in(folder, true)},
                        bus.environment(), folder.path().string());
  // The rest is measured, all other steps are left out, and no question is answered.
  std::string lines = "\n";
  for (int step = 0; step < 13; ++step) lines += "s\n";
  for (int question = 0; question < 20; ++question) lines += "\n";
  bring_up.write(lines);
  const int code = bring_up.finish();
  INFO(bring_up.output());
  CHECK(emulator.motors() == std::array<std::int16_t, 3>{});
  // On some machines a thousand transfers a second are too many.
  if (bring_up.output().find("fault while homing") != std::string::npos) {
    CHECK(code == 1);
    return;
  }
  const json file = json::parse(text_of(read_file(out)));
  CHECK(file.at("driver") == "falcon");
  CHECK_FALSE(file.at("stand_in").get<std::string>().empty());
  CHECK(file.at("steps").at("open") == "done");
  CHECK(code == (file.at("ended") == "complete" ? 0 : 1));
  CHECK((file.at("ended") == "complete" || file.at("ended") == "fault"));
  if (file.at("ended") == "complete") CHECK(file.at("steps").at("rest") == "done");
}

}  // namespace
}  // namespace touchtrial::device::falcon
