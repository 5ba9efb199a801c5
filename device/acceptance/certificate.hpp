/// \file The certificate of an acceptance: results, verdict, and the file, to which sessions refer
/// by its hash. Format: docs/data-dictionary.md.
#pragma once

#include "core/hash.hpp"
#include "device/acceptance/motion_figures.hpp"
#include "device/haptic_device.hpp"
#include "device/model/device_model.hpp"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

inline constexpr double kStandardGravityMS2 = 9.80665;

/// \name Limits beyond which a device fails. Sources: docs/devices/acceptance.md.
///@{
inline constexpr double kForceTolerance = 0.10;  ///< share of the force
inline constexpr double kMaxNoiseMm = 0.1;       ///< of a handle at rest
inline constexpr double kMaxDriftMm = 0.5;
inline constexpr double kMaxStepMm = 0.1;
inline constexpr double kMaxFrictionN = 0.7;  ///< equals a hand's push on the plane
inline constexpr double kMaxDelayMs = 5.0;
inline constexpr double kMaxDelayErrorMs = 2.0;  ///< with a larger error the delay is unclear
inline constexpr double kMaxWarmDrift = 0.10;    ///< share of the load, over twenty minutes
///@}

/// The position of a delay's interval relative to kMaxDelayMs. Only `below` passes.
enum class DelayVerdict {
  below,      ///< the interval is below the limit
  above,      ///< the interval is above the limit
  not_shown,  ///< the interval contains the limit
  unclear,    ///< the error exceeds kMaxDelayErrorMs, and the interval is not above the limit
};
[[nodiscard]] DelayVerdict verdict_on_delay(const Measured& delay_ms) noexcept;

/// An older certificate causes a warning.
inline constexpr std::chrono::hours kCertificateAge{24 * 180};
/// A certificate from further in the future is refused. The clocks of two machines may differ by
/// this much.
inline constexpr std::chrono::hours kCertificateLead{24};

/// A push along an axis until the handle moved.
struct PushResult {
  double force_n = 0.0;    ///< of the last step of 0.1 N
  bool moved = false;      ///< by 2 mm
  double along_mm = 0.0;   ///< motion in the force's direction; negative: against it
  double across_mm = 0.0;  ///< motion perpendicular to it, >= 0
};

/// A known force held by the device.
struct WeighResult {
  double expected_n = 0.0;  ///< of the weight or the spring scale, > 0
  double measured_n = 0.0;  ///< additional force commanded for the load, >= 0
  double error_n = 0.0;     ///< of measured_n
};

/// The results of one axis; parts that were not measured are absent.
struct AxisResult {
  DeviceAxis axis = DeviceAxis::y;
  std::optional<PushResult> plus{};   ///< force in the axis' direction
  std::optional<PushResult> minus{};  ///< force against it
  std::optional<WeighResult> weight{};
  std::optional<double> load_n{};  ///< force that supports the empty handle along the axis
  /// From slow strokes. This and the next two are in newtons at the handle once the scale is known.
  std::optional<Measured> friction_n{};
  std::optional<Measured> mass_kg{};
  std::optional<Measured> viscous_n_s_per_m{};
  std::optional<Measured> delay_ms{};
  /// Whether the person skipped the step. Otherwise an axis without a delay fails.
  bool delay_left_out = false;

  /// Delivered over commanded force, after correction by Certificate::scale.
  [[nodiscard]] std::optional<Measured> scale() const;
};

/// Trials with a wall of increasing stiffness.
struct WallResult {
  double stable_n_per_mm = 0.0;      ///< the stiffest that did not oscillate; 0: none
  double oscillates_n_per_mm = 0.0;  ///< the first that did; 0: none did
  std::string ended;                 ///< the reason why the trials ended
};

/// The force that a load needs, before and after twenty minutes.
struct WarmResult {
  double before_n = 0.0;
  double after_n = 0.0;
  std::optional<double> before_c{};  ///< temperature of the motors' housing, as entered
  std::optional<double> after_c{};
};

struct NotMeasured {
  std::string measurement;
  std::string reason;
};

struct Certificate {
  std::string driver;
  std::string model;
  std::string serial;
  std::string firmware;
  std::string program;              ///< version
  std::chrono::sys_seconds made{};  ///< UTC
  std::string emulated{};           ///< name of the device model of a rehearsal; empty: a device
  DeviceScale scale{};              ///< from the lab's settings, applied to all measurements
  std::string fault{};              ///< of the device, which ended the acceptance; empty: none
  std::optional<RestFigures> rest{};
  std::optional<Measured> step_mm{};
  std::vector<AxisResult> axes{};  ///< the tested axes, in the order of kDeviceAxes
  std::optional<WallResult> wall{};
  std::optional<WarmResult> warm{};
  std::vector<NotMeasured> not_measured{};

  /// Requires noise at rest and, for all three axes, signs, forces and, unless skipped, delays.
  /// \return the reasons why the device fails, one line each; empty: it passed
  [[nodiscard]] std::vector<std::string> failures() const;
  [[nodiscard]] bool passed() const { return failures().empty(); }
  /// \return the largest factor between delivered and commanded force; 1 if none was measured
  [[nodiscard]] double largest_scale() const;
  /// \return the mean of a result over the axes that have it; nothing if none has it
  [[nodiscard]] std::optional<Measured> mean_of(std::optional<Measured> AxisResult::*part) const;
};

/// \return the content of the certificate's file: JSON, indented
[[nodiscard]] std::string certificate_json(const Certificate& certificate);

/// A certificate and the SHA-256 of its file, which a session stores.
struct HashedCertificate {
  Certificate certificate;
  Digest hash{};
};

/// \param source  the file's name, for messages
/// \throws StudyError with the JSON pointer if the text is not a certificate, or `passed` or `scale`
///   contradict the measurements
[[nodiscard]] Certificate parse_certificate(const std::string& text, const std::string& source);
/// \throws FileError if it cannot be read; otherwise as parse_certificate
[[nodiscard]] HashedCertificate read_certificate(const std::filesystem::path& path);

/// Compares a certificate with the device of a session.
/// \return a warning if the certificate is older than kCertificateAge or for other firmware, else ""
/// \throws DeviceError with the remedy if it is from a rehearsal, did not pass, has another driver,
///   model, serial number or scale, or was made more than kCertificateLead after `now`
[[nodiscard]] std::string check_certificate(const Certificate& certificate,
                                            const DeviceInfo& device, std::chrono::sys_seconds now);

/// \param stiffness_n_per_mm  of a study's wall
/// \throws DeviceError with the remedy if a wall of this stiffness, or a softer one, oscillated in
///   the acceptance
void require_stable(const Certificate& certificate, double stiffness_n_per_mm);

/// \param device  source of force limits and workspace
/// \return a device model with the measured parameters, for planning and rehearsals. Parameters that
///   were not measured are zero, which disables their stage. Soft arms, friction at rest and the
///   lag of velocities are never measured, so the model's walls are more stable than the device's.
[[nodiscard]] DeviceModel model_of(const Certificate& certificate, const DeviceInfo& device);

}  // namespace touchtrial::device
