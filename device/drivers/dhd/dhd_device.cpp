#include "device/drivers/dhd/dhd_device.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/dhd/dhd_gravity.hpp"
#include "device/drivers/dhd/dhd_loop.hpp"
#include "device/drivers/dhd/dhd_models.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/exclusive_use.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

namespace touchtrial::device {
namespace dhd {
namespace {

/// A larger difference from the device's own mass is refused as a typing error: a difference of
/// 0.2 kg pushes with 2 N.
constexpr double kMaxMassChangeKg = 0.2;
/// During the vendor's automatic motion of the arm: 32 ms.
constexpr unsigned char kMaxWatchdog = 255;
/// For an unknown model, a weight above this share of the peak force is implausible.
constexpr double kMaxWeightShare = 0.5;

/// The library removes the weight from its forces within 250 ms of exchanges.
constexpr int kPollsToRemoveWeight = 300;

/// The library's name for a type without a name.
constexpr std::string_view kNoName = "unknown device";

constexpr const char* kCalibrate =
    "waits for its calibration: put the end-effector at its rest position (omega: the pole into "
    "the pit; delta: sweep each axis from end to end) until the status light stops blinking, or "
    "run touchtrial device initialise dhd, which moves the arm";

/// \return the flag of a device that this program has open; opening it twice would disconnect it
std::atomic<bool>& in_use_flag(int index) {
  static std::array<std::atomic<bool>, 64> flags{};
  return flags[static_cast<std::size_t>(std::clamp(index, 0, 63))];
}

std::string version_text(double version) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << version;
  return text.str();
}

/// An open device, without force until `configure`. The destructor switches force off, restores
/// settings, and closes the device. Belongs to the thread that opens it.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library or the device cannot be opened
  explicit Session(const DhdSettings& settings)
      : settings_(settings),
        library_(settings.library),
        exclusive_use_(in_use_flag(settings.index), "dhd: this program has device " +
                                                        std::to_string(settings.index) +
                                                        " open already; close it first"),
        device_(open_device_id(settings.index)) {
    if (api().get_system_type != nullptr) model_ = model_of(api().get_system_type(device_));
    device_mass_kg_ = reported_mass_kg();
  }
  ~Session() {
    (void)api().enable_force(0, device_);
    if (watchdog_) set_watchdog(*watchdog_);
    if (device_mass_kg_ && is_mass_changed_) {
      (void)api().set_effector_mass(*device_mass_kg_, device_);
    }
    (void)(api().has_drd() ? api().drd_close(device_) : api().close(device_));
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Api& api() const noexcept { return library_.api(); }
  [[nodiscard]] char device() const noexcept { return device_; }
  [[nodiscard]] const Library& library() const noexcept { return library_; }

  /// \throws DeviceError if this model requires a setting, or a setting exceeds the model's limits
  [[nodiscard]] DeviceInfo info() const {
    DeviceInfo info = identity();
    info.max_force_n =
        force_n(settings_.max_force_n, model_ ? model_->force_n : 0.0, "max_force_n");
    info.continuous_force_n =
        settings_.continuous_force_n.value_or(model_ ? model_->continuous_force_n : 0.0);
    if (model_) info.max_stiffness_n_per_mm = model_->stiffness_n_per_mm;
    const Vec3 size_mm = settings_.workspace_mm.value_or(model_ ? model_->workspace_mm : Vec3{});
    if (size_mm == Vec3{}) refuse_unknown(info.model, "workspace_mm");
    const Vec3 reach_mm = 0.5 * size_mm;
    info.workspace = Workspace{-1.0 * reach_mm, reach_mm, WorkspaceShape::ellipsoid};
    return info;
  }
  /// \return the largest possible weight of arms and end-effector, N; nothing if it is not
  ///   compensated
  [[nodiscard]] std::optional<double> max_weight_n(const DeviceInfo& info) const {
    if (!settings_.gravity_compensation || !has_switch()) return std::nullopt;
    return model_ ? model_->max_weight_n : kMaxWeightShare * info.max_force_n;
  }
  /// \throws DeviceError if the mass of the settings or of the device is implausible
  void check_mass(const DeviceInfo& info) const {
    check_change_of_mass();
    const std::optional<double> max_n = max_weight_n(info);
    const double mass_kg = settings_.effector_mass_kg > 0.0 ? settings_.effector_mass_kg
                                                            : device_mass_kg_.value_or(0.0);
    if (!max_n || (mass_kg >= 0.0 && kStandardGravityMS2 * mass_kg <= *max_n)) return;
    throw DeviceError("dhd: the library would compensate an end-effector of " +
                      number_text(mass_kg) + " kg, but arms and end-effector of this model (" +
                      info.model + ") weigh at most " + number_text(*max_n) +
                      " N; weigh the end-effector and set dhd.effector_mass_kg, or set "
                      "dhd.gravity_compensation to false");
  }
  /// \return only what the library reports, independent of settings
  [[nodiscard]] DeviceInfo identity() const {
    DeviceInfo info;
    info.name = "dhd";
    info.max_rate_hz = kPollRateHz;
    info.has_encoders = true;
    const char* name = api().get_system_name ? api().get_system_name(device_) : nullptr;
    // The library has no name for some types in our table.
    const bool is_named = name != nullptr && std::string_view(name) != kNoName;
    info.model = is_named ? one_line(name) : model_ ? model_->name : "Force Dimension device";
    unsigned short serial = 0;
    if (api().get_serial_number && api().get_serial_number(&serial, device_) >= 0) {
      info.serial = std::to_string(serial);
    }
    double version = 0.0;
    if (api().get_version && api().get_version(&version, device_) >= 0) {
      info.firmware = version_text(version);
    }
    if (api().get_sdk_version) {
      std::array<int, 4> parts{};
      api().get_sdk_version(&parts[0], &parts[1], &parts[2], &parts[3]);
      info.library = std::to_string(parts[0]) + "." + std::to_string(parts[1]) + "." +
                     std::to_string(parts[2]) + "." + std::to_string(parts[3]);
    }
    return info;
  }

  [[nodiscard]] bool is_calibrated() const {
    Status status{};
    expect(api().get_status(status.data(), device_), "the status");
    return dhd::is_calibrated(api(), status, device_);
  }

  /// Sets mass, limits and watchdogs, with force off.
  /// \param limit_n  of the rendered force, > 0
  /// \param max_weight_n  from max_weight_n()
  /// \throws DeviceError naming the call that failed
  void configure(double limit_n, std::optional<double> max_weight_n) {
    expect(api().enable_force(0, device_), "switching force off");
    set_mass();
    expect(api().set_gravity_compensation(max_weight_n ? 1 : 0, device_),
           "dhd.gravity_compensation");
    set_time_guard();
    // An additional limit, missing in old firmware. Version 3.17.5 limits the requested force, then
    // adds the weight; other versions may limit the sum.
    if (api().set_max_force != nullptr) {
      (void)api().set_max_force(limit_n + max_weight_n.value_or(0.0), device_);
    }
    start_watchdog(kWatchdog);
    if (!has_switch()) wait_until_weight_is_removed();
    expect(api().set_force(0.0, 0.0, 0.0, device_), "zero force");
  }

  /// Makes the device switch force off after this many times 125 us without a command. Firmware
  /// before version 3 has no watchdog, so it depends on the zeros that the driver sends.
  void start_watchdog(unsigned char value) {
    if (api().set_watchdog == nullptr) return;
    unsigned char previous_watchdog = 0;
    if (api().get_watchdog != nullptr) {
      (void)as_expert(api(), [&] { return api().get_watchdog(&previous_watchdog, device_); });
    }
    if (set_watchdog(value) >= 0) watchdog_ = previous_watchdog;
  }

  /// \throws DeviceError if the library reports an implausible weight of a calibrated device
  void check_weight(double max_n) const {
    if (!is_calibrated()) return;
    const std::optional<Vec3> weight_n = compensated_weight_n(api(), device_);
    if (!weight_n || is_plausible_weight(*weight_n, max_n)) return;
    throw DeviceError("dhd: the library would add (" + number_text(weight_n->x) + ", " +
                      number_text(weight_n->y) + ", " + number_text(weight_n->z) +
                      ") N to every force for the weight of arms and end-effector, but at most " +
                      number_text(max_n) +
                      " N upwards are plausible; calibrate the device again, or set "
                      "dhd.gravity_compensation to false");
  }

 private:
  /// \return whether force can be switched off
  [[nodiscard]] bool has_switch() const noexcept { return !model_ || model_->has_switch; }

  /// Exchanges positions until the library no longer adds a weight to forces.
  void wait_until_weight_is_removed() const {
    for (int poll = 0; poll < kPollsToRemoveWeight; ++poll) {
      Vec3 position_m;
      (void)api().get_position(&position_m.x, &position_m.y, &position_m.z, device_);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  [[nodiscard]] char open_device_id(int index) const {
    const int count = library_.device_count();
    if (index < 0 || index >= count) {
      throw DeviceError(
          "dhd: there is no device " + std::to_string(index) + " (" + std::to_string(count) +
          " connected, numbered from 0); switch it on, plug it in, give the user access "
          "to its USB node (scripts/install-udev-rules), and close other programs that use it");
    }
    const auto id = static_cast<char>(index);
    const int device = api().has_drd() ? api().drd_open_id(id) : api().open_id(id);
    if (device >= 0) return static_cast<char>(device);
    throw DeviceError(one_line(
        "dhd: device " + std::to_string(index) + " does not open: " + library_.last_error() +
        "; close other programs that use it, and give the user access to its "
        "USB node (scripts/install-udev-rules)"));
  }

  [[nodiscard]] double force_n(const std::optional<double>& setting_n, double max_n,
                               const std::string& key) const {
    if (!setting_n && max_n == 0.0) refuse_unknown(identity().model, key);
    if (setting_n && max_n > 0.0 && *setting_n > max_n) {
      throw DeviceError("dhd: dhd." + key + " is " + number_text(*setting_n) +
                        " N, more than the " + number_text(max_n) +
                        " N of a device of this model (" + model_->name +
                        "); set it to the value in the data sheet, or leave it out");
    }
    return setting_n.value_or(max_n);
  }
  [[noreturn]] static void refuse_unknown(const std::string& model, const std::string& key) {
    throw DeviceError(one_line("dhd: workspace and force of this device (" + model +
                               ") are unknown; look them up in its data sheet and set dhd." + key +
                               " (dhd.max_force_n, dhd.continuous_force_n, dhd.workspace_mm)"));
  }

  void check_change_of_mass() const {
    const double mass_kg = settings_.effector_mass_kg;
    const double change_kg = std::abs(mass_kg - device_mass_kg_.value_or(0.0));
    if (mass_kg == 0.0 || change_kg <= kMaxMassChangeKg) return;
    const double push_n = std::round(10.0 * kStandardGravityMS2 * change_kg) / 10.0;
    throw DeviceError(
        "dhd: dhd.effector_mass_kg is " + number_text(mass_kg) + ", but the device " +
        (device_mass_kg_ ? "reports " + number_text(*device_mass_kg_) : "reports none") +
        ", and the difference would push with " + number_text(push_n) +
        " N; weigh the end-effector again: a change of more than " + number_text(kMaxMassChangeKg) +
        " kg is refused");
  }

  [[nodiscard]] std::optional<double> reported_mass_kg() const {
    double mass_kg = 0.0;
    const bool has_mass = api().get_effector_mass != nullptr &&
                          api().get_effector_mass(&mass_kg, device_) >= 0 && std::isfinite(mass_kg);
    return has_mass ? std::optional(mass_kg) : std::nullopt;
  }

  void set_mass() {
    if (settings_.effector_mass_kg == 0.0 || api().set_effector_mass == nullptr) return;
    expect(api().set_effector_mass(settings_.effector_mass_kg, device_), "dhd.effector_mass_kg");
    is_mass_changed_ = true;
  }

  void set_time_guard() const {
    expect(as_expert(api(), [&] { return api().set_time_guard(kRecommendedTimeGuard, device_); }),
           "the time guard");
  }

  int set_watchdog(unsigned char value) const noexcept {
    return as_expert(api(), [&]() noexcept { return api().set_watchdog(value, device_); });
  }

  void expect(int result, const std::string& call) const {
    if (result >= 0) return;
    throw DeviceError(one_line("dhd: " + call + " was refused: " + library_.last_error() +
                               "; run the vendor's diagnostic"));
  }

  DhdSettings settings_;
  Library library_;
  ExclusiveUse exclusive_use_;
  char device_;
  std::optional<Model> model_;
  std::optional<double> device_mass_kg_;
  bool is_mass_changed_ = false;
  std::optional<unsigned char> watchdog_;  ///< the previous value; nothing: no watchdog
};

DeviceListing empty_listing(const DhdSettings& settings) {
  DeviceListing listing;
  listing.driver = "dhd";
  listing.where = settings.library.string();
  return listing;
}

DeviceListing listing_of(DhdSettings settings, int index) {
  settings.index = index;
  DeviceListing listing = empty_listing(settings);
  listing.where += ", device " + std::to_string(index);
  listing.present = true;
  try {
    const Session session(settings);
    const DeviceInfo identity = session.identity();
    listing.model = identity.model;
    listing.serial = identity.serial;
    listing.where = session.library().file().string() + ", device " + std::to_string(index);
    if (!session.is_calibrated()) listing.missing.emplace_back(kCalibrate);
    session.check_mass(session.info());
  } catch (const DeviceError& error) {
    listing.missing.emplace_back(error.what());
  }
  return listing;
}

std::vector<DeviceListing> list_dhd(const DeviceSettings& settings) {
  DeviceListing listing = empty_listing(settings.dhd);
  try {
    const Library library(settings.dhd.library);
    listing.where = library.file().string();
    const int count = library.device_count();
    std::vector<DeviceListing> listings;
    for (int i = 0; i < count; ++i) listings.push_back(listing_of(settings.dhd, i));
    if (count > 0) return listings;
    listing.missing = {
        "no device is connected; switch it on, plug it in, and give the user access to its USB "
        "node (scripts/install-udev-rules)"};
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_dhd(const DeviceSettings& settings) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  return std::make_unique<DhdDevice>(settings.dhd,
                                     settings.use_of("dhd").limits.max_force_n.value_or(kNoLimit));
}

/// If this process is killed, the device's watchdog stops the motion.
std::string initialise_dhd(const DeviceSettings& settings) {
  Session session(settings.dhd);
  const Api& api = session.api();
  if (!api.has_drd() || api.drd_auto_init == nullptr) {
    throw DeviceError(one_line(
        "dhd: " + session.library().file().string() +
        " cannot initialise a device; name the SDK's libdrd.so at dhd.library, or do it by hand: "
        "the device " +
        kCalibrate));
  }
  if (session.is_calibrated()) return "is initialised already; it was not moved";
  session.start_watchdog(kMaxWatchdog);
  if (api.drd_auto_init(session.device()) < 0) {
    throw DeviceError(
        one_line("dhd: the device was not initialised: " + session.library().last_error() +
                 "; keep clear of it and try again, or do it by hand: it " + kCalibrate));
  }
  return "is initialised";
}

}  // namespace
}  // namespace dhd

/// Declared after the session it uses, so that the loop ends first.
struct DhdDevice::Runtime {
  Runtime(const DhdSettings& settings, double limit_n, std::chrono::nanoseconds (*now)())
      : session(settings), info(session.info()) {
    session.check_mass(info);
    const std::optional<double> max_weight_n = session.max_weight_n(info);
    session.configure(std::min(limit_n, info.max_force_n), max_weight_n);
    if (max_weight_n) session.check_weight(*max_weight_n);
    loop = std::make_unique<dhd::Loop>(session.api(), session.device(), max_weight_n, now);
  }

  dhd::Session session;
  DeviceInfo info;
  std::unique_ptr<dhd::Loop> loop;
};

DhdDevice::DhdDevice(const DhdSettings& settings, double limit_n, std::chrono::nanoseconds (*now)())
    : runtime_(std::make_unique<Runtime>(settings, limit_n, now)) {}

DhdDevice::~DhdDevice() = default;

DeviceInfo DhdDevice::info() const {
  return runtime_->info;
}

DeviceLink& DhdDevice::link() const noexcept {
  return runtime_->loop->link();
}

DeviceReadiness DhdDevice::readiness() const noexcept {
  return runtime_->loop->readiness();
}

/// Sources of unverified facts: this driver's page in docs/devices.
DeviceDriver dhd_driver() {
  return {
      .name = "dhd",
      .what = "Force Dimension omega, delta, sigma and lambda, through the vendor's library",
      .list = dhd::list_dhd,
      .open = dhd::open_dhd,
      .workspace_is_known = false,
      .initialise = dhd::initialise_dhd,
      .products = {{"omega", "Force Dimension omega", "omega_3"},
                   {"delta", "Force Dimension delta"},
                   {"sigma", "Force Dimension sigma"},
                   {"lambda", "Force Dimension lambda"}},
      .unverified = {
          {"signs", "the signs of positions and forces on each axis"},
          {"force_scale", "whether the library's newton is a newton at the handle"},
          {"lengths", "whether the library's millimetre is a millimetre at the handle"},
          {"time_guard",
           "whether readings returned with the time guard's result are new, at the loop's rate"},
          {"force_button",
           "whether the library's command alone switches force on",
           "Did you have to press the force button on the device?",
           {"yes", "no"}},
          {"weight_carried",
           "whether the library compensates the arm's true weight",
           "You let go of the handle in free air, while force was on. What did it do?",
           {"stayed", "sank", "rose", "sideways"}},
          {"jolt",
           "whether a jolt is felt when force switches on",
           "Did the handle jolt when force came on?",
           {"no", "slightly", "strongly"}},
          {"watchdog", "whether the watchdog switches force off when the program stops"},
          {"brakes",
           "whether the brakes keep the arm from falling hard when force switches off",
           "Force went off (program stopped, cable pulled, or the end). What did the arm do?",
           {"stayed", "sank_slowly", "fell"}},
          {"initialisation",
           "whether initialisation works with the watchdog set to 32 ms",
           "Did you run touchtrial device initialise?",
           {"worked", "failed", "not_run"}},
          {"slanted_base", "the compensated weight on a base that is not level"},
          {"force_left",
           "whether the motors can exert the stated force in addition to the weight"}}};
}

}  // namespace touchtrial::device
