/// \file What a lab sets of its devices: paths, colours, masses. One JSON file for all drivers.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <filesystem>
#include <string>

namespace touchtrial {

struct FalconSettings {
  std::filesystem::path firmware;  ///< the vendor's image; needed unless it is already loaded
  std::string serial;              ///< of the one to use; empty: the only one
  Vec3 gravity_bias_n;             ///< added to every force, device frame; norm <= 1
  std::array<int, 3> led_order = {0, 1, 2};  ///< bits of red, green, blue: sources disagree
};

struct OpenHapticsSettings {
  std::filesystem::path library = "libHD.so";
  std::string device;            ///< the vendor's configuration name; empty: its default
  unsigned long rate_hz = 1000;  ///< of the vendor's scheduler
};

struct DhdSettings {
  std::filesystem::path library = "libdhd.so";
  int index = 0;  ///< among the connected devices, >= 0
  bool gravity_compensation = true;
  double effector_mass_kg = 0.0;    ///< 0: as the device knows it
  double max_force_n = 8.0;         ///< the library does not tell; > 0
  double continuous_force_n = 0.0;  ///< 0: no limit known
};

struct ReplaySettings {
  std::filesystem::path trace;  ///< CSV: time_s, x_mm, y_mm, z_mm; plane frame
};

struct DeviceSettings {
  FalconSettings falcon;
  OpenHapticsSettings openhaptics;
  DhdSettings dhd;
  ReplaySettings replay;
};

/// Reads a settings file, by the schema config/schema/devices.schema.json; paths are relative to
/// it. \throws StudyError with the JSON pointer if it breaks the schema, FileError if it cannot be
/// read
[[nodiscard]] DeviceSettings read_device_settings(const std::filesystem::path& file);

/// Where the settings are unless the user names another file: the user's configuration folder
/// (XDG_CONFIG_HOME, else ~/.config), touchtrial/devices.json.
[[nodiscard]] std::filesystem::path default_device_settings_path();

}  // namespace touchtrial
