/// \file A lab's device settings: library paths, calibration, limits. One JSON file for all drivers.
#pragma once

#include "core/vec.hpp"
#include "device/instruments/lab_streaming.hpp"
#include "device/instruments/marker_line.hpp"
#include "device/safety/safety_chain.hpp"
#include "device/servo/placed_device.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::device {

struct FalconSettings {
  static constexpr double kMaxGravityBiasN = 1.0;
  std::filesystem::path firmware{};  ///< the vendor's image; required unless already loaded
  std::string serial{};              ///< of the device to use; empty: the only one
  /// The support force (HapticDevice::support_force_n), device frame; norm <= kMaxGravityBiasN.
  Vec3 gravity_bias_n{};
  std::array<int, 3> led_order = {2, 0, 1};  ///< bits of red, green and blue
  /// \name Limits of each motor, in motor values (6,616 for 1 N m)
  /// @{ Guesses, until a lab measures its device (docs/devices/falcon.md).
  int motor_peak = 4095;
  int motor_continuous = 1365;  ///< sustainable without time limit
  double motor_peak_s = 20.0;   ///< how long a cold motor may have the peak value, s
  ///@}
};

struct OpenHapticsSettings {
  std::filesystem::path library = "libHD.so";
  std::string device{};          ///< its name in the vendor's configuration; empty: the default
  unsigned long rate_hz = 1000;  ///< of the vendor's scheduler
};

struct DhdSettings {
  /// A file, a folder, or a name; the default means any version of libdrd.so and libdhd.so.
  std::filesystem::path library = "libdhd.so";
  int index = 0;                     ///< among the connected devices, >= 0
  bool gravity_compensation = true;  ///< by the library, whenever force is on
  double effector_mass_kg = 0.0;     ///< 0: the device's own value
  /// \name Facts that the library does not report; nothing: from the device's model
  ///@{
  std::optional<double> max_force_n{};         ///< > 0
  std::optional<double> continuous_force_n{};  ///< 0: unknown
  /// Width, height and depth of the ellipsoid that the device reaches; each > 0.
  std::optional<Vec3> workspace_mm{};
  ///@}
};

struct PluginSettings {
  std::filesystem::path library;  ///< required
  std::string settings = "{}";    ///< a JSON object that only the plug-in interprets
};

struct Inverse3Settings {
  std::string host = "localhost";  ///< where Haply's Inverse service runs
  int port = 10001;                ///< of its simulation channel, usually also HTTP; 1 to 65535
  int events_port = 10020;         ///< of its events channel, 1 to 65535
  int http_port = 10000;           ///< of HTTP if `port` does not serve it, 1 to 65535
  std::string device_id{};         ///< of the device to use; empty: the only one
  double max_force_n = 5.0;        ///< along each axis; unpublished; > 0
};

struct ReplaySettings {
  std::filesystem::path trace;  ///< CSV: time_s, x_mm, y_mm, z_mm; plane frame
};

/// Limits that a lab sets for one of its devices. They can only make the limits of the study and
/// the device stricter. Nothing: the lab sets no limit.
struct LabLimits {
  std::optional<double> max_force_n{};         ///< SafetyLimits::max_force_n, > 0
  std::optional<double> continuous_force_n{};  ///< SafetyLimits::continuous_force_n, > 0
  std::optional<double> max_slew_n_per_s{};    ///< SafetyLimits::max_slew_n_per_s, > 0
  std::optional<double> max_speed_mm_s{};      ///< SafetyLimits::max_speed_mm_s, > 0
};

/// A lab's settings for one of its devices, with any driver.
struct DeviceUse {
  LabLimits limits;
  /// The orientation of planes; nothing: horizontal.
  std::optional<PlaneOrientation> orientation;
  /// The middle of a plane, device frame; nothing: the middle of the workspace.
  std::optional<Vec3> centre_mm;
  DeviceScale scale;  ///< of this individual device, as measured by the lab
};

/// Instruments that record during a session and receive its events.
struct InstrumentSettings {
  MarkerLineSettings serial;
  LabStreamingSettings lsl;

  [[nodiscard]] bool any() const { return !serial.port.empty() || !lsl.library.empty(); }
};

struct DeviceSettings {
  FalconSettings falcon;
  OpenHapticsSettings openhaptics;
  DhdSettings dhd;
  PluginSettings plugin;
  Inverse3Settings inverse3;
  ReplaySettings replay;
  InstrumentSettings instruments;
  std::string
      simulated_device;  ///< model that a simulated hand holds; empty: ideal; not in the file
  std::map<std::string, DeviceUse> uses;  ///< by driver, for drivers in the file

  /// \return the entry of `uses`; the defaults if there is none
  [[nodiscard]] DeviceUse use_of(const std::string& driver) const;
};

/// \return the stricter of each limit; the slew limit stays high enough for kMaxReleaseS
[[nodiscard]] SafetyLimits stricter_of(SafetyLimits limits, const LabLimits& lab) noexcept;

/// Reads a settings file of the schema config/schema/devices.schema.json. Paths in it are relative
/// to its folder.
/// \throws StudyError with the JSON pointer if it breaks the schema, FileError if it cannot be read
[[nodiscard]] DeviceSettings read_device_settings(const std::filesystem::path& file);

/// The same from text.
/// \param folder  relative paths start here
/// \param source  names the origin in errors
/// \throws StudyError with the JSON pointer if the text breaks the schema
[[nodiscard]] DeviceSettings parse_device_settings(std::string_view text,
                                                   const std::filesystem::path& folder,
                                                   const std::string& source);

/// \return the default settings file: touchtrial/devices.json in the user's configuration folder
///   (XDG_CONFIG_HOME, else ~/.config); empty without a home folder
[[nodiscard]] std::filesystem::path default_device_settings_path();

/// Reads a command's settings: the file that the user named, else the file at the default path,
/// else the defaults.
/// \param path  as named by the user; empty: none was named
/// \throws as read_device_settings
[[nodiscard]] DeviceSettings load_device_settings(const std::filesystem::path& path);

}  // namespace touchtrial::device
