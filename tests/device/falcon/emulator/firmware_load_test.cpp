#include "device/falcon/emulator/falcon_host.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes kGreeting = {0x0A, 0x43, 0x0D};
const Bytes kWelcome = {0x0A, 0x44, 0x2C, 0x0D};

Bytes dummy_image(std::size_t size = 7914) {
  Bytes image(size);
  for (std::size_t i = 0; i < size; ++i) image[i] = static_cast<std::uint8_t>(i * 31 + i / 256);
  return image;
}

/// Greets and loads in one attempt.
/// \return the first block with a wrong echo, or -1
int load(FalconHost& host, const Bytes& image, std::size_t block_size = 62) {
  host.set_up_for_greeting();
  REQUIRE(host.answer_to(kGreeting) == kWelcome);
  host.set_up_for_loading();
  REQUIRE(host.answer_to({0x41}) == Bytes{0x41});
  int number = 0;
  for (std::size_t at = 0; at < image.size(); at += block_size, ++number) {
    const auto begin = image.begin() + static_cast<std::ptrdiff_t>(at);
    const Bytes block(begin,
                      begin + static_cast<std::ptrdiff_t>(std::min(block_size, image.size() - at)));
    if (host.answer_to(block) != block) return number;
  }
  host.set_up_for_running();
  return -1;
}

TEST_CASE("emulated falcon: blocks of more than 62 bytes are cut and cause a complaint") {
  FalconEmulator falcon;
  FalconHost host(falcon);
  CHECK(load(host, dummy_image(), 64) == 0);
  CHECK(falcon.complaints() == std::vector<std::string>{"a block of more than 62 bytes"});
}

TEST_CASE("emulated falcon: a greeting is answered only with the right line settings") {
  FalconEmulator falcon;
  FalconHost host(falcon);
  CHECK(host.answer_to(kGreeting).empty());
  host.set_up_for_greeting();
  CHECK(host.control(3, 0x15));
  CHECK(host.answer_to(kGreeting).empty());
  host.set_up_for_greeting();
  CHECK(host.control(4, 7));
  CHECK(host.answer_to(kGreeting).empty());
  host.set_up_for_greeting();
  CHECK(host.control(1, 0x100));
  CHECK(host.answer_to(kGreeting).empty());
  host.set_up_for_greeting();
  CHECK(host.answer_to(kGreeting) == kWelcome);
  CHECK(falcon.complaints().empty());
}

TEST_CASE("emulated falcon: a set-up in another order causes a complaint") {
  FalconEmulator falcon;
  FalconHost host(falcon);
  for (const auto& [request, value] :
       {std::pair{9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x200}, {1, 0x100}, {1, 0x101}}) {
    CHECK(host.control(static_cast<std::uint8_t>(request), static_cast<std::uint16_t>(value)));
  }
  CHECK(falcon.complaints().size() == 1);
}

TEST_CASE("emulated falcon: requests that an FTDI chip does not know are stalled") {
  FalconEmulator falcon;
  CHECK(falcon.control({0x40, 77, 0, 0}) == UsbStatus::stall);
  CHECK(falcon.control({0xC0, 9, 1, 0}) == UsbStatus::stall);
  CHECK(falcon.control({0x40, 9, 1, 1}) == UsbStatus::stall);
  CHECK(falcon.control({0x40, 0, 3, 0}) == UsbStatus::stall);
  CHECK(falcon.control({0x40, 9, 0, 0}) == UsbStatus::stall);
  CHECK(falcon.requests().empty());
  CHECK(falcon.complaints().size() == 1);
}

TEST_CASE("emulated falcon: DTR raised at 9600 baud puts a running one back into its boot loader") {
  FalconEmulator falcon({.firmware_runs = true, .homed = true});
  FalconHost host(falcon);
  host.set_up_for_running();
  CHECK(host.exchange({}));
  CHECK(load(host, dummy_image()) == -1);
  CHECK(host.exchange({}));
  CHECK_FALSE(falcon.all_homed());
  CHECK(falcon.complaints().empty());
}

TEST_CASE("ftdi chip: packets of 64 bytes with two status bytes each, up to a shorter one") {
  FtdiChip chip;
  CHECK(chip.bulk_in(64) == Bytes{0x01, 0x60});
  CHECK(chip.bulk_in(1).empty());
  const Bytes bytes = dummy_image(130);
  chip.to_host(bytes);
  CHECK(chip.bulk_in(64).size() == 64);
  CHECK(chip.bulk_in(512).size() == 64 + 2 + 6);
  chip.to_host(bytes);
  const Bytes all = chip.bulk_in(512);
  REQUIRE(all.size() == 136);
  CHECK(std::equal(all.begin() + 66, all.begin() + 128, bytes.begin() + 62));
  chip.to_host(bytes);
  CHECK(chip.bulk_in(10).size() == 10);
  CHECK(chip.waiting() == 122);
  CHECK(chip.control({0x40, 0, 2, 0}));
  CHECK(chip.waiting() == 122);
  CHECK(chip.control({0x40, 0, 1, 0}));
  CHECK(chip.waiting() == 0);
}

}  // namespace
}  // namespace touchtrial::device::falcon
