// The program itself with a Falcon on a bus of umockdev: touchtrial device list and test.
#include "core/files.hpp"
#include "device/falcon/rig/falcon_rig.hpp"
#include "device/falcon/umockdev/umockdev_falcon.hpp"
#include "device/falcon/usbfs_shim/usb_model.hpp"
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
  if (code == 0) {
    CHECK_THAT(test.output(), holds_text("time was up"));
  } else {
    CHECK(code == 1);
    CHECK((too_slow || says("falcon: fault in the phase")));
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon
