#include "device/device_link.hpp"

namespace touchtrial::device {

static_assert(std::atomic<DeviceFault>::is_always_lock_free, "signal handlers read it");

DeviceStatus DeviceLink::read(DeviceSample& sample) noexcept {
  sample = samples_.get();
  return fault() == DeviceFault::none ? DeviceStatus::ok : DeviceStatus::fault;
}

DeviceStatus DeviceLink::write(Vec3 force_n, Time now) noexcept {
  forces_.set({force_n, now, true});
  return fault() == DeviceFault::none ? DeviceStatus::ok : DeviceStatus::fault;
}

void DeviceLink::fail(DeviceFault fault) noexcept {
  DeviceFault none = DeviceFault::none;
  fault_.compare_exchange_strong(none, fault, std::memory_order_acq_rel);
}

void DeviceLink::publish(DeviceSample sample) noexcept {
  sample.sequence = ++published_;
  samples_.set(sample);
}

std::optional<Vec3> DeviceLink::live_force(Time now) noexcept {
  const TimedForce& newest = forces_.get();
  const bool usable = newest.any && now - newest.written_at <= kForceLifetime &&
                      !halted_.load(std::memory_order_acquire) && fault() == DeviceFault::none;
  return usable ? std::optional(newest.force_n) : std::nullopt;
}

}  // namespace touchtrial::device
