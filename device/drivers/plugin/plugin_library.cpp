#include "device/drivers/plugin/plugin_library.hpp"

#include "core/errors.hpp"
#include "core/named.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string_view>

namespace touchtrial::device::plugin {
namespace {

constexpr std::size_t kMaxNameBytes = 32;
constexpr double kMaxForceN = 100.0;
constexpr double kMaxStiffnessNPerMm = 100.0;
constexpr double kMinRateHz = 500.0;
constexpr double kMaxRateHz = 10'000.0;
constexpr double kMinSideMm = 1.0;
constexpr double kMaxSideMm = 2000.0;
/// Limits beyond any desktop device's reach and any hand's speed.
constexpr double kAbsurdMm = 10'000.0;
constexpr double kAbsurdMmS = 1e6;

/// A structure for a plug-in to fill, followed by guard bytes.
template <typename Structure>
class Guarded {
 public:
  Guarded() noexcept {
    value.size = sizeof(Structure);
    guard_.fill(kGuardByte);
  }
  [[nodiscard]] bool is_intact() const noexcept {
    return std::all_of(guard_.begin(), guard_.end(),
                       [](unsigned char c) { return c == kGuardByte; });
  }

  Structure value{};

 private:
  static constexpr unsigned char kGuardByte = 0xa5;
  std::array<unsigned char, 256> guard_{};
};

[[noreturn]] void refuse_plugin(const std::string& origin, const std::string& problem) {
  throw DeviceError(one_line(origin + ": " + problem + "; " + kRemedy));
}

/// \return the length of a text, at most `max`
std::size_t length_of(const char* text, std::size_t max) noexcept {
  const void* const end = std::memchr(text, 0, max);
  return end == nullptr ? max : static_cast<std::size_t>(static_cast<const char*>(end) - text);
}

template <std::size_t size>
std::string text_in(const char (&text)[size]) {
  return one_line(std::string(text, length_of(text, size)));
}

void check_api(const std::string& file, const touchtrial_device_api* api) {
  if (api == nullptr) refuse_plugin(file, "touchtrial_device_v1 returned nothing");
  if (api->version != TOUCHTRIAL_DEVICE_VERSION) {
    refuse_plugin(file, "has version " + std::to_string(api->version) +
                            " of the interface, this program has " +
                            std::to_string(TOUCHTRIAL_DEVICE_VERSION));
  }
  if (api->size < sizeof(touchtrial_device_api)) {
    refuse_plugin(file, "has an interface of " + std::to_string(api->size) + " bytes, not " +
                            std::to_string(sizeof(touchtrial_device_api)));
  }
  const std::array<std::pair<const char*, bool>, 5> functions = {
      {{"open", api->open != nullptr},
       {"describe", api->describe != nullptr},
       {"sample", api->sample != nullptr},
       {"force", api->force != nullptr},
       {"close", api->close != nullptr}}};
  for (const auto& [name, exists] : functions) {
    if (!exists) refuse_plugin(file, "has no function " + std::string(name));
  }
}

std::string checked_name(const std::string& file, const char* name) {
  const std::size_t length = name == nullptr ? 0 : length_of(name, kMaxNameBytes + 1);
  const bool is_valid = length > 0 && length <= kMaxNameBytes &&
                        std::all_of(name, name + length, [](unsigned char c) {
                          return c < 0x80 && (std::isalnum(c) != 0 || c == '-' || c == '_');
                        });
  if (!is_valid) {
    refuse_plugin(
        file, "has no name of 1 to " + std::to_string(kMaxNameBytes) + " letters, digits, - and _");
  }
  return {name, length};
}

/// Validates a description.
class DescriptionCheck {
 public:
  explicit DescriptionCheck(std::string origin) : origin_(std::move(origin)) {}

  /// \param includes_low  whether the value may equal `low`
  /// \return the value, if it is in range
  double in_range(const char* field, double value, double low, double high,
                  bool includes_low) const {
    if ((value > low || (includes_low && value == low)) && value <= high) return value;
    refuse(std::string(field) + " is " + (std::isfinite(value) ? number_text(value) : "no number") +
           ", must be " + (includes_low ? "from " : "above ") + number_text(low) + " to " +
           number_text(high));
  }
  [[noreturn]] void refuse(const std::string& problem) const {
    refuse_plugin(origin_, "describe: " + problem);
  }

