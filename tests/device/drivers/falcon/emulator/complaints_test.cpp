// The emulated Falcon complains about whatever no correct driver sends, so that the tests of the
// driver, which expect no complaint, can fail.
#include "device/drivers/falcon/emulator/falcon_emulator.hpp"
#include "device/drivers/falcon/falcon_packet.hpp"
#include "support/catch.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

using Requests = std::vector<std::pair<std::uint8_t, std::uint16_t>>;

void request(FalconEmulator& falcon, const Requests& all) {
  for (const auto& [request, value] : all) {
    CHECK(falcon.control({0x40, request, value, 0}) == UsbStatus::ok);
  }
}

void set_up_for_greeting(FalconEmulator& falcon) {
  request(
      falcon,
      {{0, 1}, {0, 2}, {9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x200}, {1, 0x100}, {1, 0x101}});
}

void set_up_for_running(FalconEmulator& falcon) {
  request(falcon, {{9, 1}, {3, 2}, {0, 1}, {0, 2}});
}

void send(FalconEmulator& falcon, const std::vector<std::uint8_t>& bytes) {
  CHECK(falcon.bulk_out(bytes) == UsbStatus::ok);
}

void command(FalconEmulator& falcon, const Command& command) {
  const Packet packet = encode_command(command);
  send(falcon, {packet.begin(), packet.end()});
}

/// Greets the boot loader, and sends a first block of the firmware.
void load(FalconEmulator& falcon, std::size_t block_size) {
  set_up_for_greeting(falcon);
  send(falcon, {0x0A, 0x43, 0x0D});
  request(falcon, {{1, 0x100}, {3, 0x15}});
  send(falcon, {0x41});
  send(falcon, std::vector<std::uint8_t>(block_size, 0x55));
}

TEST_CASE("the emulated Falcon reports exactly the packets that no correct driver sends") {
  struct Driver {
    const char* complaint;  ///< null: none
    EmulatorOptions state;
    std::function<void(FalconEmulator&)> act;
  };
  const EmulatorOptions fresh;
  const EmulatorOptions runs{.firmware_runs = true};
  const EmulatorOptions homed{.firmware_runs = true, .homed = true};
  const auto running = [](const Command& sent) {
    return [=](FalconEmulator& falcon) {
      set_up_for_running(falcon);
      command(falcon, {{}, 0, true});
      command(falcon, sent);
    };
  };
  const Driver driver = GENERATE_COPY(values<Driver>(
      {{nullptr, homed, running({{4095, -4095, 0}, 0, true})},
       {nullptr, fresh, [](FalconEmulator& falcon) { load(falcon, 62); }},
       {"a block of more than 62 bytes", fresh, [](FalconEmulator& falcon) { load(falcon, 64); }},
       {"the set-up before the greeting is not in its order", fresh,
        [](FalconEmulator& falcon) {
          request(falcon,
                  {{9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x200}, {1, 0x100}, {1, 0x101}});
        }},
       {"a control request that the chip does not know", fresh,
        [](FalconEmulator& falcon) {
          CHECK(falcon.control({0x40, 77, 0, 0}) == UsbStatus::stall);
          CHECK(falcon.control({0xC0, 9, 1, 0}) == UsbStatus::stall);
          CHECK(falcon.control({0x40, 9, 1, 1}) == UsbStatus::stall);
          CHECK(falcon.requests().empty());
        }},
       {"the latency timer is not at 1 ms while running", homed,
        [](FalconEmulator& falcon) {
          request(falcon, {{3, 2}});
          command(falcon, {{}, 0, true});
        }},
       {"a command before one for homing", runs,
        [](FalconEmulator& falcon) {
          set_up_for_running(falcon);
          command(falcon, {{}, 0, false});
        }},
       {"force before homing", runs, running({{0, 1, 0}, 0, true})},
       {"a motor value beyond 4,095", homed, running({{0, 0, -4096}, 0, true})},
       {"a byte outside a command", homed, [](FalconEmulator& falcon) {
          set_up_for_running(falcon);
          send(falcon, {'x'});
        }}}));
  FalconEmulator falcon(driver.state);
  driver.act(falcon);
  std::vector<std::string> expected;
  if (driver.complaint != nullptr) expected.emplace_back(driver.complaint);
  CHECK(falcon.complaints() == expected);
}

}  // namespace
}  // namespace touchtrial::device::falcon
