// The whole driver through the unmodified libusb: set-up, firmware, homing, forces, faults,
// unplugging and plugging in again.
#include "core/errors.hpp"
#include "device/drivers/falcon/falcon_device.hpp"
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/drivers/falcon/usb_falcon.hpp"
#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"
#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cmath>
#include <thread>

namespace touchtrial::device::falcon {
namespace {

using testing::EmulatorUsbModel;
using testing::ShimmedUsbDevice;

/// An emulated Falcon on the bus.
struct PluggedFalcon {
  explicit PluggedFalcon(EmulatorOptions options = {.firmware_runs = true, .homed = true})
      : emulator(std::move(options)), model(emulator), usb(model) {}

  void unplug() {
    usb.unplug();
    emulator.unplug();
  }
  void replug() {
    emulator.replug(true);
    usb.plug();
  }

  FalconEmulator emulator;
  EmulatorUsbModel model;
  ShimmedUsbDevice usb;
};

std::unique_ptr<FalconDevice> open_in_lockstep(Lockstep& lockstep,
                                               const device::FalconSettings& settings = {}) {
  FalconOptions options{.pace = lockstep.pace(),
                        .scheduling = {device::SchedulingPolicy::other, 0, false}};
  return std::make_unique<FalconDevice>(open_usb_falcon(settings.serial), settings,
                                        std::move(options));
}

/// Waits in real time for a condition that the USB thread fulfils; gives up after five minutes.
template <typename Condition>
bool wait_until(Condition holds) {
  for (int i = 0; i < 300'000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST_CASE("through libusb a Falcon is loaded, homed and pushes as requested") {
  const TempFolder folder;
  PluggedFalcon falcon(EmulatorOptions{});
  device::FalconSettings settings{.firmware = write_dummy_firmware(folder.path())};
  Lockstep lockstep;
  const auto device = open_in_lockstep(lockstep, settings);
  CHECK(falcon.emulator.image() == dummy_firmware());
  CHECK(device->readiness() == device::DeviceReadiness::needs_homing);
  CHECK(device->info().serial == "FALCON1");

  falcon.emulator.set_hand([tick = 0](Vec3) mutable {
    return Vec3{5.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  });
  LockstepDevice paced(*device, lockstep);
  device::DeviceSample sample;
  double worst_n = 0.0;
  double worst_mm = 0.0;
  for (int i = 0; i < 2000; ++i) {
    REQUIRE(paced.read(sample) == device::DeviceStatus::ok);
    REQUIRE(sample.sequence == static_cast<std::uint64_t>(i) + 1);
    if (i < 1000) continue;
    REQUIRE(sample.ready);
    worst_mm = std::max(worst_mm, norm(sample.position_mm - falcon.emulator.position_mm()));
    const Vec3 force_n = {0.5, -0.3 * std::sin(0.01 * i), 1.5};
    REQUIRE(paced.write(force_n) == device::DeviceStatus::ok);
    lockstep.step();
    ++i;
    // The force belongs to the pose of one exchange ago; the hand has moved by less than 0.2 mm
    // since.
    worst_n = std::max(worst_n, norm(falcon.emulator.force_n() - force_n));
    REQUIRE(device->read(sample) == device::DeviceStatus::ok);
  }
  CHECK(worst_mm < 0.06);
  CHECK(worst_n < 0.02);
  CHECK(falcon.emulator.complaints().empty());
}

TEST_CASE("through libusb buttons arrive and damage is survived") {
  PluggedFalcon falcon;
  Lockstep lockstep;
  const auto device = open_in_lockstep(lockstep);
  device::DeviceSample sample;
  for (int i = 0; i < 50; ++i) {
    falcon.emulator.press(i % 16);
    falcon.emulator.drop_replies(i % 10 == 3 ? 1 : 0);
    falcon.emulator.shorten_replies(i % 10 == 6 ? 1 : 0, 7);
    const std::vector<std::uint8_t> garbage(static_cast<std::size_t>(i), '<');
    falcon.usb.with_model([&] { falcon.emulator.send_garbage(garbage); });
    lockstep.steps(3);
    REQUIRE(device->read(sample) == device::DeviceStatus::ok);
    REQUIRE(sample.buttons == static_cast<std::uint32_t>(i % 16));
  }
  CHECK(norm(sample.position_mm) < 0.06);
}

TEST_CASE("a force that the device did not take is never felt after a halt") {
  PluggedFalcon falcon;
  Lockstep lockstep;
  const auto device = open_in_lockstep(lockstep);
  lockstep.steps(2);
  falcon.usb.stick_out(true);
  REQUIRE(device->write({0.0, 0.0, 1.0}) == device::DeviceStatus::ok);
  lockstep.step();
  device->halt();
  lockstep.step();
  const std::uint64_t before = falcon.emulator.exchanges();
  falcon.usb.stick_out(false);
  // What waited on the bus goes out at once, and carries no force.
  CHECK(falcon.emulator.exchanges() == before + 1);
  CHECK(falcon.emulator.motors() == std::array<std::int16_t, 3>{});
  lockstep.steps(3);
  CHECK(device->fault() == device::DeviceFault::none);
  CHECK(falcon.emulator.motors() == std::array<std::int16_t, 3>{});
  device::DeviceSample sample;
  REQUIRE(device->read(sample) == device::DeviceStatus::ok);
  const std::uint64_t sequence = sample.sequence;
  lockstep.steps(3);
  REQUIRE(device->read(sample) == device::DeviceStatus::ok);
  CHECK(sample.sequence == sequence + 3);
}

TEST_CASE("a device that takes no packets for 15 ms is a lost link, and closes") {
  PluggedFalcon falcon;
  Lockstep lockstep;
  auto device = open_in_lockstep(lockstep);
  lockstep.steps(2);
  REQUIRE(device->write({0.0, 0.0, 1.0}) == device::DeviceStatus::ok);
  lockstep.step();
  falcon.usb.stick_out(true);
  const auto began = lockstep.now() + FalconDevice::kPeriod;
  lockstep.steps(FtdiTransport::kMaxStuck);
  CHECK(device->fault() == device::DeviceFault::none);
  CHECK(lockstep.now() - began == FtdiTransport::kMaxStuck * FalconDevice::kReplyLimit);
  lockstep.step();
  CHECK(device->fault() == device::DeviceFault::link_lost);
  device.reset();
  CHECK(falcon.usb.open_handles() == 0);
}

TEST_CASE("closing clears an endpoint that refuses packets, so that the zeros go out") {
  PluggedFalcon falcon;
  Lockstep lockstep;
  auto device = open_in_lockstep(lockstep);
  lockstep.steps(2);
  REQUIRE(device->write({0.0, 0.0, 1.0}) == device::DeviceStatus::ok);
  lockstep.step();
  REQUIRE(norm(falcon.emulator.force_n()) > 0.5);
  falcon.usb.halt_out();
  device.reset();
  CHECK(falcon.emulator.motors() == std::array<std::int16_t, 3>{});
  CHECK(falcon.usb.open_handles() == 0);
}

TEST_CASE("in real time exchanges continue by themselves") {
  PluggedFalcon falcon;
  FalconDevice device(open_usb_falcon(""), {});
  device::DeviceSample sample;
  CHECK(wait_until([&] {
    return device.read(sample) == device::DeviceStatus::ok && sample.sequence >= 100 &&
           device.write({0.0, 0.0, 1.0}) == device::DeviceStatus::ok &&
           norm(falcon.emulator.force_n() - Vec3{0.0, 0.0, 1.0}) < 0.01;
  }));
  CHECK(sample.ready);
  // A servo that is stuck writes no more.
  CHECK(wait_until([&] { return falcon.emulator.motors() == std::array<std::int16_t, 3>{}; }));
}

TEST_CASE("a Falcon that is unplugged during a push is lost, and opens again when plugged in") {
  PluggedFalcon falcon;
  auto device = std::make_unique<FalconDevice>(open_usb_falcon(""), device::FalconSettings{});
  for (int round = 0; round < 3; ++round) {
    INFO("round " << round);
    device::DeviceSample sample;
    REQUIRE(wait_until([&] {
      return device->write({0.0, 0.0, 1.0}) == device::DeviceStatus::ok &&
             norm(falcon.emulator.force_n()) > 0.5;
    }));
    falcon.unplug();
    REQUIRE(wait_until([&] { return device->fault() == device::DeviceFault::link_lost; }));
    CHECK(device->read(sample) == device::DeviceStatus::fault);
    CHECK(device->write({}) == device::DeviceStatus::fault);
    falcon.replug();
    // The lost one is still open. Both may be open, but the old one never works again.
    auto anew = std::make_unique<FalconDevice>(open_usb_falcon(""), device::FalconSettings{});
    CHECK(device->fault() == device::DeviceFault::link_lost);
    device = std::move(anew);
    CHECK(device->fault() == device::DeviceFault::none);
  }
  device.reset();
  CHECK(falcon.usb.open_handles() == 0);
}

TEST_CASE("a Falcon that is unplugged while it is opened is reported as gone") {
  const TempFolder folder;
  PluggedFalcon falcon(EmulatorOptions{});
  device::FalconSettings settings{.firmware = write_dummy_firmware(folder.path())};
  auto transport = open_usb_falcon("");
  falcon.unplug();
  CHECK_THROWS_AS(FalconDevice(std::move(transport), settings), DeviceError);
  CHECK(falcon.usb.open_handles() == 0);
}

}  // namespace
}  // namespace touchtrial::device::falcon
