#include "device/drivers/openhaptics/openhaptics_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/only_user.hpp"
#include "device/drivers/openhaptics/hd_loop.hpp"
#include "device/model/workspace_fit.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace touchtrial::device {
namespace hd {
namespace {

using std::chrono::milliseconds;

/// The remedy for a library that cannot be used.
constexpr const char* kRemedy =
    "install the vendor's OpenHaptics and its device driver, with the libraries that they need "
    "(docs/devices/openhaptics.md), or name the library in the device settings at "
    "openhaptics.library";

/// Frames of zero before the scheduler is stopped, and how long to wait for them.
constexpr int kZerosAtTheEnd = 5;
constexpr milliseconds kTimeout{500};
/// The time for a callback that is still inside the library after the scheduler was stopped.
constexpr milliseconds kCallbackTimeout{2000};

/// The values of the Touch, for a library that does not report them.
constexpr double kTouchMaxForceN = 3.3;
constexpr double kTouchContinuousForceN = 0.88;
/// 160 x 120 x 70 mm, about the library's origin.
constexpr Workspace kTouchWorkspace{{-80.0, -60.0, -35.0}, {80.0, 60.0, 35.0}};

std::string words_for(const Api& api, std::uint32_t code) {
  const char* words = api.get_error_string(code);
  std::ostringstream text;
  text << (words != nullptr ? words : "error") << " (0x" << std::hex << code << ')';
  return text.str();
}

/// Null means the default device; some versions require one of its names.
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
                             "; plug it in, let the vendor's diagnostic find it with the same "
                             "GTDD_HOME as here, and close other programs that use it"));
}

std::string text_of(const Api& api, Enum what) {
  const char* text = api.get_string(what);
  const bool failed = drain_errors(api).oldest != 0;
  return failed || text == nullptr ? std::string() : one_line(text);
}

/// \return nothing if the device does not report it
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

/// Some versions of the library return text, others a number.
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
  const bool has_volume = space.min_mm.x < space.max_mm.x && space.min_mm.y < space.max_mm.y &&
                          space.min_mm.z < space.max_mm.z;
  return has_volume ? std::optional(space) : std::nullopt;
}

/// The library's devices always have a frame of their own, so each needs a workspace.
Workspace workspace_of(const Api& api) {
  if (const auto usable = box_of(api, kUsableWorkspace)) return *usable;
  return box_of(api, kMaxWorkspace).value_or(kTouchWorkspace);
}

/// The vendor's order of preference.
int best_style_of(int styles) noexcept {
  for (const int style : {kStyleAuto, kStyleInkwell, kStyleEncoderReset}) {
    if ((styles & style) != 0) return style;
  }
  return 0;
}

std::string joined(const std::string& vendor, const std::string& model) {
  return vendor.empty() || model.empty() ? vendor + model : vendor + ' ' + model;
}

/// The library has a global "current device" and breaks when loaded twice, so a process may use it
/// once at a time.
std::atomic<bool> library_in_use{false};
constexpr const char* kInUse =
    "openhaptics: this program has a device open already, and the vendor's library serves one at a "
    "time; close that one first";

