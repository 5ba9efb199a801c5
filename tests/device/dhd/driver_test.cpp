#include "device/dhd/driver.hpp"

#include "device/fakes/loaded_dhd.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

std::vector<device::DeviceListing> listings_with(const std::filesystem::path& library) {
  device::DeviceSettings settings;
  settings.dhd.library = library;
  return device::dhd_driver().list(settings);
}

TEST_CASE("the list of dhd names every device that is there, and closes it") {
  fakes::LoadedDhd fake;
  fake->devices = 2;
  const std::vector<device::DeviceListing> listings = listings_with(TOUCHTRIAL_FAKE_DHD);
  REQUIRE(listings.size() == 2);
  for (const device::DeviceListing& listing : listings) {
    CHECK(listing.driver == "dhd");
    CHECK(listing.present);
    CHECK(listing.model == "omega.3");
    CHECK(listing.serial == "4242");
    CHECK(listing.missing.empty());
  }
  CHECK_THAT(listings[1].where, holds_text(", device 1"));
  CHECK(fake->misuses == 0);
  CHECK(fake.calls() == "open force_off close open force_off close ");
}

TEST_CASE("the list of dhd says what is missing: device, library, function, or who has it open") {
  fakes::LoadedDhd fake;
  SECTION("no device, library or function") {
    fake->devices = 0;
    const auto [library, missing] = GENERATE(table<const char*, const char*>(
        {{TOUCHTRIAL_FAKE_DHD, "no device is connected"},
         {"/nowhere/libdhd.so", "install Force Dimension's SDK"},
         {TOUCHTRIAL_PARTIAL_DHD, "has no function dhdEnableForce"}}));
    const std::vector<device::DeviceListing> listings = listings_with(library);
    REQUIRE(listings.size() == 1);
    CHECK_FALSE(listings[0].present);
    REQUIRE(listings[0].missing.size() == 1);
    CHECK_THAT(listings[0].missing[0], holds_text(missing));
  }
  SECTION("a device that does not open") {
    fake->opens = false;
    const std::vector<device::DeviceListing> listings = listings_with(TOUCHTRIAL_FAKE_DHD);
    REQUIRE(listings.size() == 1);
    CHECK(listings[0].present);
    REQUIRE(listings[0].missing.size() == 1);
    CHECK_THAT(listings[0].missing[0], holds_text("close other programs"));
  }
}

TEST_CASE("dhd is opened through the registry by its name") {
  fakes::LoadedDhd fake;
  device::DeviceSettings settings;
  settings.dhd.library = TOUCHTRIAL_FAKE_DHD;
  CHECK(device::open_device("dhd", settings)->info().name == "dhd");
}

}  // namespace
}  // namespace touchtrial
