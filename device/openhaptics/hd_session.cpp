#include "device/openhaptics/hd_session.hpp"

#include "core/errors.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

namespace touchtrial::device::hd {
namespace {

/// Of the Touch, for a library that does not tell.
constexpr double kTouchMaxForceN = 3.3;
constexpr double kTouchContinuousForceN = 0.88;
/// 160 x 120 x 70 mm, about the library's origin.
constexpr Workspace kTouchWorkspace{{-80.0, -60.0, -35.0}, {80.0, 60.0, 35.0}};

std::atomic<bool> in_use{false};

std::string words_for(const Api& api, std::uint32_t code) {
  const char* words = api.get_error_string(code);
  std::ostringstream text;
  text << (words != nullptr ? words : "error") << " (0x" << std::hex << code << ')';
  return text.str();
}

/// Null is the library's default; some versions know it by one of its names alone.
std::vector<const char*> names_to_try(const std::string& wanted) {
  if (!wanted.empty()) return {wanted.c_str()};
  return {nullptr, "Default Device", "Default PHANToM"};
}

std::optional<Handle> try_to_open(const Api& api, const char* name, Errors& errors) {
  const Handle device = api.init_device(name);
  const Errors now = drain_errors(api);
  if (now.oldest != 0) errors = now;
  if (device == kInvalidHandle) return std::nullopt;
  if (now.oldest == 0) return device;
  api.disable_device(device);
  (void)drain_errors(api);
  return std::nullopt;
}

Handle open_device_of(const Api& api, const OpenHapticsSettings& settings) {
  Errors errors;
  (void)drain_errors(api);
  for (const char* name : names_to_try(settings.device)) {
    if (const auto device = try_to_open(api, name, errors)) return *device;
  }
  const std::string wanted = settings.device.empty() ? "the default device" : settings.device;
  throw DeviceError(one_line("openhaptics: " + wanted +
                             " does not open: " + words_for(api, errors.oldest) +
                             "; plug it in, let the vendor's diagnostic find it, and close other "
                             "programs that use it"));
}

std::string text_of(const Api& api, Enum what) {
  const char* text = api.get_string(what);
  const bool failed = drain_errors(api).oldest != 0;
  return failed || text == nullptr ? std::string() : one_line(text);
}

/// \return nothing if the device does not tell
template <std::size_t count>
std::optional<std::array<double, count>> numbers_of(const Api& api, Enum what) {
  std::array<double, count> values{};
  api.get_doublev(what, values.data());
  if (drain_errors(api).oldest != 0) return std::nullopt;
  for (const double value : values) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return values;
}

double positive_or(const Api& api, Enum what, double otherwise) {
  const auto value = numbers_of<1>(api, what);
  return value && (*value)[0] > 0.0 ? (*value)[0] : otherwise;
}

/// A text by some versions of the library, a number by others.
std::string firmware_of(const Api& api) {
  const std::string text = text_of(api, kFirmware);
  if (!text.empty()) return text;
  const auto number = numbers_of<1>(api, kFirmware);
  if (!number) return {};
  std::ostringstream digits;
  digits.imbue(std::locale::classic());
  digits << (*number)[0];
  return digits.str();
}

std::optional<Workspace> box_of(const Api& api, Enum what) {
  const auto w = numbers_of<6>(api, what);
  if (!w) return std::nullopt;
  const Workspace space{{(*w)[0], (*w)[1], (*w)[2]}, {(*w)[3], (*w)[4], (*w)[5]}};
  const bool has_volume = space.least_mm.x < space.greatest_mm.x &&
                          space.least_mm.y < space.greatest_mm.y &&
                          space.least_mm.z < space.greatest_mm.z;
  return has_volume ? std::optional(space) : std::nullopt;
}

/// A device of the library's always has a frame of its own, so there is no going without.
Workspace workspace_of(const Api& api) {
  if (const auto usable = box_of(api, kUsableWorkspace)) return *usable;
  return box_of(api, kMaxWorkspace).value_or(kTouchWorkspace);
}

std::string joined(const std::string& vendor, const std::string& model) {
  return vendor.empty() || model.empty() ? vendor + model : vendor + ' ' + model;
}

}  // namespace

OnlyUser::OnlyUser() {
  if (in_use.exchange(true)) {
    throw DeviceError(
        "openhaptics: a device is open already in this program, and the vendor's library serves "
        "one at a time; close that one first");
  }
}

OnlyUser::~OnlyUser() {
  in_use.store(false);
}

Session::Session(const OpenHapticsSettings& settings)
    : name_(settings.library.string()),
      library_(settings.library, Unload::never, kRemedy),
      api_(load_api(library_)),
      device_(open_device_of(api_, settings)) {
  api_.make_current_device(device_);
}

Session::~Session() {
  api_.disable_device(device_);
  (void)drain_errors(api_);
}

DeviceInfo Session::info() const {
  DeviceInfo info;
  info.name = "openhaptics";
  info.model = joined(text_of(api_, kVendor), text_of(api_, kModel));
  info.serial = text_of(api_, kSerial);
  info.firmware = firmware_of(api_);
  info.max_force_n = positive_or(api_, kMaxForce, kTouchMaxForceN);
  info.continuous_force_n = positive_or(api_, kContinuousForce, kTouchContinuousForceN);
  info.max_stiffness_n_per_mm = positive_or(api_, kMaxStiffness, 0.0);
  info.workspace = workspace_of(api_);
  return info;
}

LoopOptions Session::loop_options() const {
  LoopOptions options;
  options.has_motor_temperature = numbers_of<6>(api_, kMotorTemperature).has_value();
  int styles = 0;
  api_.get_integerv(kCalibrationStyles, &styles);
  const bool told = drain_errors(api_).oldest == 0 && styles != 0;
  if (told && (styles & kStyleInkwell) == 0) options.calibration_style = styles & kStyleAuto;
  return options;
}

void Session::expect_no_error(const std::string& what) const {
  const Errors errors = drain_errors(api_);
  if (errors.oldest == 0) return;
  throw DeviceError(one_line(name_ + ": " + what + " failed: " + words_for(api_, errors.oldest) +
                             "; run the vendor's diagnostic"));
}

}  // namespace touchtrial::device::hd
