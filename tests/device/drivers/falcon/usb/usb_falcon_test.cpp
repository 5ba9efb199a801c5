// Finding and opening devices, and moving bytes, through the unmodified libusb.
#include "device/drivers/falcon/usb_falcon.hpp"

#include "core/errors.hpp"
#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <deque>

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;
using testing::ShimmedUsbDevice;
using testing::UsbIdentity;

/// Returns the bytes that it gets, behind two status bytes.
class Loopback final : public testing::UsbModel {
 public:
  bool vendor_request(std::uint8_t, std::uint16_t, std::uint16_t index) override {
    return index == 0;
  }
  void bulk_out(std::span<const std::uint8_t> bytes) override {
    packets.emplace_back(bytes.begin(), bytes.end());
  }
  std::size_t bulk_in(std::span<std::uint8_t> bytes) override {
    if (packets.empty()) return 0;
    const auto packet = packets.front();
    packets.pop_front();
    bytes[0] = 0x01;
    bytes[1] = 0x60;
    std::ranges::copy(packet, bytes.begin() + 2);
    return packet.size() + 2;
  }

  std::deque<std::vector<std::uint8_t>> packets;
};

class Collector final : public FtdiStreamSink {
 public:
  void receive(std::span<const std::uint8_t> transfer) noexcept override {
    bytes.insert(bytes.end(), transfer.begin() + 2, transfer.end());
  }
  void sent() noexcept override {}
  std::vector<std::uint8_t> bytes;
};

std::string refusal(const std::string& serial = "") {
  return message_of<DeviceError>([&] { return open_usb_falcon(serial); });
}

/// Serves the stream until a condition holds; gives up after half a minute.
template <typename Condition>
bool serve_until(FtdiTransport& transport, Condition holds) {
  for (int i = 0; i < 3000; ++i) {
    if (holds()) return true;
    transport.serve(milliseconds(10));
  }
  return false;
}

TEST_CASE("an empty bus has no Falcon, and the error of opening one gives the remedy") {
  CHECK(find_usb_falcons().empty());
  CHECK_THAT(refusal(), names("0403:cb48"));
}

TEST_CASE("a Falcon on the bus is found with its place and serial number") {
  Loopback model;
  const ShimmedUsbDevice device(model, {.serial = "AB12"});
  const auto found = find_usb_falcons();
  REQUIRE(found.size() == 1);
  CHECK(found[0].where == "USB bus 1 port 2, address 7");
  CHECK(found[0].serial == "AB12");
  CHECK(found[0].problem.empty());
  CHECK(device.open_handles() == 0);
}

TEST_CASE("a device of another maker is not taken for a Falcon") {
  Loopback model;
  const ShimmedUsbDevice device(model, {.product = 0x6001});
  CHECK(find_usb_falcons().empty());
}

TEST_CASE("without permission the remedy is the udev rule") {
  Loopback model;
  ShimmedUsbDevice device(model);
  device.allow(false);
  const auto found = find_usb_falcons();
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].problem, holds_text("scripts/install-udev-rules"));
  CHECK_THAT(refusal(), holds_text("scripts/install-udev-rules"));
  CHECK_THAT(refusal("FALCON1"), holds_text("scripts/install-udev-rules"));
}

TEST_CASE("a Falcon that another program has claimed is busy, and nothing stays open") {
  Loopback model;
  ShimmedUsbDevice device(model);
  device.use_elsewhere(true);
  CHECK_FALSE(find_usb_falcons().at(0).problem.empty());
  CHECK_THAT(refusal(), names(find_usb_falcons().at(0).where));
  CHECK(device.open_handles() == 0);
}

TEST_CASE("a kernel driver is detached while the Falcon is open, and reattached") {
  Loopback model;
  ShimmedUsbDevice device(model);
  device.attach_kernel_driver(true);
  CHECK(find_usb_falcons().at(0).problem.empty());
  CHECK(device.has_kernel_driver());
  {
    const auto transport = open_usb_falcon("");
    CHECK_FALSE(device.has_kernel_driver());
    CHECK(device.is_claimed());
  }
  CHECK(device.has_kernel_driver());
  CHECK_FALSE(device.is_claimed());
}

