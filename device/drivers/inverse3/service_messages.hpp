/// \file Messages from and to Haply's Inverse service: JSON, without sockets, threads or clocks.
/// Source: the service's public documentation, versions 3.1 and 3.5 (docs/devices/inverse3.md).
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device::inverse3 {

/// The requested frame: its origin is the middle of the workspace.
inline constexpr const char* kCentredPreset = "arm_front_centered";

/// A message that does not match the documentation; `what()` describes the difference.
class BadMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ServiceVersion {
  int major = 0;
  int minor = 0;

  /// Whether presets, filters and sessions can be set and read: from 3.5 on.
  [[nodiscard]] bool has_filters() const noexcept { return major == 3 && minor >= 5; }
  [[nodiscard]] bool is_supported() const noexcept { return major == 3 && minor >= 1; }
  [[nodiscard]] std::string text() const {
    return std::to_string(major) + '.' + std::to_string(minor);
  }
};

/// The state of an arm.
struct ArmStatus {
  bool calibrated = false;
  bool in_use = false;
  bool power_supply = false;
  bool ready = false;
  bool started = false;

  [[nodiscard]] bool is_usable() const noexcept {
    return calibrated && power_supply && ready && started;
  }
};

/// The service's processing of a device's forces and positions.
struct DeviceConfig {
  std::string type = "inverse3";     ///< or inverse3x, minverse
  std::string firmware;              ///< "7.4"; may be empty
  std::string preset;                ///< empty before 3.5
  std::optional<double> force_gate;  ///< gain; 0 is off
  std::optional<double> damping;     ///< the largest of its numbers; 0 is off
  std::optional<bool> torque_scaling;
  std::optional<double> gravity_compensation;  ///< factor; 0 is off
  std::string handedness;                      ///< of the arm, "right" or "left"; may be empty
  std::optional<bool> home_return;             ///< whether the arm moves home by itself
  /// Positions are in metres along the device's axes, without rotation or scaling.
  bool plain_frame = true;
};

/// One device in a message of the service, in its frame: x to the right, y away from the person,
/// z up; m, m/s, N. All numbers are finite.
struct DeviceReport {
  std::string id;
  Vec3 position_m;
  Vec3 velocity_m_s;
  std::optional<Vec3> delivered_n;     ///< from 3.5 on
  std::optional<ArmStatus> status;     ///< nothing: unchanged
  std::optional<DeviceConfig> config;  ///< only in an inventory
};

struct ServiceReport {
  std::optional<std::int64_t> session_id;
  std::vector<DeviceReport> devices;
  std::uint32_t buttons = 0;  ///< of the first grip that reports any: bits 0, 1, 2 are a, b, c
};

/// An event of the events channel.
struct ServiceEvent {
  std::string name;
  std::string category;
  std::string safety_type;  ///< of device-safety-triggered
  std::string device_id;    ///< may be empty
  std::optional<std::int64_t> session_id;
};

/// \name Messages from the service
///@{
/// \throws BadMessage
[[nodiscard]] ServiceVersion parse_version(std::string_view text);
/// Parses an inventory or a state, which have the same format.
/// \throws BadMessage
[[nodiscard]] ServiceReport parse_report(std::string_view text);
/// Parses the answer about the device's home return.
/// \throws BadMessage
[[nodiscard]] bool parse_home_return(std::string_view text);
/// \return the profile name of each session of the service; empty if not reported
/// \throws BadMessage
[[nodiscard]] std::vector<std::string> parse_sessions(std::string_view text);
/// \throws BadMessage
[[nodiscard]] ServiceEvent parse_event(std::string_view text);
///@}

/// \name Messages to the service
/// @{ The first message: the program's profile, the frame, filters off, no force.
[[nodiscard]] std::string first_message(const ServiceVersion& version, const std::string& device);
/// Requests the device's configuration; no force.
[[nodiscard]] std::string inventory_request(const ServiceVersion& version,
                                            const std::string& device);
/// \param force_n  on the hand, in the service's frame; applies to this message only
[[nodiscard]] std::string force_message(const ServiceVersion& version, const std::string& device,
                                        Vec3 force_n);
///@}

}  // namespace touchtrial::device::inverse3
