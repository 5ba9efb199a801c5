#include "device/dhd/dhd_session.hpp"

#include "core/errors.hpp"
#include "device/dhd/dhd_loop.hpp"

#include <algorithm>
#include <locale>
#include <sstream>

namespace touchtrial::device::dhd {
namespace {

char open_device_of(const Library& library, int index) {
  const int count = library.device_count();
  if (index < 0 || index >= count) {
    throw DeviceError(
        "dhd: there is no device " + std::to_string(index) + ", of " + std::to_string(count) +
        " connected; switch it on, plug it in, let the user have its USB node (udev), "
        "and close other programs that use it");
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

}  // namespace

Library::Library(const std::filesystem::path& file)
    : library_(file, Unload::never, kRemedy), api_(load_api(library_)) {}

int Library::device_count() const noexcept {
  return std::max(0, api_.get_device_count());
}

std::string Library::last_error() const {
  const char* words = api_.error_get_last_str();
  return words == nullptr ? "no reason given" : words;
}

Session::Session(const DhdSettings& settings)
    : settings_(settings),
      library_(settings.library),
      device_(open_device_of(library_, settings.index)) {}

Session::~Session() {
  (void)api().enable_force(0, device_);
  (void)api().close(device_);
}

DeviceInfo Session::info() const {
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

void Session::configure() {
  if (settings_.effector_mass_kg > 0.0) {
    expect(api().set_effector_mass(settings_.effector_mass_kg, device_), "dhd.effector_mass_kg");
  }
  expect(api().set_gravity_compensation(settings_.gravity_compensation ? 1 : 0, device_),
         "dhd.gravity_compensation");
  set_time_guard();
  expect(api().set_force(0.0, 0.0, 0.0, device_), "zero force");
  expect(api().enable_force(1, device_), "switching force on");
}

/// Versions that know an expert mode refuse the time guard outside of it. Left again at once: its
/// other functions are the ones that switch safety off.
void Session::set_time_guard() const {
  if (api().enable_expert_mode) (void)api().enable_expert_mode();
  const int result = api().set_time_guard(kRecommendedTimeGuard, device_);
  if (api().disable_expert_mode) (void)api().disable_expert_mode();
  expect(result, "the time guard");
}

void Session::expect(int result, const std::string& what) const {
  if (result >= 0) return;
  throw DeviceError(one_line("dhd: " + what + " was refused: " + library_.last_error() +
                             "; run the vendor's diagnostic"));
}

}  // namespace touchtrial::device::dhd
