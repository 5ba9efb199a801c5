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
/// No desktop device reaches so far, and no hand is so fast.
constexpr double kAbsurdMm = 10'000.0;
constexpr double kAbsurdMmS = 1e6;

/// A structure for a plug-in to fill, followed by guard bytes.
template <typename Structure>
class Guarded {
 public:
  Guarded() noexcept {
    value.size = sizeof(Structure);
    guard_.fill(kMark);
  }
  [[nodiscard]] bool is_whole() const noexcept {
    return std::all_of(guard_.begin(), guard_.end(), [](unsigned char c) { return c == kMark; });
  }

  Structure value{};

 private:
  static constexpr unsigned char kMark = 0xa5;
  std::array<unsigned char, 256> guard_{};
};

[[noreturn]] void refuse_plugin(const std::string& who, const std::string& what) {
  throw DeviceError(one_line(who + ": " + what + "; " + kRemedy));
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

void expect_sound_api(const std::string& file, const touchtrial_device_api* api) {
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
  for (const auto& [name, is_there] : functions) {
    if (!is_there) refuse_plugin(file, "has no function " + std::string(name));
  }
}

std::string sound_name(const std::string& file, const char* name) {
  const std::size_t length = name == nullptr ? 0 : length_of(name, kMaxNameBytes + 1);
  const bool is_sound = length > 0 && length <= kMaxNameBytes &&
                        std::all_of(name, name + length, [](unsigned char c) {
                          return c < 0x80 && (std::isalnum(c) != 0 || c == '-' || c == '_');
                        });
  if (!is_sound) {
    refuse_plugin(
        file, "has no name of 1 to " + std::to_string(kMaxNameBytes) + " letters, digits, - and _");
  }
  return {name, length};
}

/// Validates a description.
class DescriptionCheck {
 public:
  explicit DescriptionCheck(std::string who) : origin_(std::move(who)) {}

  /// \return the value, if low < value <= high, or value == low where that belongs to the range
  double in_range(const char* field, double value, double low, double high, bool has_low) const {
    if ((value > low || (has_low && value == low)) && value <= high) return value;
    refuse(std::string(field) + " is " + (std::isfinite(value) ? number_text(value) : "no number") +
           ", must be " + (has_low ? "from " : "above ") + number_text(low) + " to " +
           number_text(high));
  }
  [[noreturn]] void refuse(const std::string& what) const {
    refuse_plugin(origin_, "describe: " + what);
  }

 private:
  std::string origin_;
};

Workspace workspace_in(const touchtrial_device_description& told, const DescriptionCheck& judge) {
  const auto& min = told.workspace_least_mm;
  const auto& max = told.workspace_greatest_mm;
  for (int axis = 0; axis < 3; ++axis) {
    (void)judge.in_range("workspace_least_mm", min[axis], -kMaxSideMm, kMaxSideMm, true);
    (void)judge.in_range("a side of the workspace in mm", max[axis] - min[axis], kMinSideMm,
                         kMaxSideMm, true);
  }
  if (told.shape > TOUCHTRIAL_DEVICE_ELLIPSOID) {
    judge.refuse("shape is " + std::to_string(told.shape) + ", must be 0 or 1");
  }
  return {{min[0], min[1], min[2]},
          {max[0], max[1], max[2]},
          told.shape == TOUCHTRIAL_DEVICE_BOX ? WorkspaceShape::box : WorkspaceShape::ellipsoid};
}

PluginFault trouble_of_code(std::int32_t code) noexcept {
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

std::optional<DeviceReadiness> readiness_in(std::uint32_t told) noexcept {
  switch (told) {
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
  expect_sound_api(file_, api_);
  name_ = sound_name(file_, api_->name);
}

std::optional<Vec3> Library::observed_force_n() const noexcept {
  std::array<double, 3> force{};
  if (observe_ == nullptr || observe_(force.data()) != 0) return std::nullopt;
  const Vec3 force_n{force[0], force[1], force[2]};
  return is_finite(force_n) ? std::optional(force_n) : std::nullopt;
}

DeviceFault fault_of(PluginFault trouble) noexcept {
  switch (trouble) {
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

const char* words_for(PluginFault trouble) noexcept {
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
  return name_in(kNames, trouble).data();
}

OpenDevice::OpenDevice(const Library& library, const std::string& settings) : library_(library) {
  std::array<char, 512> error{};
  device_ = library.api().open(settings.c_str(), error.data(), error.size() - 1);
  if (device_ != nullptr) return;
  const std::string words(error.data(), length_of(error.data(), error.size() - 1));
  throw DeviceError(
      one_line("plugin " + library.name() + ": does not open: " +
               (words.empty() ? "it gives no reason; see its own documentation" : words)));
}

OpenDevice::~OpenDevice() {
  library_.api().close(device_);
}

DeviceInfo OpenDevice::info() const {
  const DescriptionCheck judge("plugin " + library_.name());
  Guarded<touchtrial_device_description> guarded;
  const std::int32_t code = library_.api().describe(device_, &guarded.value);
  const touchtrial_device_description& told = guarded.value;
  if (code != TOUCHTRIAL_DEVICE_OK) judge.refuse("it returned " + std::to_string(code));
  if (!guarded.is_whole()) judge.refuse(words_for(PluginFault::wrote_past));
  DeviceInfo info;
  info.name = "plugin";
  info.serial = text_in(told.serial);
  if (info.serial.empty()) judge.refuse("serial is empty; certificates belong to one device");
  const std::string model = text_in(told.model);
  info.model = library_.name() + (model.empty() ? "" : ": " + model);
  info.firmware = text_in(told.firmware);
  info.max_force_n = judge.in_range("max_force_n", told.max_force_n, 0.0, kMaxForceN, false);
  info.continuous_force_n =
      judge.in_range("continuous_force_n", told.continuous_force_n, 0.0, told.max_force_n, true);
  info.max_rate_hz = judge.in_range("max_rate_hz", told.max_rate_hz, kMinRateHz, kMaxRateHz, true);
  info.max_stiffness_n_per_mm = judge.in_range(
      "max_stiffness_n_per_mm", told.max_stiffness_n_per_mm, 0.0, kMaxStiffnessNPerMm, true);
  info.workspace = workspace_in(told, judge);
  info.has_encoders = true;
  return info;
}

Reading OpenDevice::sample() noexcept {
  Guarded<touchtrial_device_sample> guarded;
  Reading reading;
  reading.trouble = trouble_of_code(library_.api().sample(device_, &guarded.value));
  if (!guarded.is_whole()) reading.trouble = PluginFault::wrote_past;
  if (reading.trouble != PluginFault::none) return reading;
  const touchtrial_device_sample& told = guarded.value;
  const std::optional<DeviceReadiness> readiness = readiness_in(told.readiness);
  if (!readiness) {
    reading.trouble = PluginFault::unknown_readiness;
    return reading;
  }
  reading.readiness = *readiness;
  DeviceSample& sample = reading.sample;
  sample.position_mm = {told.position_mm[0], told.position_mm[1], told.position_mm[2]};
  sample.velocity_mm_s = {told.velocity_mm_s[0], told.velocity_mm_s[1], told.velocity_mm_s[2]};
  sample.buttons = told.buttons;
  sample.ready = *readiness == DeviceReadiness::ready;
  reading.trouble =
      told.sequence < last_sequence_ ? PluginFault::sequence_decreased : motion_fault(sample);
  reading.is_new = told.sequence > last_sequence_;
  last_sequence_ = told.sequence;
  return reading;
}

PluginFault OpenDevice::force(Vec3 force_n) noexcept {
  const std::array<double, 3> force = {force_n.x, force_n.y, force_n.z};
  return trouble_of_code(library_.api().force(device_, force.data()));
}

PluginFault OpenDevice::enable(bool on) noexcept {
  const auto enable = library_.api().enable;
  return enable == nullptr ? PluginFault::none : trouble_of_code(enable(device_, on ? 1 : 0));
}

}  // namespace touchtrial::device::plugin
