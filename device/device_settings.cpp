#include "device/device_settings.hpp"

#include "core/files.hpp"
#include "core/user_folders.hpp"

#include <algorithm>

namespace touchtrial::device {
namespace {

void tighten(double& limit, const std::optional<double>& lab_limit) {
  if (lab_limit) limit = std::min(limit, *lab_limit);
}

}  // namespace

DeviceUse DeviceSettings::use_of(const std::string& driver) const {
  const auto found = uses.find(driver);
  return found == uses.end() ? DeviceUse{} : found->second;
}

SafetyLimits stricter_of(SafetyLimits limits, const LabLimits& lab_limits) noexcept {
  tighten(limits.max_force_n, lab_limits.max_force_n);
  tighten(limits.max_slew_n_per_s, lab_limits.max_slew_n_per_s);
  limits.max_slew_n_per_s = std::max(limits.max_slew_n_per_s, limits.max_force_n / kMaxReleaseS);
  tighten(limits.max_speed_mm_s, lab_limits.max_speed_mm_s);
  if (limits.continuous_force_n > 0.0) {
    tighten(limits.continuous_force_n, lab_limits.continuous_force_n);
  } else {
    limits.continuous_force_n = lab_limits.continuous_force_n.value_or(0.0);
  }
  return limits;
}

std::filesystem::path default_device_settings_path() {
  const std::filesystem::path folder = user_config_folder();
  return folder.empty() ? folder : folder / "devices.json";
}

DeviceSettings load_device_settings(const std::filesystem::path& path) {
  if (!path.empty()) return read_device_settings(path);
  const std::filesystem::path default_path = default_device_settings_path();
  return !default_path.empty() && path_exists(default_path) ? read_device_settings(default_path)
                                                            : DeviceSettings{};
}

}  // namespace touchtrial::device
