#include "device/replay/driver.hpp"

#include "core/errors.hpp"
#include "device/replay/replay_device.hpp"

namespace touchtrial::device {
namespace {

RecordedMotion motion_of(const DeviceSettings& settings) {
  if (settings.replay.trace.empty()) {
    throw DeviceError(
        "replay: no recording is named; name a CSV file in the device settings at replay.trace");
  }
  return read_motion_csv(settings.replay.trace);
}

std::vector<DeviceListing> list_replay(const DeviceSettings& settings) {
  DeviceListing listing;
  listing.driver = "replay";
  listing.where = settings.replay.trace.string();
  try {
    (void)motion_of(settings);
    listing.model = "recorded motion";
    listing.present = true;
  } catch (const Error& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_replay(const DeviceSettings& settings) {
  return std::make_unique<ReplayDevice>(motion_of(settings));
}

}  // namespace

DeviceDriver replay_driver() {
  return {"replay", "recorded motion from a CSV file; feels nothing", list_replay, open_replay};
}

}  // namespace touchtrial::device