 private:
  std::string origin_;
};

Workspace workspace_in(const touchtrial_device_description& description,
                       const DescriptionCheck& checker) {
  const auto& min = description.workspace_least_mm;
  const auto& max = description.workspace_greatest_mm;
  for (int axis = 0; axis < 3; ++axis) {
    (void)checker.in_range("workspace_least_mm", min[axis], -kMaxSideMm, kMaxSideMm, true);
    (void)checker.in_range("a side of the workspace in mm", max[axis] - min[axis], kMinSideMm,
                           kMaxSideMm, true);
  }
  if (description.shape > TOUCHTRIAL_DEVICE_ELLIPSOID) {
    checker.refuse("shape is " + std::to_string(description.shape) + ", must be 0 or 1");
  }
  return {
      {min[0], min[1], min[2]},
      {max[0], max[1], max[2]},
      description.shape == TOUCHTRIAL_DEVICE_BOX ? WorkspaceShape::box : WorkspaceShape::ellipsoid};
}

PluginFault fault_of_code(std::int32_t code) noexcept {
  switch (code) {
    case TOUCHTRIAL_DEVICE_OK:
      return PluginFault::none;
    case TOUCHTRIAL_DEVICE_LOST:
      return PluginFault::lost;
    case TOUCHTRIAL_DEVICE_BAD_DATA:
      return PluginFault::bad_data;
    case TOUCHTRIAL_DEVICE_WARM_MOTORS:
      return PluginFault::warm_motors;
    case TOUCHTRIAL_DEVICE_LIMIT_PASSED:
      return PluginFault::limit_passed;
    default:
      return PluginFault::failed;
  }
}

std::optional<DeviceReadiness> readiness_in(std::uint32_t number) noexcept {
  switch (number) {
    case TOUCHTRIAL_DEVICE_READY:
      return DeviceReadiness::ready;
    case TOUCHTRIAL_DEVICE_NEEDS_HOMING:
      return DeviceReadiness::needs_homing;
    case TOUCHTRIAL_DEVICE_NEEDS_INKWELL:
      return DeviceReadiness::needs_inkwell;
    case TOUCHTRIAL_DEVICE_NEEDS_CALIBRATION:
      return DeviceReadiness::needs_calibration;
    default:
      return std::nullopt;
  }
}

bool is_absurd(Vec3 v, double limit) noexcept {
  return std::abs(v.x) > limit || std::abs(v.y) > limit || std::abs(v.z) > limit;
}

PluginFault motion_fault(const DeviceSample& sample) noexcept {
  if (!is_finite(sample.position_mm) || !is_finite(sample.velocity_mm_s)) {
    return PluginFault::not_finite;
  }
  if (is_absurd(sample.position_mm, kAbsurdMm) || is_absurd(sample.velocity_mm_s, kAbsurdMmS)) {
    return PluginFault::absurd;
  }
  return PluginFault::none;
}

}  // namespace

Library::Library(const std::filesystem::path& file)
    : file_(file.string()), library_(file, Unload::never, kRemedy) {
  decltype(&touchtrial_device_v1) entry = nullptr;
  library_.find("touchtrial_device_v1", entry);
  library_.find_if_any("touchtrial_device_observe_v1", observe_);
  api_ = entry();
  check_api(file_, api_);
  name_ = checked_name(file_, api_->name);
}

std::optional<Vec3> Library::observed_force_n() const noexcept {
  std::array<double, 3> force{};
  if (observe_ == nullptr || observe_(force.data()) != 0) return std::nullopt;
  const Vec3 force_n{force[0], force[1], force[2]};
  return is_finite(force_n) ? std::optional(force_n) : std::nullopt;
}

DeviceFault fault_of(PluginFault plugin_fault) noexcept {
  switch (plugin_fault) {
    case PluginFault::none:
      return DeviceFault::none;
    case PluginFault::lost:
      return DeviceFault::link_lost;
    case PluginFault::warm_motors:
      return DeviceFault::warm_motors;
    case PluginFault::limit_passed:
      return DeviceFault::limit_passed;
    case PluginFault::failed:
      return DeviceFault::driver;
    default:
      return DeviceFault::bad_data;
  }
}

const char* fault_text(PluginFault plugin_fault) noexcept {
  using enum PluginFault;
  static constexpr auto kNames = std::to_array<Named<PluginFault>>(
      {{"nothing is wrong", none},
       {"returned LOST", lost},
       {"returned BAD_DATA", bad_data},
       {"returned WARM_MOTORS", warm_motors},
       {"returned LIMIT_PASSED", limit_passed},
       {"returned FAILED or an unknown number", failed},
       {"gave a position or velocity that is not a number", not_finite},
       {"gave a position beyond 10 m or a velocity beyond 1 km/s", absurd},
       {"gave a reading with a smaller number than the one before", sequence_decreased},
       {"gave a readiness that the interface does not have", unknown_readiness},
       {"wrote beyond the size of a structure", wrote_past}});
  return name_in(kNames, plugin_fault).data();
}

OpenDevice::OpenDevice(const Library& library, const std::string& settings) : library_(library) {
  std::array<char, 512> error{};
  device_ = library.api().open(settings.c_str(), error.data(), error.size() - 1);
  if (device_ != nullptr) return;
  const std::string reason(error.data(), length_of(error.data(), error.size() - 1));
  throw DeviceError(
      one_line("plugin " + library.name() + ": does not open: " +
               (reason.empty() ? "it gives no reason; see its own documentation" : reason)));
}

OpenDevice::~OpenDevice() {
  library_.api().close(device_);
}

DeviceInfo OpenDevice::info() const {
  const DescriptionCheck checker("plugin " + library_.name());
  Guarded<touchtrial_device_description> guarded;
  const std::int32_t code = library_.api().describe(device_, &guarded.value);
  const touchtrial_device_description& description = guarded.value;
  if (code != TOUCHTRIAL_DEVICE_OK) checker.refuse("it returned " + std::to_string(code));
  if (!guarded.is_intact()) checker.refuse(fault_text(PluginFault::wrote_past));
  DeviceInfo info;
  info.name = "plugin";
  info.serial = text_in(description.serial);
  if (info.serial.empty()) checker.refuse("serial is empty; certificates belong to one device");
  const std::string model = text_in(description.model);
  info.model = library_.name() + (model.empty() ? "" : ": " + model);
  info.firmware = text_in(description.firmware);
  info.max_force_n =
      checker.in_range("max_force_n", description.max_force_n, 0.0, kMaxForceN, false);
  info.continuous_force_n = checker.in_range("continuous_force_n", description.continuous_force_n,
                                             0.0, description.max_force_n, true);
  info.max_rate_hz =
      checker.in_range("max_rate_hz", description.max_rate_hz, kMinRateHz, kMaxRateHz, true);
  info.max_stiffness_n_per_mm = checker.in_range(
      "max_stiffness_n_per_mm", description.max_stiffness_n_per_mm, 0.0, kMaxStiffnessNPerMm, true);
  info.workspace = workspace_in(description, checker);
  info.has_encoders = true;
  return info;
}

Reading OpenDevice::sample() noexcept {
  Guarded<touchtrial_device_sample> guarded;
  Reading reading;
  reading.plugin_fault = fault_of_code(library_.api().sample(device_, &guarded.value));
  if (!guarded.is_intact()) reading.plugin_fault = PluginFault::wrote_past;
  if (reading.plugin_fault != PluginFault::none) return reading;
  const touchtrial_device_sample& plugin_sample = guarded.value;
  const std::optional<DeviceReadiness> readiness = readiness_in(plugin_sample.readiness);
  if (!readiness) {
    reading.plugin_fault = PluginFault::unknown_readiness;
    return reading;
  }
  reading.readiness = *readiness;
  DeviceSample& sample = reading.sample;
  sample.position_mm = {plugin_sample.position_mm[0], plugin_sample.position_mm[1],
                        plugin_sample.position_mm[2]};
  sample.velocity_mm_s = {plugin_sample.velocity_mm_s[0], plugin_sample.velocity_mm_s[1],
                          plugin_sample.velocity_mm_s[2]};
  sample.buttons = plugin_sample.buttons;
  sample.ready = *readiness == DeviceReadiness::ready;
  reading.plugin_fault = plugin_sample.sequence < last_sequence_ ? PluginFault::sequence_decreased
                                                                 : motion_fault(sample);
  reading.is_new = plugin_sample.sequence > last_sequence_;
  last_sequence_ = plugin_sample.sequence;
  return reading;
}

PluginFault OpenDevice::force(Vec3 force_n) noexcept {
  const std::array<double, 3> force = {force_n.x, force_n.y, force_n.z};
  return fault_of_code(library_.api().force(device_, force.data()));
}

PluginFault OpenDevice::enable(bool on) noexcept {
  const auto enable = library_.api().enable;
  return enable == nullptr ? PluginFault::none : fault_of_code(enable(device_, on ? 1 : 0));
}

}  // namespace touchtrial::device::plugin
