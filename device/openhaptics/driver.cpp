#include "device/openhaptics/driver.hpp"

#include "core/errors.hpp"
#include "device/openhaptics/hd_session.hpp"
#include "device/openhaptics/openhaptics_device.hpp"

namespace touchtrial::device {
namespace {

std::vector<DeviceListing> list_openhaptics(const DeviceSettings& settings) {
  DeviceListing listing;
  listing.driver = "openhaptics";
  listing.where = settings.openhaptics.library.string();
  try {
    expect_loading_survived(settings.openhaptics.library, hd::kRemedy);
    const DeviceInfo info = hd::Session(settings.openhaptics).info();
    listing.model = info.model;
    listing.serial = info.serial;
    listing.present = true;
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_openhaptics(const DeviceSettings& settings) {
  expect_loading_survived(settings.openhaptics.library, hd::kRemedy);
  return std::make_unique<OpenHapticsDevice>(settings.openhaptics);
}

}  // namespace

DeviceDriver openhaptics_driver() {
  return {"openhaptics",    "3D Systems Touch and Phantom, through the vendor's OpenHaptics",
          list_openhaptics, open_openhaptics,
          std::nullopt,     false};
}

}  // namespace touchtrial::device
