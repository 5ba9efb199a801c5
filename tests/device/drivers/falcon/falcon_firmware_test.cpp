#include "device/drivers/falcon/falcon_firmware.hpp"

#include "core/errors.hpp"
#include "device/drivers/falcon/falcon_device.hpp"
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <functional>

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;

/// Damages the bytes between driver and emulator.
class Meddler final : public FtdiTransport {
 public:
  explicit Meddler(FalconEmulator& emulator) : through_(emulator) {}

  [[nodiscard]] std::string serial() const override { return {}; }
  void control(FtdiRequest request, std::uint16_t value) override {
    through_.control(request, value);
  }
  [[nodiscard]] std::size_t send(std::span<const std::uint8_t> bytes, milliseconds limit) override {
    ++sends;
    before_send(bytes);
    const std::size_t count = sends == short_send ? bytes.size() / 2 : bytes.size();
    return through_.send(bytes.first(count), limit);
  }
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                    milliseconds limit) override {
    // At most this many bytes of an answer at once.
    std::array<std::uint8_t, kUsbPacketSize> whole{};
    if (left_.empty()) {
      const std::size_t length = through_.receive(whole, limit);
      left_.assign(whole.begin() + kFtdiStatusSize, whole.begin() + length);
    }
    const std::size_t count = std::min(left_.size(), most_per_packet);
    std::copy_n(left_.begin(), count, packet.begin() + kFtdiStatusSize);
    left_.erase(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(count));
    return count + kFtdiStatusSize;
  }
  void start_stream(FtdiStreamSink& sink) override { through_.start_stream(sink); }
  void stop_stream() noexcept override { through_.stop_stream(); }
  [[nodiscard]] bool post(std::span<const std::uint8_t> bytes) noexcept override {
    return through_.post(bytes);
  }
  void serve(std::chrono::microseconds at_most) noexcept override { through_.serve(at_most); }
  [[nodiscard]] bool lost() const noexcept override { return through_.lost(); }

  int sends = 0;
  int short_send = 0;  ///< the send of which half goes out; 0: none
  std::size_t most_per_packet = kUsbPacketSize;
  std::function<void(std::span<const std::uint8_t>)> before_send = [](auto) {};

 private:
  EmulatorTransport through_;
  std::vector<std::uint8_t> left_;
};

std::string failure_of(FtdiTransport& transport) {
  return message_of<DeviceError>([&] { load_falcon_firmware(transport, dummy_firmware()); });
}

TEST_CASE("firmware is loaded byte for byte and then runs") {
  FalconEmulator emulator;
  EmulatorTransport transport(emulator);
  CHECK_FALSE(probe_falcon(transport));
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.image() == dummy_firmware());
  CHECK(emulator.firmware_runs());
  CHECK(probe_falcon(transport));
  CHECK(emulator.complaints().empty());
}

TEST_CASE("asking whether firmware is loaded does not reset a Falcon that has it") {
  FalconEmulator emulator({.firmware_runs = true, .homed = true});
  EmulatorTransport transport(emulator);
  set_up_running_falcon(transport);
  CHECK(probe_falcon(transport));
  CHECK(emulator.all_homed());
  CHECK(emulator.loads() == 0);
  CHECK(emulator.motors() == std::array<std::int16_t, 3>{});
}

TEST_CASE("a boot loader may answer late and with a zero in front") {
  FalconEmulator emulator(
      {.boot_loader = {.unanswered_greetings = kFirmwareHandshakes - 1, .leading_zero = true}});
  EmulatorTransport transport(emulator);
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.firmware_runs());
  CHECK(emulator.loads() == 1);
}

TEST_CASE("a boot loader that never answers is given up, with the remedy") {
  FalconEmulator emulator({.boot_loader = {.unanswered_greetings = 1'000'000}});
  Meddler transport(emulator);
  const std::string failure = failure_of(transport);
  CHECK_THAT(failure, names("USB"));
  CHECK(transport.sends == kFirmwareLoads * kFirmwareHandshakes);
}

TEST_CASE("a failed load is repeated up to nine times") {
  const bool silent = GENERATE(false, true);
  FalconEmulator emulator(
      {.boot_loader = {.bad_loads = kFirmwareLoads - 1, .bad_block = 17, .silent_block = silent}});
  EmulatorTransport transport(emulator);
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.loads() == kFirmwareLoads);
  CHECK(emulator.image() == dummy_firmware());
  CHECK(emulator.firmware_runs());
}

TEST_CASE("the tenth failed load is the last, and the error says where the echo differed") {
  const bool silent = GENERATE(false, true);
  FalconEmulator emulator(
      {.boot_loader = {.bad_loads = kFirmwareLoads, .bad_block = 2, .silent_block = silent}});
  EmulatorTransport transport(emulator);
  CHECK_THAT(failure_of(transport), names("124"));
  CHECK(emulator.loads() == kFirmwareLoads);
  CHECK_FALSE(emulator.firmware_runs());
}

TEST_CASE("answers and echoes may come in small pieces") {
  FalconEmulator emulator({.boot_loader = {.leading_zero = true}});
  Meddler transport(emulator);
  transport.most_per_packet = GENERATE(std::size_t{1}, std::size_t{3}, std::size_t{61});
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.firmware_runs());
  CHECK(emulator.loads() == 1);
}

TEST_CASE("a block of which only half leaves fails its load, and the next one succeeds") {
  FalconEmulator emulator;
  Meddler transport(emulator);
  transport.short_send = 30;
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.loads() == 2);
  CHECK(emulator.image() == dummy_firmware());
}

TEST_CASE("garbage among the echoes fails its load, and the next one succeeds") {
  FalconEmulator emulator;
  Meddler transport(emulator);
  transport.before_send = [&](auto) {
    if (transport.sends == 30) emulator.send_garbage(std::vector<std::uint8_t>{0x13, 0x37});
  };
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.loads() == 2);
  CHECK(emulator.firmware_runs());
}

TEST_CASE("garbage before a greeting does not hide its answer") {
  FalconEmulator emulator;
  Meddler transport(emulator);
  transport.before_send = [&](auto) {
    if (transport.sends == 1) emulator.send_garbage(std::vector<std::uint8_t>{0x0a, 0x44, 0x0a});
  };
  load_falcon_firmware(transport, dummy_firmware());
  CHECK(emulator.loads() == 1);
  CHECK(transport.sends < 200);
}

TEST_CASE("unplugging in the middle of a load ends it at once") {
  FalconEmulator emulator;
  Meddler transport(emulator);
  transport.before_send = [&](auto) {
    if (transport.sends == 40) emulator.unplug();
  };
  CHECK_FALSE(failure_of(transport).empty());
  CHECK(transport.sends == 40);
}

TEST_CASE("a firmware file that is not named, is missing or has the wrong size is refused") {
  const TempFolder folder;
  CHECK_THROWS_WITH(read_falcon_firmware({}), names("falcon.firmware"));
  CHECK_THROWS_WITH(read_falcon_firmware(folder.path() / "none.bin"), names("none.bin"));
  CHECK_THROWS_WITH(read_falcon_firmware(folder.path()), holds_text("falcon.firmware"));
  const int size = GENERATE(0, 1, static_cast<int>(kMinFirmwareBytes) - 1,
                            static_cast<int>(kMaxFirmwareBytes) + 1);
  std::ofstream(folder.path() / "odd.bin") << std::string(static_cast<std::size_t>(size), 'x');
  CHECK_THROWS_WITH(read_falcon_firmware(folder.path() / "odd.bin"), names("odd.bin"));
}

}  // namespace
}  // namespace touchtrial::device::falcon
