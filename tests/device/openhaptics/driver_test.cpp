#include "device/openhaptics/driver.hpp"

#include "device/fakes/loaded_hd.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

device::DeviceListing listing_with(const std::filesystem::path& library) {
  device::DeviceSettings settings;
  settings.openhaptics.library = library;
  const std::vector<device::DeviceListing> listings = device::openhaptics_driver().list(settings);
  REQUIRE(listings.size() == 1);
  CHECK(listings[0].driver == "openhaptics");
  CHECK(listings[0].where == library.string());
  return listings[0];
}

TEST_CASE("the list of openhaptics names the device that is there, and lets go of it") {
  fakes::LoadedHd fake;
  const device::DeviceListing listing = listing_with(TOUCHTRIAL_FAKE_HD);
  CHECK(listing.present);
  CHECK(listing.model == "3D Systems Touch");
  CHECK(listing.serial == "SN-4711");
  CHECK(listing.missing.empty());
  CHECK(fake.calls() == "init disable_device ");
}

TEST_CASE("the list of openhaptics says what is missing: device, library, function") {
  fakes::LoadedHd fake;
  fake->opens_by = 0;
  const auto [library, missing] = GENERATE(
      table<const char*, const char*>({{TOUCHTRIAL_FAKE_HD, "plug it in"},
                                       {"/nowhere/libHD.so", "install the vendor's OpenHaptics"},
                                       {TOUCHTRIAL_PARTIAL_HD, "has no function hdUnschedule"}}));
  const device::DeviceListing listing = listing_with(library);
  CHECK_FALSE(listing.present);
  REQUIRE(listing.missing.size() == 1);
  CHECK_THAT(listing.missing[0], holds_text(missing));
}

TEST_CASE("openhaptics is opened through the registry by its name") {
  fakes::LoadedHd fake;
  device::DeviceSettings settings;
  settings.openhaptics.library = TOUCHTRIAL_FAKE_HD;
  CHECK(device::open_device("openhaptics", settings)->info().name == "openhaptics");
}

}  // namespace
}  // namespace touchtrial
