#include "device/drivers/dhd/dhd_library.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace touchtrial::device::dhd {

const char* const kRemedy =
    "install Force Dimension's SDK, and name its folder or the library in it in the device "
    "settings at dhd.library";

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDefaultName = "libdhd.so";
/// libdrd has the functions of libdhd, and functions for initialisation.
constexpr std::array<std::string_view, 2> kStems = {"libdrd.so", "libdhd.so"};

/// \return the numbers after the stem: {3, 17, 6} for libdhd.so.3.17.6
std::vector<int> version_of(std::string_view name, std::string_view stem) {
  std::vector<int> numbers;
  std::string_view rest = name.substr(stem.size());
  while (!rest.empty()) {
    rest.remove_prefix(1);
    numbers.push_back(std::atoi(std::string(rest.substr(0, rest.find('.'))).c_str()));
    rest.remove_prefix(std::min(rest.find('.'), rest.size()));
  }
  return numbers;
}

bool is_version_of(std::string_view name, std::string_view stem) {
  if (!name.starts_with(stem)) return false;
  const std::string_view rest = name.substr(stem.size());
  return rest.empty() || (rest.front() == '.' && rest.size() > 1 &&
                          rest.find_first_not_of(".0123456789") == std::string_view::npos);
}

/// \return the names in a folder; empty if it cannot be read
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  std::ranges::sort(entries);
  return entries;
}

void add_from(const fs::path& folder, std::string_view stem, std::vector<fs::path>& found) {
  std::vector<fs::path> versions;
  for (const fs::path& entry : entries_of(folder)) {
    if (is_version_of(entry.filename().string(), stem)) versions.push_back(entry);
  }
  std::ranges::sort(versions, [&](const fs::path& a, const fs::path& b) {
    return version_of(a.filename().string(), stem) > version_of(b.filename().string(), stem);
  });
  found.insert(found.end(), versions.begin(), versions.end());
}

/// \return the possible library folders of a kit, including its top folder
std::vector<fs::path> folders_of_kit(const fs::path& kit) {
  std::vector<fs::path> folders = {kit};
  for (const fs::path& system : entries_of(kit / "lib" / "release")) folders.push_back(system);
  return folders;
}

std::vector<fs::path> libraries_in(const std::vector<fs::path>& folders) {
  std::vector<fs::path> found;
  for (const std::string_view stem : kStems) {
    for (const fs::path& folder : folders) add_from(folder, stem, found);
  }
  return found;
}

void add_folders_of(const char* variable, std::vector<fs::path>& folders) {
  const char* const value = std::getenv(variable);
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

std::vector<fs::path> library_folders() {
  std::vector<fs::path> folders;
  if (const char* const kit = std::getenv("FDSDK"); kit != nullptr && *kit != '\0') {
    folders = folders_of_kit(kit);
  }
  add_folders_of("LD_LIBRARY_PATH", folders);
  folders.emplace_back("/usr/local/lib");
  if (const char* const home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    folders.push_back(fs::path(home) / ".local" / "lib");
  }
  return folders;
}

bool is_there(const fs::path& candidate) {
  std::error_code error;
  return candidate.has_parent_path() && fs::exists(candidate, error);
}

/// Whether DynamicLibrary's error is the linker's message for a missing library.
bool is_not_found(const DeviceError& error) {
  return std::string_view(error.what()).find("(cannot open shared object file") !=
         std::string_view::npos;
}

/// \return the first candidate that loads in a child process
fs::path loadable(const fs::path& named) {
  for (const fs::path& candidate : library_candidates(named)) {
    check_loads(candidate, kRemedy);
    try {
      const DynamicLibrary trial(candidate, Unload::never, kRemedy);
      return candidate;
    } catch (const DeviceError& error) {
      if (is_there(candidate) || !is_not_found(error)) throw;
    }
  }
  throw DeviceError(one_line(named.string() + ": is not found, nor any version of libdrd.so or " +
                             "libdhd.so; " + kRemedy));
}

Api load_api(const DynamicLibrary& library) {
  Api api{};
  library.find("dhdGetDeviceCount", api.get_device_count);
  library.find("dhdOpenID", api.open_id);
  library.find("dhdClose", api.close);
  library.find("dhdGetPosition", api.get_position);
  library.find("dhdSetForce", api.set_force);
  library.find("dhdEnableForce", api.enable_force);
  library.find("dhdGetButtonMask", api.get_button_mask);
  library.find("dhdGetStatus", api.get_status);
  library.find("dhdSetTimeGuard", api.set_time_guard);
  library.find("dhdSetGravityCompensation", api.set_gravity_compensation);
  library.find("dhdErrorGetLastStr", api.error_get_last_str);
  library.find_if_any("dhdStop", api.stop);
  library.find_if_any("dhdEnableExpertMode", api.enable_expert_mode);
  library.find_if_any("dhdDisableExpertMode", api.disable_expert_mode);
  library.find_if_any("dhdGetSystemType", api.get_system_type);
  library.find_if_any("dhdGetSystemName", api.get_system_name);
  library.find_if_any("dhdGetSerialNumber", api.get_serial_number);
  library.find_if_any("dhdGetVersion", api.get_version);
  library.find_if_any("dhdGetSDKVersion", api.get_sdk_version);
  library.find_if_any("dhdSetEffectorMass", api.set_effector_mass);
  library.find_if_any("dhdGetEffectorMass", api.get_effector_mass);
  library.find_if_any("dhdSetMaxForce", api.set_max_force);
  library.find_if_any("dhdSetWatchdog", api.set_watchdog);
  library.find_if_any("dhdGetWatchdog", api.get_watchdog);
  library.find_if_any("dhdGetJointAngles", api.get_joint_angles);
  library.find_if_any("dhdJointAnglesToGravityJointTorques",
                      api.joint_angles_to_gravity_joint_torques);
  library.find_if_any("dhdGetDeltaJointAngles", api.get_delta_joint_angles);
  library.find_if_any("dhdDeltaGravityJointTorques", api.delta_gravity_joint_torques);
  library.find_if_any("dhdDeltaJointAnglesToJacobian", api.delta_joint_angles_to_jacobian);
  library.find_if_any("drdOpenID", api.drd_open_id);
  library.find_if_any("drdClose", api.drd_close);
  library.find_if_any("drdIsInitialized", api.drd_is_initialized);
  library.find_if_any("drdAutoInit", api.drd_auto_init);
  return api;
}

}  // namespace

std::vector<fs::path> library_candidates(const fs::path& named) {
  std::error_code error;
  if (fs::is_directory(named, error)) return libraries_in(folders_of_kit(named));
  if (named != kDefaultName) return {named};
  std::vector<fs::path> candidates;
  for (const std::string_view stem : kStems) {
    candidates.emplace_back(std::string(stem) + ".3");
    candidates.emplace_back(stem);
  }
  for (fs::path& library : libraries_in(library_folders()))
    candidates.push_back(std::move(library));
  return candidates;
}

Library::Library(const fs::path& named)
    : file_(loadable(named)), library_(file_, Unload::never, kRemedy), api_(load_api(library_)) {}

int Library::device_count() const noexcept {
  return std::max(0, api_.get_device_count());
}

std::string Library::last_error() const {
  const char* words = api_.error_get_last_str();
  return words == nullptr ? "no reason given" : words;
}

}  // namespace touchtrial::device::dhd
