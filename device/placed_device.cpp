#include "device/placed_device.hpp"

namespace touchtrial::device {

Vec3 to_plane_direction(Vec3 device, PlaneOrientation orientation) noexcept {
  if (orientation == PlaneOrientation::horizontal) return {device.x, device.z, device.y};
  return {device.x, -device.y, device.z};
}

Vec3 to_device_direction(Vec3 plane, PlaneOrientation orientation) noexcept {
  // Either orientation is its own inverse.
  return to_plane_direction(plane, orientation);
}

Vec3 to_plane_position_mm(Vec3 device_mm, const PlanePlacement& placement) noexcept {
  return to_plane_direction(device_mm - placement.origin_mm, placement.orientation);
}

DeviceStatus PlacedDevice::read(DeviceSample& sample) noexcept {
  const DeviceStatus status = device_.read(sample);
  sample.position_mm = to_plane_position_mm(sample.position_mm, placement_);
  sample.velocity_mm_s = to_plane_direction(sample.velocity_mm_s, placement_.orientation);
  return status;
}

DeviceStatus PlacedDevice::write(Vec3 force_n) noexcept {
  return device_.write(to_device_direction(force_n, placement_.orientation));
}

}  // namespace touchtrial::device
