#include "device/dhd/dhd_device.hpp"

#include "core/errors.hpp"
#include "device/dhd/dhd_loop.hpp"
#include "device/drivers.hpp"

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>

namespace touchtrial::device {
namespace dhd {
namespace {

/// The remedy for a library that cannot be used.
constexpr const char* kRemedy =
    "install Force Dimension's SDK, or name the library in the device settings at dhd.library";

/// The loaded library, without a device.
class Library {
 public:
  /// \throws DeviceError with the remedy if it cannot be used
  explicit Library(const std::filesystem::path& file)
      : library_(file, Unload::never, kRemedy), api_(load_api(library_)) {}

  [[nodiscard]] const Api& api() const noexcept { return api_; }
  /// \return the number of connected devices, >= 0
  [[nodiscard]] int device_count() const noexcept { return std::max(0, api_.get_device_count()); }
  /// \return the library's own words for its last failure
  [[nodiscard]] std::string last_error() const {
    const char* words = api_.error_get_last_str();
    return words == nullptr ? "no reason given" : words;
  }

 private:
  DynamicLibrary library_;
  Api api_;
};

char open_device_of(const Library& library, int index) {
  const int count = library.device_count();
  if (index < 0 || index >= count) {
    throw DeviceError(
        "dhd: there is no device " + std::to_string(index) + " (" + std::to_string(count) +
        " connected, numbered from 0); switch it on, plug it in, give the user access "
        "to its USB node (udev), and close other programs that use it");
  }
  const int device = library.api().open_id(static_cast<char>(index));
  if (device >= 0) return static_cast<char>(device);
  throw DeviceError(one_line("dhd: device " + std::to_string(index) + " does not open: " +
                             library.last_error() + "; close other programs that use it"));
}

std::string version_text(double version) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << version;
  return text.str();
}

/// An open device, without force until `configure`. The destructor switches force off and closes
/// the device. Belongs to the thread that opens it.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used or the device not opened
  explicit Session(const DhdSettings& settings)
      : settings_(settings),
        library_(settings.library),
        device_(open_device_of(library_, settings.index)) {}
  ~Session() {
    (void)api().enable_force(0, device_);
    (void)api().close(device_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Api& api() const noexcept { return library_.api(); }
  [[nodiscard]] char device() const noexcept { return device_; }

  [[nodiscard]] DeviceInfo info() const {
    DeviceInfo info;
    info.name = "dhd";
    info.max_force_n = settings_.max_force_n;
    info.continuous_force_n = settings_.continuous_force_n;
    info.max_rate_hz = kPollRateHz;
    const Vec3 reach_mm = 0.5 * settings_.workspace_mm;
    info.workspace = Workspace{-1.0 * reach_mm, reach_mm, WorkspaceShape::ellipsoid};
    const char* name = api().get_system_name ? api().get_system_name(device_) : nullptr;
    info.model = name == nullptr ? "Force Dimension device" : one_line(name);
    unsigned short serial = 0;
    if (api().get_serial_number && api().get_serial_number(&serial, device_) >= 0) {
      info.serial = std::to_string(serial);
    }
    double version = 0.0;
    if (api().get_version && api().get_version(&version, device_) >= 0) {
      info.firmware = version_text(version);
    }
    return info;
  }

  /// Sets effector mass, gravity compensation and time guard, and switches force on.
  /// \throws DeviceError naming what failed
  void configure() {
    if (settings_.effector_mass_kg > 0.0) {
      expect(api().set_effector_mass(settings_.effector_mass_kg, device_), "dhd.effector_mass_kg");
    }
    expect(api().set_gravity_compensation(settings_.gravity_compensation ? 1 : 0, device_),
           "dhd.gravity_compensation");
    set_time_guard();
    expect(api().set_force(0.0, 0.0, 0.0, device_), "zero force");
    expect(api().enable_force(1, device_), "switching force on");
  }

 private:
  /// Versions with an expert mode refuse the time guard outside it. It is left at once, as its
  /// other functions switch safety off.
  void set_time_guard() const {
    if (api().enable_expert_mode) (void)api().enable_expert_mode();
    const int result = api().set_time_guard(kRecommendedTimeGuard, device_);
    if (api().disable_expert_mode) (void)api().disable_expert_mode();
    expect(result, "the time guard");
  }

  void expect(int result, const std::string& what) const {
    if (result >= 0) return;
    throw DeviceError(one_line("dhd: " + what + " was refused: " + library_.last_error() +
                               "; run the vendor's diagnostic"));
  }

  DhdSettings settings_;
  Library library_;
  char device_;
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
    const DeviceInfo info = Session(settings).info();
    listing.model = info.model;
    listing.serial = info.serial;
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return listing;
}

std::vector<DeviceListing> list_dhd(const DeviceSettings& settings) {
  DeviceListing nothing = empty_listing(settings.dhd);
  try {
    expect_loading_survived(settings.dhd.library, kRemedy);
    const int count = Library(settings.dhd.library).device_count();
    std::vector<DeviceListing> found;
    for (int i = 0; i < count; ++i) found.push_back(listing_of(settings.dhd, i));
    if (count > 0) return found;
    nothing.missing = {"no device is connected; switch it on and plug it in"};
  } catch (const DeviceError& error) {
    nothing.missing = {error.what()};
  }
  return {nothing};
}

std::unique_ptr<HapticDevice> open_dhd(const DeviceSettings& settings) {
  expect_loading_survived(settings.dhd.library, kRemedy);
  return std::make_unique<DhdDevice>(settings.dhd);
}

}  // namespace
}  // namespace dhd

/// The loop ends before the session through which it talks.
struct DhdDevice::Running {
  explicit Running(const DhdSettings& settings) : session(settings), info(session.info()) {
    session.configure();
    loop = std::make_unique<dhd::Loop>(session.api(), session.device());
  }

  dhd::Session session;
  DeviceInfo info;
  std::unique_ptr<dhd::Loop> loop;
};

DhdDevice::DhdDevice(const DhdSettings& settings) : running_(std::make_unique<Running>(settings)) {}

DhdDevice::~DhdDevice() = default;

DeviceInfo DhdDevice::info() const {
  return running_->info;
}

DeviceLink& DhdDevice::link() const noexcept {
  return running_->loop->link();
}

DeviceReadiness DhdDevice::readiness() const noexcept {
  return running_->loop->readiness();
}

DeviceDriver dhd_driver() {
  return {.name = "dhd",
          .what = "Force Dimension omega, delta and sigma, through the vendor's library",
          .list = dhd::list_dhd,
          .open = dhd::open_dhd,
          .workspace_is_known = false};
}

}  // namespace touchtrial::device
