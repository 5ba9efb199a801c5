#include "device/falcon/driver.hpp"

#include "core/errors.hpp"
#include "device/falcon/falcon_device.hpp"
#include "device/falcon/falcon_firmware.hpp"
#include "device/falcon/usb_falcon.hpp"

namespace touchtrial::device {
namespace {

/// What is wrong with the firmware's file; empty if nothing is.
std::string firmware_trouble(const FalconSettings& settings) {
  try {
    static_cast<void>(falcon::read_falcon_firmware(settings.firmware));
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

std::vector<DeviceListing> list_falcons(const DeviceSettings& settings) {
  std::vector<DeviceListing> listings;
  const std::string firmware = firmware_trouble(settings.falcon);
  for (const falcon::UsbFalcon& found : falcon::find_usb_falcons()) {
    DeviceListing listing{"falcon", "Novint Falcon", found.serial, found.where, true, {}};
    if (!found.trouble.empty()) listing.missing.push_back(found.trouble);
    if (!firmware.empty()) listing.missing.push_back(firmware);
    listings.push_back(std::move(listing));
  }
  if (listings.empty()) {
    listings.push_back(
        {"falcon",
         "",
         "",
         "",
         false,
         {"none is plugged in (USB 0403:cb48); plug it in and switch its power on"}});
  }
  return listings;
}

std::unique_ptr<HapticDevice> open_falcon(const DeviceSettings& settings) {
  return std::make_unique<falcon::FalconDevice>(falcon::open_usb_falcon(settings.falcon.serial),
                                                settings.falcon);
}

}  // namespace

DeviceDriver falcon_driver() {
  return {"falcon", "Novint Falcon, over USB", list_falcons, open_falcon, falcon::kFalconWorkspace};
}

}  // namespace touchtrial::device
