#include "device/drivers/dhd/dhd_library.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace touchtrial::device::dhd {

const char* const kRemedy =
    "install Force Dimension's SDK, and name its folder or its library in the device settings at "
    "dhd.library";

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDefaultName = "libdhd.so";
/// libdrd has the functions of libdhd, and functions for initialisation.
constexpr std::array<std::string_view, 2> kStems = {"libdrd.so", "libdhd.so"};

/// \return the numbers after the stem: {3, 17, 6} for libdhd.so.3.17.6
std::vector<int> version_of(std::string_view name, std::string_view stem) {
  std::vector<int> numbers;
  std::string_view suffix = name.substr(stem.size());
  while (!suffix.empty()) {
    suffix.remove_prefix(1);
    numbers.push_back(std::atoi(std::string(suffix.substr(0, suffix.find('.'))).c_str()));
    suffix.remove_prefix(std::min(suffix.find('.'), suffix.size()));
  }
  return numbers;
}

bool is_version_of(std::string_view name, std::string_view stem) {
  if (!name.starts_with(stem)) return false;
  const std::string_view suffix = name.substr(stem.size());
  return suffix.empty() || (suffix.front() == '.' && suffix.size() > 1 &&
                            suffix.find_first_not_of(".0123456789") == std::string_view::npos);
}

/// \return the sorted paths of a folder's entries; empty if it cannot be read
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

void add_versions(const fs::path& folder, std::string_view stem, std::vector<fs::path>& libraries) {
  std::vector<fs::path> versions;
  for (const fs::path& entry : entries_of(folder)) {
    if (is_version_of(entry.filename().string(), stem)) versions.push_back(entry);
  }
  std::ranges::sort(versions, [&](const fs::path& a, const fs::path& b) {
    return version_of(a.filename().string(), stem) > version_of(b.filename().string(), stem);
  });
  libraries.insert(libraries.end(), versions.begin(), versions.end());
}

/// \return the possible library folders of an SDK, including its top folder
std::vector<fs::path> sdk_folders(const fs::path& sdk) {
  std::vector<fs::path> folders = {sdk};
  for (const fs::path& system : entries_of(sdk / "lib" / "release")) folders.push_back(system);
  return folders;
}

std::vector<fs::path> libraries_in(const std::vector<fs::path>& folders) {
  std::vector<fs::path> libraries;
  for (const std::string_view stem : kStems) {
    for (const fs::path& folder : folders) add_versions(folder, stem, libraries);
  }
  return libraries;
}

void add_folders_of(const char* variable, std::vector<fs::path>& folders) {
  const char* const value = std::getenv(variable);
  std::string_view folder_list = value == nullptr ? "" : value;
  while (!folder_list.empty()) {
    const std::size_t end = std::min(folder_list.find(':'), folder_list.size());
    if (end > 0) folders.emplace_back(folder_list.substr(0, end));
    folder_list.remove_prefix(std::min(end + 1, folder_list.size()));
  }
}

std::vector<fs::path> library_folders() {
  std::vector<fs::path> folders;
  if (const char* const sdk = std::getenv("FDSDK"); sdk != nullptr && *sdk != '\0') {
    folders = sdk_folders(sdk);
  }
  add_folders_of("LD_LIBRARY_PATH", folders);
  folders.emplace_back("/usr/local/lib");
  if (const char* const home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    folders.push_back(fs::path(home) / ".local" / "lib");
  }
  return folders;
}

bool candidate_exists(const fs::path& candidate) {
  std::error_code error;
  return candidate.has_parent_path() && fs::exists(candidate, error);
}

/// \return whether DynamicLibrary's error contains the linker's message for a missing library
bool is_not_found(const DeviceError& error) {
  return std::string_view(error.what()).find("(cannot open shared object file") !=
         std::string_view::npos;
}

/// \return the first candidate that loads in a child process
fs::path find_loadable(const fs::path& library) {
  for (const fs::path& candidate : library_candidates(library)) {
    check_loads(candidate, kRemedy);
    try {
      const DynamicLibrary trial(candidate, Unload::never, kRemedy);
      return candidate;
    } catch (const DeviceError& error) {
      if (candidate_exists(candidate) || !is_not_found(error)) throw;
    }
  }
  throw DeviceError(one_line(library.string() + ": not found, and no version of libdrd.so or " +
                             "libdhd.so either; " + kRemedy));
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

std::vector<fs::path> library_candidates(const fs::path& library) {
  std::error_code error;
  if (fs::is_directory(library, error)) return libraries_in(sdk_folders(library));
  if (library != kDefaultName) return {library};
  std::vector<fs::path> candidates;
  for (const std::string_view stem : kStems) {
    candidates.emplace_back(std::string(stem) + ".3");
    candidates.emplace_back(stem);
  }
  for (fs::path& file : libraries_in(library_folders())) candidates.push_back(std::move(file));
  return candidates;
}

Library::Library(const fs::path& library)
    : file_(find_loadable(library)),
      library_(file_, Unload::never, kRemedy),
      api_(load_api(library_)) {}

int Library::device_count() const noexcept {
  return std::max(0, api_.get_device_count());
}

std::string Library::last_error() const {
  const char* text = api_.error_get_last_str();
  return text == nullptr ? "no reason given" : text;
}

}  // namespace touchtrial::device::dhd
