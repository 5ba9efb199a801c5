#include "device/dhd/driver.hpp"

#include "core/errors.hpp"
#include "device/dhd/dhd_device.hpp"
#include "device/dhd/dhd_session.hpp"

namespace touchtrial::device {
namespace {

DeviceListing empty_listing(const DhdSettings& settings) {
  DeviceListing listing;
  listing.driver = "dhd";
  listing.where = settings.library.string();
  return listing;
}

DeviceListing listing_of(DhdSettings settings, int index) {
  settings.index = index;
  DeviceListing listing = empty_listing(settings);
  listing.where += ", device " + std::to_string(index);
  listing.present = true;
  try {
    const DeviceInfo info = dhd::Session(settings).info();
    listing.model = info.model;
    listing.serial = info.serial;
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return listing;
}

std::vector<DeviceListing> list_dhd(const DeviceSettings& settings) {
  DeviceListing nothing = empty_listing(settings.dhd);
  try {
    expect_loading_survived(settings.dhd.library, dhd::kRemedy);
    const int count = dhd::Library(settings.dhd.library).device_count();
    std::vector<DeviceListing> found;
    for (int i = 0; i < count; ++i) found.push_back(listing_of(settings.dhd, i));
    if (count > 0) return found;
    nothing.missing = {"no device is connected; switch it on and plug it in"};
  } catch (const DeviceError& error) {
    nothing.missing = {error.what()};
  }
  return {nothing};
}

std::unique_ptr<HapticDevice> open_dhd(const DeviceSettings& settings) {
  expect_loading_survived(settings.dhd.library, dhd::kRemedy);
  return std::make_unique<DhdDevice>(settings.dhd);
}

}  // namespace

DeviceDriver dhd_driver() {
  return {"dhd",        "Force Dimension omega, delta and sigma, through the vendor's library",
          list_dhd,     open_dhd,
          std::nullopt, false};
}

}  // namespace touchtrial::device
