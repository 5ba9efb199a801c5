#include "device/replay/replay_device.hpp"

#include "core/errors.hpp"
#include "device/drivers.hpp"

namespace touchtrial::device {
namespace {

/// That of a usual device.
constexpr double kMaxForceN = 3.3;

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

DeviceInfo ReplayDevice::info() const {
  DeviceInfo info{"replay", "", kMaxForceN, true};
  info.max_rate_hz = motion_.rate_hz();
  return info;
}

DeviceStatus ReplayDevice::read(DeviceSample& sample) noexcept {
  const std::int64_t last = motion_.ticks() - 1;
  const std::int64_t tick = tick_ < last ? tick_ : last;
  sample = {};
  sample.position_mm = motion_.position_mm(tick);
  if (tick > 0) {
    const Vec3 step_mm = sample.position_mm - motion_.position_mm(tick - 1);
    sample.velocity_mm_s = motion_.rate_hz() * step_mm;
  }
  sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
  return tick_ <= last ? DeviceStatus::ok : DeviceStatus::stopped;
}

DeviceStatus ReplayDevice::write(Vec3) noexcept {
  ++tick_;
  return DeviceStatus::ok;
}

DeviceDriver replay_driver() {
  return {"replay", "recorded motion from a CSV file; feels nothing", list_replay, open_replay};
}

}  // namespace touchtrial::device
