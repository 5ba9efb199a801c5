#include "device/falcon/emulator/falcon_host.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace touchtrial::device::falcon {
namespace {

EmulatorOptions homed_falcon() {
  return {.firmware_runs = true, .homed = true, .boot_loader = {}};
}

Vec3 position_of(const Reply& reply) {
  const Pose pose = forward_kinematics(theta1_of_counts(reply.counts));
  REQUIRE(pose.status == PoseStatus::ok);
  return to_device_mm(pose.native_m);
}

TEST_CASE("emulated falcon: only motion homes the axes, and their counts jump then") {
  double z_mm = -15.0;
  FalconEmulator falcon({.firmware_runs = true}, [&](Vec3) { return Vec3{0.0, 0.0, z_mm}; });
  FalconHost host(falcon);
  host.set_up_for_running();
  for (int i = 0; i < 100; ++i) CHECK_FALSE(host.exchange({})->all_homed());
  Reply before = *host.exchange({});
  Reply after = before;
  while (!after.all_homed()) {
    REQUIRE(z_mm < 20.0);
    before = after;
    z_mm += 0.1;
    after = *host.exchange({});
  }
  CHECK(falcon.all_homed());
  CHECK(std::abs(after.counts[0] - before.counts[0]) > 1000);
  CHECK(norm(position_of(after) - Vec3{0.0, 0.0, z_mm}) < 0.06);
  CHECK(falcon.complaints().empty());
  falcon.forget_homing();
  CHECK_FALSE(host.exchange({})->all_homed());
}

TEST_CASE("emulated falcon: no axis is homed before one command with the homing bit") {
  double z_mm = -20.0;
  FalconEmulator falcon({.firmware_runs = true}, [&](Vec3) { return Vec3{0.0, 0.0, z_mm += 0.1}; });
  FalconHost host(falcon);
  host.set_up_for_running();
  for (int i = 0; i < 350; ++i) REQUIRE_FALSE(host.exchange({{}, 0, false})->all_homed());
  CHECK(falcon.complaints() == std::vector<std::string>{"a command before one for homing"});
  z_mm = -20.0;
  CHECK_FALSE(host.exchange({})->all_homed());
  for (int i = 0; i < 350; ++i) (void)host.exchange({{}, 0, false});
  CHECK(falcon.all_homed());
}

TEST_CASE("emulated falcon: 0x02 of byte 13 is the green lamp, 0x04 the blue, 0x08 the red") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  Packet packet = encode_command({});
  for (unsigned flags = 0; flags < 16; flags += 2) {
    packet[13] = static_cast<std::uint8_t>(0x41U + flags + 1U);
    CHECK(falcon.bulk_out(packet) == UsbStatus::ok);
    CHECK(falcon.lamps() == Lamps{(flags & 8U) != 0, (flags & 2U) != 0, (flags & 4U) != 0});
  }
}

TEST_CASE("emulated falcon: a late reply comes before the next one, in a packet of its own") {
  int tick = 0;
  FalconEmulator falcon(homed_falcon(), [&](Vec3) { return Vec3{1.0 * tick++, 0.0, 0.0}; });
  FalconHost host(falcon);
  host.set_up_for_running();
  falcon.delay_replies(1);
  const Packet packet = encode_command({});
  CHECK(falcon.bulk_out(packet) == UsbStatus::ok);
  CHECK(falcon.waiting() == 0);
  CHECK(falcon.bulk_out(packet) == UsbStatus::ok);
  FalconStream stream;
  std::vector<std::uint8_t> transfer;
  for (const double x_mm : {1.0, 2.0}) {
    CHECK(falcon.bulk_in(64, transfer) == UsbStatus::ok);
    REQUIRE(stream.push_transfer(transfer) == 1);
    CHECK(norm(position_of(stream.newest()) - Vec3{x_mm, 0.0, 0.0}) < 0.06);
  }
  CHECK(falcon.waiting() == 0);
}

TEST_CASE("emulated falcon: an unplugged one is gone, and its motors may push on") {
  const bool keeps_power = GENERATE(false, true);
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  CHECK(host.exchange({{1000, 0, 0}, 0, true}));
  CHECK(norm(falcon.force_n()) > 0.5);
  falcon.unplug();
  std::vector<std::uint8_t> bytes;
  CHECK(falcon.control({0x40, 9, 1, 0}) == UsbStatus::gone);
  CHECK(falcon.bulk_out(encode_command({})) == UsbStatus::gone);
  CHECK(falcon.bulk_in(64, bytes) == UsbStatus::gone);
  CHECK(bytes.empty());
  CHECK(norm(falcon.force_n()) > 0.5);
  CHECK_FALSE(falcon.plugged());
  falcon.replug(keeps_power);
  CHECK(falcon.plugged());
  CHECK(falcon.firmware_runs() == keeps_power);
  CHECK(falcon.all_homed() == keeps_power);
  CHECK_FALSE(host.exchange({}));  // the line is not set up again
  host.set_up_for_running();
  CHECK(host.exchange({}).has_value() == keeps_power);
}

TEST_CASE("emulated falcon: commands may come in pieces, several at once, or broken") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  const Packet packet = encode_command({});
  const std::span<const std::uint8_t> bytes = packet;
  CHECK(falcon.bulk_out(bytes.first(5)) == UsbStatus::ok);
  CHECK(falcon.waiting() == 0);
  CHECK(falcon.bulk_out(bytes.subspan(5)) == UsbStatus::ok);
  CHECK(falcon.waiting() == 16);
  std::array<std::uint8_t, 3 * kPacketSize> three{};
  for (std::size_t i = 0; i < three.size(); ++i) three[i] = packet[i % kPacketSize];
  CHECK(falcon.bulk_out(three) == UsbStatus::ok);
  CHECK(falcon.waiting() == 64);
  CHECK(falcon.complaints().empty());
  CHECK(falcon.bulk_out(std::vector<std::uint8_t>{'x'}) == UsbStatus::ok);
  CHECK(falcon.complaints() == std::vector<std::string>{"a byte outside a command"});
}

TEST_CASE("emulated falcon: a latency timer left at 16 ms causes a complaint") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  CHECK(host.control(3, 2));
  CHECK(host.exchange({}));
  CHECK(falcon.complaints().size() == 1);
}

TEST_CASE("emulated falcon: what no correct host sends causes a complaint") {
  struct Sent {
    bool homed;
    MotorValues fine, wrong;
    const char* complaint;
  };
  for (const Sent& sent :
       {Sent{false, {}, {0, 1, 0}, "force before homing"},
        Sent{true, {4095, -4095, 0}, {0, 0, -4096}, "a motor value beyond 4,095"}}) {
    FalconEmulator falcon({.firmware_runs = true, .homed = sent.homed});
    FalconHost host(falcon);
    host.set_up_for_running();
    CHECK(host.exchange({sent.fine, 0, true}));
    CHECK(falcon.complaints().empty());
    CHECK(host.exchange({sent.wrong, 0, true}));
    CHECK(falcon.complaints() == std::vector<std::string>{sent.complaint});
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon
