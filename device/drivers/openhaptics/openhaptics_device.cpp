#include "device/drivers/openhaptics/openhaptics_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/exclusive_use.hpp"
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

/// Zero-force frames before the scheduler is stopped.
constexpr int kClosingZeros = 5;
/// How long to wait for these frames.
constexpr milliseconds kTimeout{500};
/// How long to wait for a callback that is still inside the library after the scheduler stopped.
constexpr milliseconds kCallbackTimeout{2000};

/// The values of the Touch, for a library that does not report them.
constexpr double kTouchMaxForceN = 3.3;
constexpr double kTouchContinuousForceN = 0.88;
/// 160 x 120 x 70 mm, about the library's origin.
constexpr Workspace kTouchWorkspace{{-80.0, -60.0, -35.0}, {80.0, 60.0, 35.0}};

std::string hd_error_text(const Api& api, std::uint32_t code) {
  const char* message = api.get_error_string(code);
  std::ostringstream text;
  text << (message != nullptr ? message : "error") << " (0x" << std::hex << code << ')';
  return text.str();
}

/// \return names to try; null is the default device, which some versions require by name
std::vector<const char*> candidate_names(const std::string& device_name) {
  if (!device_name.empty()) return {device_name.c_str()};
  return {nullptr, "Default Device", "Default PHANToM"};
}

std::optional<Handle> try_to_open(const Api& api, const char* name, Errors& errors) {
  const Handle device = api.init_device(name);
  const Errors current_errors = drain_errors(api);
  if (current_errors.oldest != 0) errors = current_errors;
  if (device == kInvalidHandle) return std::nullopt;
  if (current_errors.oldest == 0) return device;
  api.disable_device(device);
  (void)drain_errors(api);
  return std::nullopt;
}

Handle open_hd_device(const Api& api, const OpenHapticsSettings& settings) {
  Errors errors;
  (void)drain_errors(api);
  for (const char* name : candidate_names(settings.device)) {
    if (const auto device = try_to_open(api, name, errors)) return *device;
  }
  const std::string device_name = settings.device.empty() ? "the default device" : settings.device;
  throw DeviceError(one_line("openhaptics: " + device_name +
                             " does not open: " + hd_error_text(api, errors.oldest) +
                             "; plug it in, check it in the vendor's diagnostic with the same "
                             "GTDD_HOME, and close other programs that use it"));
}

std::string text_of(const Api& api, Enum parameter) {
  const char* text = api.get_string(parameter);
  const bool has_failed = drain_errors(api).oldest != 0;
  return has_failed || text == nullptr ? std::string() : one_line(text);
}

/// \return the numbers; nothing if the device does not report them
template <std::size_t count>
std::optional<std::array<double, count>> numbers_in(const Api& api, Enum parameter) {
  std::array<double, count> values{};
  api.get_doublev(parameter, values.data());
  if (drain_errors(api).oldest != 0) return std::nullopt;
  for (const double value : values) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return values;
}

double positive_or(const Api& api, Enum parameter, double fallback) {
  const auto value = numbers_in<1>(api, parameter);
  return value && (*value)[0] > 0.0 ? (*value)[0] : fallback;
}

/// Some versions of the library return text, others a number.
std::string firmware_of(const Api& api) {
  const std::string text = text_of(api, kFirmware);
  if (!text.empty()) return text;
  const auto number = numbers_in<1>(api, kFirmware);
  if (!number) return {};
  std::ostringstream digits;
  digits.imbue(std::locale::classic());
  digits << (*number)[0];
  return digits.str();
}

std::optional<Workspace> box_of(const Api& api, Enum parameter) {
  const auto values = numbers_in<6>(api, parameter);
  if (!values) return std::nullopt;
  const Workspace space{{(*values)[0], (*values)[1], (*values)[2]},
                        {(*values)[3], (*values)[4], (*values)[5]}};
  const bool has_volume = space.min_mm.x < space.max_mm.x && space.min_mm.y < space.max_mm.y &&
                          space.min_mm.z < space.max_mm.z;
  return has_volume ? std::optional(space) : std::nullopt;
}

/// Every device of this library has a device frame, so it needs a workspace.
Workspace workspace_of(const Api& api) {
  if (const auto usable = box_of(api, kUsableWorkspace)) return *usable;
  return box_of(api, kMaxWorkspace).value_or(kTouchWorkspace);
}

/// \return the best supported style, in the vendor's order of preference; 0 if there is none
int best_style_of(int styles) noexcept {
  for (const int style : {kStyleAuto, kStyleInkwell, kStyleEncoderReset}) {
    if ((styles & style) != 0) return style;
  }
  return 0;
}

std::string vendor_and_model(const std::string& vendor, const std::string& model) {
  return vendor.empty() || model.empty() ? vendor + model : vendor + ' ' + model;
}

