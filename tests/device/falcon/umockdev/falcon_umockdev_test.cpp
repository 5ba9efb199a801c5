// Falcons that other processes find, open and lose, on a bus of umockdev.
#include "device/falcon/rig/falcon_rig.hpp"
#include "device/falcon/umockdev/umockdev_falcon.hpp"
#include "device/falcon/usbfs_shim/usb_model.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"

#include <cmath>
#include <thread>

namespace touchtrial::device::falcon {
namespace {

using testing::ChildProcess;
using testing::EmulatorUsbModel;
using testing::UmockdevBus;

HandModel swinging_hand() {
  return [tick = 0](Vec3) mutable {
    return Vec3{0.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  };
}

bool wait_until_pushed(const FalconEmulator& emulator) {
  for (int i = 0; i < 30'000; ++i) {
    if (std::abs(emulator.force_n().z - 1.0) < 0.01) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST_CASE("another process finds no Falcon on an empty bus, and finds one that is plugged in") {
  UmockdevBus bus;
  ChildProcess before({FALCON_PROBE, "list"}, bus.environment());
  CHECK(before.finish() == 0);
  CHECK(before.output().empty());

  FalconEmulator emulator;
  EmulatorUsbModel model(emulator);
  bus.plug(model);
  ChildProcess after({FALCON_PROBE, "list"}, bus.environment());
  CHECK(after.finish() == 0);
  CHECK(after.output() == "USB bus 1 port 2, address 7, serial FALCON1, \n");
}

TEST_CASE("another process loads, homes and pushes a Falcon, loses it and finds it again") {
  const TempFolder folder;
  const std::string firmware = write_dummy_firmware(folder.path()).string();
  UmockdevBus bus;
  FalconEmulator emulator({}, swinging_hand());
  EmulatorUsbModel model(emulator);
  bus.plug(model);
  ChildProcess probe({FALCON_PROBE, "push", firmware}, bus.environment());
  INFO(probe.output());
  REQUIRE(probe.says("open FALCON1\nhomed\n"));
  CHECK(emulator.image() == dummy_firmware());
  CHECK(wait_until_pushed(emulator));

  bus.unplug();
  emulator.unplug();
  REQUIRE(probe.says("lost\n"));
  emulator.replug(true);
  bus.plug(model, {.address = 8});
  REQUIRE(probe.says("lost\nopen FALCON1\nhomed\n"));
  CHECK(wait_until_pushed(emulator));
  bus.unplug();
  CHECK(probe.finish() == 0);
}

}  // namespace
}  // namespace touchtrial::device::falcon
