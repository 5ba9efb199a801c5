/// \file What a calibration found, judged, and kept as a file that sessions refer to by its hash.
#pragma once

#include "core/hash.hpp"
#include "device/calibration/hold.hpp"
#include "device/haptic_device.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

inline constexpr double kStandardGravityMS2 = 9.80665;
/// A force constant that is further off than this share fails.
inline constexpr double kForceTolerance = 0.10;
/// A handle that lies still may show this much.
inline constexpr double kMostNoiseMm = 0.1;
inline constexpr double kMostDriftMm = 0.5;
/// An older certificate is warned of.
inline constexpr std::chrono::hours kCertificateAge{24 * 180};

/// Axes of the device frame, in the order in which they are calibrated: y hangs straight down, the
/// others pull over a pulley.
enum class CalibrationAxis { y, x, z };
inline constexpr std::array kCalibrationAxes = {CalibrationAxis::y, CalibrationAxis::x,
                                                CalibrationAxis::z};
/// "x", "y" or "z"
[[nodiscard]] std::string_view name_of(CalibrationAxis axis) noexcept;

struct AxisResult {
  CalibrationAxis axis = CalibrationAxis::y;
  double mass_g = 0.0;
  double expected_n = 0.0;  ///< the weight
  double measured_n = 0.0;  ///< that the program had to command more than without the weight
  double cross_n = 0.0;     ///< the same across the axis: a string that pulls askew
  bool passed = false;
};

/// Whether the force that was measured is the weight, within kForceTolerance.
[[nodiscard]] bool is_within_tolerance(const AxisResult& result) noexcept;

struct FreeAirResult {
  double noise_mm = 0.0;
  double drift_mm = 0.0;
  double residual_n = 0.0;  ///< commanded to hold the handle without a weight; not judged
  bool passed = false;
};

struct Certificate {
  std::string driver;
  std::string model;
  std::string serial;
  std::string firmware;
  std::string program;              ///< version
  std::chrono::sys_seconds made{};  ///< UTC
  std::vector<AxisResult> axes;     ///< all three
  FreeAirResult free_air;

  /// All three axes and the free-air hold did.
  [[nodiscard]] bool passed() const noexcept;
};

/// \param mass_g  > 0  \param empty,loaded  holds without and with the weight
[[nodiscard]] AxisResult judge_axis(CalibrationAxis axis, double mass_g, const HoldFigures& empty,
                                    const HoldFigures& loaded) noexcept;
/// \param rest  without force  \param empty  a hold without a weight
[[nodiscard]] FreeAirResult judge_free_air(const HoldFigures& rest,
                                           const HoldFigures& empty) noexcept;

/// As a file holds it: JSON, indented. Format: docs/data-dictionary.md.
[[nodiscard]] std::string certificate_json(const Certificate& certificate);

/// A certificate and the SHA-256 of its file, which a session stores.
struct ReadCertificate {
  Certificate certificate;
  Digest hash{};
};

/// \throws FileError if it cannot be read, StudyError with the JSON pointer if it is none, or says
///   more than its figures do
[[nodiscard]] ReadCertificate read_certificate(const std::filesystem::path& path);

/// Holds a certificate against the device that a session is about to use.
/// \return a warning if it is older than kCertificateAge, else nothing to say
/// \throws DeviceError if it did not pass, or is of another driver or serial
[[nodiscard]] std::string check_certificate(const Certificate& certificate,
                                            const DeviceInfo& device, std::chrono::sys_seconds now);

}  // namespace touchtrial::device
