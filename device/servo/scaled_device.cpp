#include "device/servo/scaled_device.hpp"

#include "core/strict_json.hpp"

#include <algorithm>

namespace touchtrial::device {
namespace {

constexpr Vec3 axis_product(Vec3 a, Vec3 b) noexcept {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 axis_quotient(Vec3 a, Vec3 b) noexcept {
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
  return {axis_product(workspace.min_mm, length), axis_product(workspace.max_mm, length),
          workspace.shape};
}

DeviceInfo scaled(DeviceInfo info, const DeviceScale& scale) {
  const double min_force_scale = std::min({scale.force.x, scale.force.y, scale.force.z});
  const double max_length = std::max({scale.length.x, scale.length.y, scale.length.z});
  const double force_factor = std::min(1.0, min_force_scale);
  const double stiffness_factor = std::min(1.0, min_force_scale / max_length);
  info.max_force_n *= force_factor;
  info.continuous_force_n *= force_factor;
  info.max_stiffness_n_per_mm *= stiffness_factor;
  info.max_damping_n_s_per_mm *= stiffness_factor;
  if (info.workspace) info.workspace = scaled(*info.workspace, scale.length);
  info.scale = scale;
  return info;
}

DeviceStatus ScaledDevice::read(DeviceSample& sample) noexcept {
  const DeviceStatus status = device_->read(sample);
  sample.position_mm = axis_product(sample.position_mm, scale_.length);
  sample.velocity_mm_s = axis_product(sample.velocity_mm_s, scale_.length);
  if (sample.delivered_n) sample.delivered_n = axis_product(*sample.delivered_n, scale_.force);
  return status;
}

DeviceStatus ScaledDevice::write(Vec3 force_n) noexcept {
  return device_->write(axis_quotient(force_n, scale_.force));
}

Vec3 ScaledDevice::support_force_n(const DeviceSample& sample) noexcept {
  DeviceSample driver_sample = sample;
  driver_sample.position_mm = axis_quotient(sample.position_mm, scale_.length);
  driver_sample.velocity_mm_s = axis_quotient(sample.velocity_mm_s, scale_.length);
  return device_->support_force_n(driver_sample);
}

}  // namespace touchtrial::device