/// The loaded library and one device of it, without force or scheduler. Belongs to the thread that
/// opens it.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used or no device answers
  explicit Session(const OpenHapticsSettings& settings)
      : name_(settings.library.string()),
        library_(settings.library, Unload::never, kRemedy, Binding::as_needed),
        api_(load_api(library_)),
        device_(open_device_of(api_, settings)) {
    api_.make_current_device(device_);
  }
  ~Session() {
    api_.disable_device(device_);
    (void)drain_errors(api_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Api& api() const noexcept { return api_; }
  [[nodiscard]] Handle device() const noexcept { return device_; }

  [[nodiscard]] DeviceInfo info() const {
    DeviceInfo info;
    info.name = "openhaptics";
    info.model = joined(text_of(api_, kVendor), text_of(api_, kModel));
    info.serial = text_of(api_, kSerial);
    info.firmware = firmware_of(api_);
    info.library = text_of(api_, kVersion);
    info.max_force_n = positive_or(api_, kMaxForce, kTouchMaxForceN);
    info.continuous_force_n = positive_or(api_, kContinuousForce, kTouchContinuousForceN);
    info.max_stiffness_n_per_mm = positive_or(api_, kMaxStiffness, 0.0);
    info.max_damping_n_s_per_mm = positive_or(api_, kMaxDamping, 0.0);
    info.workspace = workspace_of(api_);
    info.has_encoders = true;
    return info;
  }

  [[nodiscard]] LoopOptions loop_options() const {
    LoopOptions options;
    options.has_motor_temperature = numbers_of<6>(api_, kMotorTemperature).has_value();
    int styles = 0;
    api_.get_integerv(kCalibrationStyles, &styles);
    const bool told = drain_errors(api_).oldest == 0 && styles != 0;
    if (told) options.calibration_style = best_style_of(styles);
    return options;
  }

  /// \throws DeviceError naming what failed, with the library's message, if there is an error
  void expect_no_error(const std::string& what) const {
    const Errors errors = drain_errors(api_);
    if (errors.oldest == 0) return;
    throw DeviceError(one_line(name_ + ": " + what + " failed: " + words_for(api_, errors.oldest) +
                               "; run the vendor's diagnostic"));
  }

 private:
  OnlyUser only_user_{library_in_use, kInUse};
  std::string name_;  ///< of the library
  DynamicLibrary library_;
  Api api_;
  Handle device_;
};

void wait_for_zeros(const Loop& loop) noexcept {
  for (milliseconds waited(0); waited < kTimeout; ++waited) {
    if (loop.zeros_sent() >= kZerosAtTheEnd) return;
    std::this_thread::sleep_for(milliseconds(1));
  }
}

std::vector<DeviceListing> list_openhaptics(const DeviceSettings& settings) {
  DeviceListing listing;
  listing.driver = "openhaptics";
  listing.where = settings.openhaptics.library.string();
  try {
    check_loads(settings.openhaptics.library, kRemedy, Binding::as_needed);
    const DeviceInfo info = Session(settings.openhaptics).info();
    listing.model = info.model;
    listing.serial = info.serial;
    listing.present = true;
    if (const std::string limits = rendering_limits_text(info); !limits.empty()) {
      listing.notes = {limits + ", as it reports"};
    }
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_openhaptics(const DeviceSettings& settings) {
  check_loads(settings.openhaptics.library, kRemedy, Binding::as_needed);
  return std::make_unique<OpenHapticsDevice>(settings.openhaptics);
}

}  // namespace
}  // namespace hd

/// An open device whose scheduler runs. It ends in the order that the vendor requires: force to
/// zero, scheduler stopped, callback unscheduled, device disabled.
class OpenHapticsDevice::Running {
 public:
  explicit Running(const OpenHapticsSettings& settings)
      : session_(settings),
        info_(session_.info()),
        loop_(std::make_unique<hd::Loop>(session_.api(), session_.device(),
                                         session_.loop_options())) {
    info_.max_rate_hz = static_cast<double>(settings.rate_hz);
    try {
      start(settings.rate_hz);
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Running() {
    loop_->link().halt();
    hd::wait_for_zeros(*loop_);
    stop();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] hd::Loop& loop() noexcept { return *loop_; }

 private:
  void start(unsigned long rate_hz) {
    const hd::Api& api = session_.api();
    api.set_scheduler_rate(rate_hz);
    session_.expect_no_error("openhaptics.rate_hz = " + std::to_string(rate_hz));
    api.enable(hd::kForceOutput);
    api.enable(hd::kForceClamping);
    api.enable(hd::kForceRamping);
    session_.expect_no_error("switching force on");
    callback_ = api.schedule_asynchronous(&hd::Loop::callback, loop_.get(), hd::kHighestPriority);
    session_.expect_no_error("scheduling the servo");
    scheduled_ = true;
    api.start_scheduler();
    session_.expect_no_error("starting the scheduler");
  }

  void stop() noexcept {
    const hd::Api& api = session_.api();
    api.stop_scheduler();
    // A callback that never returns still uses the loop, so leak it instead of freeing it.
    if (!loop_->close(hd::kCallbackTimeout)) (void)loop_.release();
    if (scheduled_) api.unschedule(callback_);
    api.make_current_device(session_.device());
    api.disable(hd::kForceOutput);
    (void)hd::drain_errors(api);
  }

  hd::Session session_;
  DeviceInfo info_;
  std::unique_ptr<hd::Loop> loop_;
  hd::ScheduleHandle callback_ = 0;
  bool scheduled_ = false;
};

OpenHapticsDevice::OpenHapticsDevice(const OpenHapticsSettings& settings)
    : running_(std::make_unique<Running>(settings)) {
  info_ = running_->info();
}

OpenHapticsDevice::~OpenHapticsDevice() = default;

DeviceLink& OpenHapticsDevice::link() const noexcept {
  return running_->loop().link();
}

DeviceReadiness OpenHapticsDevice::readiness() const noexcept {
  return running_->loop().readiness();
}

void OpenHapticsDevice::calibrate() noexcept {
  running_->loop().calibrate();
}

/// Sources of unverified facts: this driver's page in docs/devices.
DeviceDriver openhaptics_driver() {
  return {
      .name = "openhaptics",
      .what = "3D Systems Touch and Phantom, through the vendor's OpenHaptics",
      .list = hd::list_openhaptics,
      .open = hd::open_openhaptics,
      .workspace_is_known = false,
      .products = {{"touch", "3D Systems Touch", "touch"},
                   {"touch_x", "3D Systems Touch X", "touch_x"},
                   {"phantom", "any Phantom"},
                   {"omni", "Phantom Omni", "touch"},
                   {"desktop", "Phantom Desktop", "touch_x"},
                   {"premium", "Phantom Premium", "premium_1_5"}},
      .unverified = {
          {"signs", "which way positions and forces run on each axis"},
          {"force_scale", "whether a newton of the library is one at the handle"},
          {"lengths", "whether a millimetre of the library is one at the handle"},
          {"device_name",
           "which of the three names opens a device in which version",
           "Is openhaptics.device set in the device settings?",
           {"no", "default_device", "default_phantom", "own_name"}},
          {"calibration",
           "which calibration style the library asks for, and whether it ends",
           "What did the program ask for before it began?",
           {"nothing", "moving", "inkwell", "reset_position", "vendor_calibration"}},
          {"premium_reset", "what a Premium that was never reset says of its calibration"},
          {"stiffness",
           "the largest stiffness, and the unit of the largest damping: whether this model states "
           "both"},
          {"soft_wall", "whether a wall below the stated stiffness is stable"},
          {"program_silent", "what the motors do when the program is stopped or killed"},
          {"cable_silent", "what the motors do when the cable is pulled"},
          {"temperatures", "whether this model gives temperatures on a scale from 0 to 1"}}};
}

}  // namespace touchtrial::device
