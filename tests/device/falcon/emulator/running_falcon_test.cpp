#include "core/random.hpp"
#include "device/falcon/emulator/falcon_host.hpp"
#include "device/falcon/falcon_motors.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <thread>

namespace touchtrial::device::falcon {
namespace {

EmulatorOptions homed_falcon() {
  return {.firmware_runs = true, .homed = true, .boot_loader = {}};
}

HandModel still_at(Vec3 position_mm) {
  return [position_mm](Vec3) { return position_mm; };
}

Vec3 position_of(const Reply& reply) {
  const Pose pose = forward_kinematics(theta1_of_counts(reply.counts));
  REQUIRE(pose.status == PoseStatus::ok);
  return to_device_mm(pose.native_m);
}

TEST_CASE("emulated falcon: the driver's kinematics find the hand to the encoders' resolution") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  RandomStream random(1, "falcon positions");
  for (int i = 0; i < 500; ++i) {
    const Vec3 place = {random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0),
                        random.uniform(-25.0, 25.0)};
    falcon.set_hand(still_at(place));
    const auto reply = host.exchange({});
    REQUIRE(reply);
    REQUIRE(norm(position_of(*reply) - place) < 0.06);
    REQUIRE(norm(falcon.position_mm() - place) < 1e-9);
  }
  CHECK(falcon.exchanges() == 500);
  CHECK(falcon.complaints().empty());
}

TEST_CASE("emulated falcon: the hand feels the force that the driver's kinematics send") {
  Vec3 felt;
  Vec3 place = {10.0, -15.0, 20.0};
  FalconEmulator falcon(homed_falcon(), [&](Vec3 force_n) {
    felt = force_n;
    return place;
  });
  FalconHost host(falcon);
  host.set_up_for_running();
  RandomStream random(2, "falcon forces");
  for (int i = 0; i < 500; ++i) {
    const Vec3 force_n = {random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                          random.uniform(-2.0, 2.0)};
    const Pose pose = forward_kinematics(theta1_of_counts(host.exchange({}).value().counts));
    const PerLeg torques = torques_nm(pose.jacobian, force_n).value();
    REQUIRE(host.exchange({FalconMotors({}).command(torques, {}).values, 0, true}));
    // The resolution of encoders and motor values.
    REQUIRE(norm(felt - force_n) < 0.02);
    REQUIRE(falcon.force_n() == felt);
    place = {random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0)};
  }
  CHECK(falcon.complaints().empty());
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

TEST_CASE("emulated falcon: force before homing causes a complaint") {
  FalconEmulator falcon({.firmware_runs = true});
  FalconHost host(falcon);
  host.set_up_for_running();
  CHECK(host.exchange({{0, 0, 0}, 0, true}));
  CHECK(falcon.complaints().empty());
  CHECK(host.exchange({{0, 1, 0}, 0, true}));
  CHECK(falcon.complaints() == std::vector<std::string>{"force before homing"});
}

TEST_CASE("emulated falcon: buttons are reported") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  falcon.press(kButtonForward | kButtonMinus);
  CHECK(host.exchange({})->buttons == (kButtonForward | kButtonMinus));
  falcon.press(0);
  CHECK(host.exchange({})->buttons == 0);
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

TEST_CASE("emulated falcon: a motor value beyond 4,095 causes a complaint") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  CHECK(host.exchange({{4095, -4095, 0}, 0, true}));
  CHECK(falcon.complaints().empty());
  CHECK(host.exchange({{0, 0, -4096}, 0, true}));
  CHECK(falcon.complaints() == std::vector<std::string>{"a motor value beyond 4,095"});
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

TEST_CASE("emulated falcon: replies can be dropped, shortened and surrounded by garbage") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  falcon.drop_replies(2);
  CHECK_FALSE(host.exchange({}));
  CHECK_FALSE(host.exchange({}));
  CHECK(host.exchange({}));
  falcon.shorten_replies(3, 7);
  for (int i = 0; i < 3; ++i) CHECK_FALSE(host.exchange({}));
  CHECK(host.exchange({}));
  const std::vector<std::uint8_t> garbage = {'<', '<', 'A', '>', 0x00, 0xFF};
  falcon.send_garbage(garbage);
  CHECK(host.exchange({}));
  CHECK(host.stream().replies() == 3);
  CHECK(host.stream().discarded_bytes() == 3 * 7 + garbage.size());
  CHECK(falcon.exchanges() == 8);
}

TEST_CASE("emulated falcon: stuck encoders stand still while the hand moves on") {
  double x_mm = 0.0;
  FalconEmulator falcon(homed_falcon(), [&](Vec3) { return Vec3{x_mm += 1.0, 0.0, 0.0}; });
  FalconHost host(falcon);
  host.set_up_for_running();
  const EncoderCounts first = host.exchange({})->counts;
  falcon.stick_encoders(true);
  for (int i = 0; i < 5; ++i) CHECK(host.exchange({})->counts == first);
  CHECK(falcon.position_mm().x > 6.0);
  falcon.stick_encoders(false);
  CHECK(host.exchange({})->counts != first);
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

TEST_CASE("emulated falcon: a hand beyond the reach leaves the grip at the last place") {
  Vec3 place = {5.0, 0.0, 0.0};
  FalconEmulator falcon(homed_falcon(), [&](Vec3) { return place; });
  FalconHost host(falcon);
  host.set_up_for_running();
  CHECK(host.exchange({}));
  place = {500.0, 0.0, 0.0};
  CHECK(norm(position_of(*host.exchange({})) - Vec3{5.0, 0.0, 0.0}) < 0.06);
  CHECK(falcon.complaints() == std::vector<std::string>{"the hand pulls beyond the reach"});
}

TEST_CASE("emulated falcon: transfers and mishaps may come from different threads") {
  FalconEmulator falcon(homed_falcon());
  FalconHost host(falcon);
  host.set_up_for_running();
  std::thread person([&] {
    for (std::uint32_t i = 0; i < 2000; ++i) {
      falcon.press(i);
      falcon.set_hand(still_at({0.001 * i, 0.0, 0.0}));
      static_cast<void>(falcon.complaints());
    }
  });
  for (int i = 0; i < 2000; ++i) REQUIRE(host.exchange({}));
  person.join();
  CHECK(falcon.exchanges() == 2000);
}

}  // namespace
}  // namespace touchtrial::device::falcon
