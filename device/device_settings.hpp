/// \file A lab's settings of its devices: paths, colours, masses. One JSON file for all drivers.
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
  std::filesystem::path firmware{};  ///< the vendor's image; needed unless it is already loaded
  std::string serial{};              ///< of the device to use; empty: the only one
  /// The device's support force, device frame; norm <= kMaxGravityBiasN.
  Vec3 gravity_bias_n{};
  std::array<int, 3> led_order = {2, 0, 1};  ///< bits of red, green and blue
  /// Limits of each motor, in motor values (6,616 for 1 N m): the greatest, that which it holds
  /// for ever, and how long a cold motor may have the greatest, s. Guesses, until a lab measures
  /// its device (docs/devices/falcon.md).
  int motor_peak = 4095;
  int motor_continuous = 1365;
  double motor_peak_s = 20.0;
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
  bool gravity_compensation = true;  ///< the library's own, which acts whenever force is on
  double effector_mass_kg = 0.0;     ///< 0: the device's own value
  /// \name Facts that the library does not report; nothing: from the device's model
  ///@{
  std::optional<double> max_force_n{};         ///< > 0
  std::optional<double> continuous_force_n{};  ///< 0: no limit is known
  /// Width, height and depth of the ellipsoid that the device reaches; each > 0.
  std::optional<Vec3> workspace_mm{};
  ///@}
};

struct PluginSettings {
  std::filesystem::path library;  ///< needed
  std::string settings = "{}";    ///< a JSON object that only the plug-in understands
};

struct Inverse3Settings {
  std::string host = "localhost";  ///< where Haply's Inverse service runs
  int port = 10001;                ///< of its simulation channel, 1 to 65535; mostly of HTTP too
  int events_port = 10020;         ///< of its events channel, 1 to 65535
  int http_port = 10000;           ///< of HTTP where `port` has none, 1 to 65535
  std::string device_id{};         ///< of the device to use; empty: the only one
  double max_force_n = 5.0;        ///< along each axis; unpublished; > 0
};

struct ReplaySettings {
  std::filesystem::path trace;  ///< CSV: time_s, x_mm, y_mm, z_mm; plane frame
};

/// Limits that a lab sets for one of its devices, in addition to those of the study and of the
/// device: they only make a limit stricter. Nothing: the lab sets none.
struct LabLimits {
  std::optional<double> max_force_n{};         ///< SafetyLimits::max_force_n, > 0
  std::optional<double> continuous_force_n{};  ///< SafetyLimits::continuous_force_n, > 0
  std::optional<double> max_slew_n_per_s{};    ///< SafetyLimits::max_slew_n_per_s, > 0
  std::optional<double> max_speed_mm_s{};      ///< SafetyLimits::max_speed_mm_s, > 0
};

/// How a lab uses one of its devices, for any driver.
struct DeviceUse {
  LabLimits limits;
  /// How planes stand on it; nothing: horizontal.
  std::optional<PlaneOrientation> orientation;
  /// The middle of a plane, device frame; nothing: the middle of the workspace.
  std::optional<Vec3> centre_mm;
  DeviceScale scale;  ///< of this very device, as the lab measured it
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
  std::string simulated_on;  ///< model that a simulated hand holds; not in the file; empty: ideal
  std::map<std::string, DeviceUse> uses;  ///< by driver; those that the file mentions

  /// \return the defaults for a driver that the file does not mention
  [[nodiscard]] DeviceUse use_of(const std::string& driver) const;
};

/// \return the stricter of each limit; the slew limit stays high enough to let go in kMaxReleaseS
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

/// \return the settings file of a user who specifies none: touchtrial/devices.json in the user's
///   configuration folder (XDG_CONFIG_HOME, else ~/.config); empty if there is no home folder
[[nodiscard]] std::filesystem::path default_device_settings_path();

/// Reads the settings that a command uses: the file that the user named, else the one at the
/// default path, else the defaults.
/// \param named  empty if the user named none
/// \throws as read_device_settings
[[nodiscard]] DeviceSettings device_settings_for(const std::filesystem::path& named);

}  // namespace touchtrial::device
