#include "device/servo/scaled_device.hpp"

#include "core/strict_json.hpp"

#include <algorithm>

namespace touchtrial::device {
namespace {

constexpr Vec3 times(Vec3 a, Vec3 b) noexcept {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 over(Vec3 a, Vec3 b) noexcept {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}

std::string axes_text(Vec3 axes) {
  return number_text(axes.x) + ", " + number_text(axes.y) + ", " + number_text(axes.z);
}

}  // namespace

std::string scale_text(const DeviceScale& scale) {
  return "force_scale " + axes_text(scale.force) + " and length_scale " + axes_text(scale.length);
}

Workspace scaled(const Workspace& workspace, Vec3 length) noexcept {
  return {times(workspace.min_mm, length), times(workspace.max_mm, length), workspace.shape};
}

DeviceInfo scaled(DeviceInfo info, const DeviceScale& scale) {
  const double weakest = std::min({scale.force.x, scale.force.y, scale.force.z});
  const double max_length = std::max({scale.length.x, scale.length.y, scale.length.z});
  const double of_force = std::min(1.0, weakest);
  const double of_stiffness = std::min(1.0, weakest / max_length);
  info.max_force_n *= of_force;
  info.continuous_force_n *= of_force;
  info.max_stiffness_n_per_mm *= of_stiffness;
  info.max_damping_n_s_per_mm *= of_stiffness;
  if (info.workspace) info.workspace = scaled(*info.workspace, scale.length);
  info.scale = scale;
  return info;
}

DeviceStatus ScaledDevice::read(DeviceSample& sample) noexcept {
  const DeviceStatus status = device_->read(sample);
  sample.position_mm = times(sample.position_mm, scale_.length);
  sample.velocity_mm_s = times(sample.velocity_mm_s, scale_.length);
  if (sample.delivered_n) sample.delivered_n = times(*sample.delivered_n, scale_.force);
  return status;
}

DeviceStatus ScaledDevice::write(Vec3 force_n) noexcept {
  return device_->write(over(force_n, scale_.force));
}

Vec3 ScaledDevice::support_force_n(const DeviceSample& sample) noexcept {
  DeviceSample own = sample;
  own.position_mm = over(sample.position_mm, scale_.length);
  own.velocity_mm_s = over(sample.velocity_mm_s, scale_.length);
  return device_->support_force_n(own);
}

}  // namespace touchtrial::device
