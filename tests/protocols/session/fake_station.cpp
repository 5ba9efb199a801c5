#include "protocols/session/fake_station.hpp"

#include "core/errors.hpp"

#include <algorithm>

namespace touchtrial {

device::DeviceInfo FakeDevice::info() const {
  device::DeviceInfo info{"fake", cable_.serial, 3.3, false};
  info.model = "Fake One";
  info.firmware = "7";
  return info;
}

device::DeviceStatus FakeDevice::read(device::DeviceSample& sample) noexcept {
  constexpr int kComingDown = 50;
  constexpr int kStrokeTicks = 250;
  constexpr double kMmATick = 0.06;
  const int tick = tick_++;
  if (tick == cable_.pull_at_tick.load()) {
    cable_.pull_at_tick = -1;
    cable_.plugged = false;
  }
  if (!cable_.plugged) lost_ = true;
  const int along = tick % (2 * kStrokeTicks);
  const double x_mm = 4.0 + kMmATick * std::min(along, 2 * kStrokeTicks - along);
  const double height_mm = tick < kComingDown ? 5.0 - 0.1 * static_cast<double>(tick) : -0.3;
  sample = {};
  sample.position_mm = {x_mm, 10.0, height_mm};
  sample.sequence = ++sequence_;
  return lost_ ? device::DeviceStatus::fault : device::DeviceStatus::ok;
}

device::DeviceStatus FakeDevice::write(Vec3 force_n) noexcept {
  const bool is_zero = force_n == Vec3{};
  if (!is_zero) ++cable_.strong_writes;
  if (!is_zero && halted_) ++cable_.writes_unarmed;
  cable_.last_was_zero = is_zero || halted_ || lost_;
  return lost_ ? device::DeviceStatus::fault : device::DeviceStatus::ok;
}

session::Attendant::Reply Helper::poll(const std::string& need) {
  if (gives_up && !need.empty()) return Reply::stop;
  if (need.empty()) {
    ++consents;
    return Reply::arm;
  }
  needs.push_back(need);
  if (resets) return Reply::at_reset;
  if (plugs_in && needs.size() % 2 == 0) {
    cable_.plugged = true;
    cable_.homed = true;
  }
  return Reply::wait;
}

session::DeviceStation::Open opener(Cable& cable, FakeDevice*& device) {
  return [&cable, &device]() -> std::unique_ptr<device::HapticDevice> {
    if (!cable.plugged) throw DeviceError("fake: no such device; plug it in");
    auto opened = std::make_unique<FakeDevice>(cable);
    device = opened.get();
    return opened;
  };
}

}  // namespace touchtrial
