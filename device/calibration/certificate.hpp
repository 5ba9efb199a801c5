/// \file The certificate of a calibration: its results, their judgement, and its file, to which
/// sessions refer by its hash.
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
/// A force that is further off than this share fails.
inline constexpr double kForceTolerance = 0.10;
/// Greatest noise and drift of a handle that lies still.
inline constexpr double kMostNoiseMm = 0.1;
inline constexpr double kMostDriftMm = 0.5;
/// An older certificate causes a warning.
inline constexpr std::chrono::hours kCertificateAge{24 * 180};

/// Axes of the device frame, in the order of their calibration: along y the weight hangs straight
/// down, along the others it pulls over a pulley.
enum class CalibrationAxis { y, x, z };
inline constexpr std::array kCalibrationAxes = {CalibrationAxis::y, CalibrationAxis::x,
                                                CalibrationAxis::z};
/// "x", "y" or "z"
[[nodiscard]] std::string_view name_of(CalibrationAxis axis) noexcept;

struct AxisResult {
  CalibrationAxis axis = CalibrationAxis::y;
  double mass_g = 0.0;
  double expected_n = 0.0;  ///< the weight
  double measured_n = 0.0;  ///< commanded with the weight, beyond that without it
  double cross_n = 0.0;     ///< the same across the axis, from a string that pulls askew
  bool passed = false;
};

/// \return whether the measured force is the weight, within kForceTolerance
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

  /// \return whether all three axes and the free-air hold passed
  [[nodiscard]] bool passed() const noexcept;
};

/// \param mass_g  > 0
/// \param empty,loaded  holds without and with the weight
[[nodiscard]] AxisResult judge_axis(CalibrationAxis axis, double mass_g, const HoldFigures& empty,
                                    const HoldFigures& loaded) noexcept;
/// \param rest  a run without force
/// \param empty  a hold without a weight
[[nodiscard]] FreeAirResult judge_free_air(const HoldFigures& rest,
                                           const HoldFigures& empty) noexcept;

/// \return the content of its file: JSON, indented. Format: docs/data-dictionary.md.
[[nodiscard]] std::string certificate_json(const Certificate& certificate);

/// A certificate and the SHA-256 of its file, which a session stores.
struct ReadCertificate {
  Certificate certificate;
  Digest hash{};
};

/// \throws FileError if it cannot be read, StudyError with the JSON pointer if it is not a
///   certificate, or claims more than its measurements show
[[nodiscard]] ReadCertificate read_certificate(const std::filesystem::path& path);

/// Compares a certificate with the device of a session.
/// \return a warning if the certificate is older than kCertificateAge, else ""
/// \throws DeviceError if it did not pass, or has another driver or serial number
[[nodiscard]] std::string check_certificate(const Certificate& certificate,
                                            const DeviceInfo& device, std::chrono::sys_seconds now);

}  // namespace touchtrial::device