/// The library has a global "current device" and breaks when loaded twice, so a process may have
/// only one user of it at a time.
std::atomic<bool> library_in_use{false};
constexpr const char* kInUse =
    "openhaptics: this program already has a device open, and the vendor's library supports one at "
    "a time; close it first";

/// The loaded library and an open device, without force or scheduler. Belongs to the thread that
/// opens it.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used or no device answers
  explicit Session(const OpenHapticsSettings& settings)
      : name_(settings.library.string()),
        library_(settings.library, Unload::never, kRemedy, Binding::as_needed),
        api_(load_api(library_)),
        device_(open_hd_device(api_, settings)) {
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
    info.model = vendor_and_model(text_of(api_, kVendor), text_of(api_, kModel));
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
    options.has_motor_temperature = numbers_in<6>(api_, kMotorTemperature).has_value();
    int styles = 0;
    api_.get_integerv(kCalibrationStyles, &styles);
    const bool are_reported = drain_errors(api_).oldest == 0 && styles != 0;
    if (are_reported) options.calibration_style = best_style_of(styles);
    return options;
  }

  /// \throws DeviceError naming the failed action, with the library's message, if there is an error
  void expect_no_error(const std::string& action) const {
    const Errors errors = drain_errors(api_);
    if (errors.oldest == 0) return;
    throw DeviceError(one_line(name_ + ": " + action +
                               " failed: " + hd_error_text(api_, errors.oldest) +
                               "; run the vendor's diagnostic"));
  }

 private:
  ExclusiveUse exclusive_use_{library_in_use, kInUse};
  std::string name_;  ///< of the library
  DynamicLibrary library_;
  Api api_;
  Handle device_;
};

void wait_for_zeros(const Loop& loop) noexcept {
  for (milliseconds waited(0); waited < kTimeout; ++waited) {
    if (loop.zeros_sent() >= kClosingZeros) return;
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

/// An open device with a running scheduler. The destructor follows the order that the vendor
/// requires: force to zero, scheduler stopped, callback unscheduled, device disabled.
class OpenHapticsDevice::Runtime {
 public:
  explicit Runtime(const OpenHapticsSettings& settings)
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
  ~Runtime() {
    loop_->link().halt();
    hd::wait_for_zeros(*loop_);
    stop();
  }
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

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
    is_scheduled_ = true;
    api.start_scheduler();
    session_.expect_no_error("starting the scheduler");
  }

  void stop() noexcept {
    const hd::Api& api = session_.api();
    api.stop_scheduler();
    // A callback that never returns still uses the loop, so the loop is leaked.
    if (!loop_->close(hd::kCallbackTimeout)) (void)loop_.release();
    if (is_scheduled_) api.unschedule(callback_);
    api.make_current_device(session_.device());
    api.disable(hd::kForceOutput);
    (void)hd::drain_errors(api);
  }

  hd::Session session_;
  DeviceInfo info_;
  std::unique_ptr<hd::Loop> loop_;
  hd::ScheduleHandle callback_ = 0;
  bool is_scheduled_ = false;
};

OpenHapticsDevice::OpenHapticsDevice(const OpenHapticsSettings& settings)
    : runtime_(std::make_unique<Runtime>(settings)) {
  info_ = runtime_->info();
}

OpenHapticsDevice::~OpenHapticsDevice() = default;

DeviceLink& OpenHapticsDevice::link() const noexcept {
  return runtime_->loop().link();
}

DeviceReadiness OpenHapticsDevice::readiness() const noexcept {
  return runtime_->loop().readiness();
}

void OpenHapticsDevice::calibrate() noexcept {
  runtime_->loop().calibrate();
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
          {"signs", "the signs of positions and forces on each axis"},
          {"force_scale", "whether the library's newton is a newton at the handle"},
          {"lengths", "whether the library's millimetre is a millimetre at the handle"},
          {"device_name",
           "which of the three names opens the device in each version",
           "Is openhaptics.device set in the device settings?",
           {"no", "default_device", "default_phantom", "own_name"}},
          {"calibration",
           "which calibration style the library requests, and whether calibration ends",
           "What did the program ask for before it began?",
           {"nothing", "moving", "inkwell", "reset_position", "vendor_calibration"}},
          {"premium_reset", "the calibration state that a Premium reports before any reset"},
          {"stiffness",
           "whether this model reports its maximum stiffness and damping, and the damping's unit"},
          {"soft_wall", "whether a wall below the stated stiffness is stable"},
          {"program_silent", "the motors' behaviour when the program is stopped or killed"},
          {"cable_silent", "the motors' behaviour when the cable is pulled"},
          {"temperatures", "whether this model reports temperatures on a scale from 0 to 1"}}};
}

}  // namespace touchtrial::device
