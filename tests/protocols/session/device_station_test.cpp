
#include "core/errors.hpp"
#include "protocols/session/fake_station.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <stdexcept>

namespace touchtrial {
namespace {

using Reply = session::Attendant::Reply;

struct Bench {
  Cable cable;
  FakeDevice* device = nullptr;
  Helper helper{cable};
  session::DeviceStation station{opener(cable, device), std::nullopt, helper};

  session::SupplyState until_settled() {
    session::SupplyState state = station.make_ready();
    while (state == session::SupplyState::not_yet) state = station.make_ready();
    return state;
  }
};

TEST_CASE("a device is armed once somebody consents, and then ready without asking") {
  Bench bench;
  CHECK(bench.station.make_ready() == session::SupplyState::ready);
  CHECK(bench.helper.consents == 1);
  CHECK(bench.station.make_ready() == session::SupplyState::ready);
  CHECK(bench.helper.consents == 1);
  CHECK(bench.station.info().model == "Fake One");
  CHECK(bench.cable.opened == 1);
}

TEST_CASE("a station names what is missing until it is there") {
  Bench bench;
  bench.cable.plugged = false;
  bench.cable.homed = false;
  CHECK(bench.station.make_ready() == session::SupplyState::not_yet);
  CHECK_THROWS_AS(bench.station.device(), std::logic_error);
  CHECK(bench.until_settled() == session::SupplyState::ready);
  REQUIRE(bench.helper.needs.size() == 2);
  CHECK(bench.helper.needs.front() == "fake: no such device; plug it in");

  bench.cable.homed = false;
  CHECK(bench.station.make_ready() == session::SupplyState::not_yet);
  CHECK(bench.helper.needs.back() != bench.helper.needs.front());
}

TEST_CASE("a station names a missing file that the device needs, and waits for it") {
  Cable cable;
  FakeDevice* device = nullptr;
  Helper helper{cable};
  int tries = 0;
  session::DeviceStation station(
      [&, open = opener(cable, device)] {
        if (++tries == 1) throw FileError("fw.bin: unreadable");
        return open();
      },
      std::nullopt, helper);
  CHECK(station.make_ready() == session::SupplyState::not_yet);
  REQUIRE(helper.needs.size() == 1);
  CHECK(helper.needs.front() == "fw.bin: unreadable");
  CHECK(station.make_ready() == session::SupplyState::ready);
}

TEST_CASE("a device is calibrated at its reset position once somebody says that it is there") {
  Bench bench;
  bench.cable.needs_reset = true;
  CHECK(bench.station.make_ready() == session::SupplyState::not_yet);
  CHECK(bench.cable.needs_reset);
  CHECK_THAT(bench.helper.needs.back(), names("h"));
  bench.helper.resets = true;
  CHECK(bench.station.make_ready() == session::SupplyState::not_yet);
  CHECK_FALSE(bench.cable.needs_reset);
  CHECK(bench.helper.consents == 0);
  CHECK(bench.station.make_ready() == session::SupplyState::ready);
  CHECK(bench.helper.consents == 1);
}

TEST_CASE("a lost device is opened again and armed again") {
  Bench bench;
  REQUIRE(bench.until_settled() == session::SupplyState::ready);
  bench.cable.plugged = false;
  device::DeviceSample sample;
  CHECK(bench.station.device().read(sample) == device::DeviceStatus::fault);
  CHECK(bench.until_settled() == session::SupplyState::ready);
  CHECK(bench.cable.opened == 2);
  CHECK(bench.helper.consents == 2);
  CHECK(bench.station.device().read(sample) == device::DeviceStatus::ok);
}

TEST_CASE("after an interruption the same device waits for consent") {
  Bench bench;
  REQUIRE(bench.until_settled() == session::SupplyState::ready);
  bench.station.on_interruption();
  CHECK(bench.until_settled() == session::SupplyState::ready);
  CHECK(bench.cable.opened == 1);
  CHECK(bench.helper.consents == 2);
}

TEST_CASE("a device other than the first one is refused") {
  Bench bench;
  REQUIRE(bench.until_settled() == session::SupplyState::ready);
  bench.cable.plugged = false;
  device::DeviceSample sample;
  static_cast<void>(bench.station.device().read(sample));
  bench.cable.serial = "B2";
  bench.helper.plugs_in = false;
  bench.cable.plugged = true;
  CHECK(bench.station.make_ready() == session::SupplyState::not_yet);
  CHECK_THAT(bench.helper.needs.back(), names("B2 A1"));
  bench.cable.serial = "A1";
  CHECK(bench.station.make_ready() == session::SupplyState::ready);
}

TEST_CASE("an attendant who stops ends the wait") {
  Bench bench;
  bench.cable.plugged = false;
  bench.helper.gives_up = true;
  CHECK(bench.station.make_ready() == session::SupplyState::stopped);
}

TEST_CASE("a station describes its device and what its servo thread obtained") {
  record::SessionOpening opening;
  device::DeviceInfo device{"falcon", "F7", 8.5, false};
  device.model = "Novint Falcon";
  device.visual = true;
  device::SchedulingObtained scheduling;
  scheduling.policy = device::SchedulingPolicy::fifo;
  scheduling.priority = 80;
  session::describe_station(opening, device, scheduling, 2000.0, "ab");
  CHECK(opening.device == "falcon");
  CHECK(opening.device_serial == "F7");
  REQUIRE(opening.station);
  CHECK(opening.station->scheduling == "fifo 80, memory not locked");
  CHECK(opening.station->visual);
  CHECK(opening.station->rate_hz == 2000.0);
  CHECK(opening.station->calibration == "ab");
}

}  // namespace
}  // namespace touchtrial