TEST_CASE("the settings have to name one of several Falcons") {
  Loopback first, second;
  const ShimmedUsbDevice one(first, {.serial = "ONE"});
  const ShimmedUsbDevice two(second, {.address = 9, .port = "1-3", .serial = "TWO"});
  CHECK_THAT(refusal(), holds_text("falcon.serial"));
  CHECK_THAT(refusal("THREE"), holds_text("ONE, TWO"));
  const auto transport = open_usb_falcon("TWO");
  CHECK(two.is_claimed());
  CHECK_FALSE(one.is_claimed());
  CHECK(one.open_handles() == 0);
}

TEST_CASE("a Falcon without a serial number is reported as such if another number is requested") {
  Loopback model;
  const ShimmedUsbDevice device(model, {.serial = ""});
  CHECK_THAT(refusal("A\nB"), names("A B falcon.serial"));
}

TEST_CASE("receiving from a silent device waits no longer than the limit") {
  Loopback model;
  const ShimmedUsbDevice device(model);
  const auto transport = open_usb_falcon("");
  std::array<std::uint8_t, kUsbPacketSize> packet{};
  CHECK(transport->receive(packet, milliseconds(5)) == 0);
}

TEST_CASE("setting up an unplugged device says so") {
  Loopback model;
  ShimmedUsbDevice device(model);
  const auto transport = open_usb_falcon("");
  device.unplug();
  CHECK_THROWS_AS(transport->control(FtdiRequest::purge, 1), DeviceError);
  std::array<std::uint8_t, kUsbPacketSize> packet{};
  CHECK_THROWS_AS(transport->receive(packet, milliseconds(5)), DeviceError);
  Collector collector;
  CHECK_THROWS_AS(transport->start_stream(collector), DeviceError);
}

TEST_CASE("the stream keeps a read queued: one packet after another arrives") {
  Loopback model;
  const ShimmedUsbDevice device(model);
  const auto transport = open_usb_falcon("");
  Collector collector;
  transport->start_stream(collector);
  std::vector<std::uint8_t> expected;
  for (std::uint8_t i = 0; i < 200; ++i) {
    expected.push_back(i);
    REQUIRE(transport->post({&i, 1}));
    REQUIRE(serve_until(*transport, [&] { return collector.bytes.size() == expected.size(); }));
  }
  CHECK(collector.bytes == expected);
  transport->stop_stream();
  CHECK_FALSE(transport->lost());
}

TEST_CASE("an endpoint that refuses packets is cleared, in the stream and out of it") {
  Loopback model;
  ShimmedUsbDevice device(model);
  const auto transport = open_usb_falcon("");
  const std::array<std::uint8_t, 1> byte = {7};
  device.halt_out();
  CHECK(transport->send(byte, milliseconds(1000)) == 1);
  Collector collector;
  transport->start_stream(collector);
  CHECK(serve_until(*transport, [&] { return collector.bytes.size() == 1; }));
  device.halt_out();
  CHECK(transport->post(byte));
  CHECK(serve_until(*transport, [&] {
    static_cast<void>(transport->post(byte));
    return collector.bytes.size() >= 2;
  }));
  CHECK_FALSE(transport->lost());
}

TEST_CASE(
    "a bus that gives nothing back is a lost link, and closing does not wait for it for ever") {
  Loopback model;
  ShimmedUsbDevice device(model);
  auto transport = open_usb_falcon("");
  Collector collector;
  transport->start_stream(collector);
  device.deafen(true);
  const std::array<std::uint8_t, 1> byte = {7};
  REQUIRE(transport->post(byte));
  const bool served = GENERATE(true, false);
  if (served) CHECK(serve_until(*transport, [&] { return transport->lost(); }));
  transport->stop_stream();
  CHECK(transport->lost());
  CHECK_THROWS_AS(transport->send(byte, milliseconds(5)), DeviceError);
  transport.reset();
  CHECK(device.open_handles() == 0);
}

}  // namespace
}  // namespace touchtrial::device::falcon
