#include "device/calibration/certificate.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::device {
namespace {

Vec3 direction_of(CalibrationAxis axis) noexcept {
  return {axis == CalibrationAxis::x ? 1.0 : 0.0, axis == CalibrationAxis::y ? 1.0 : 0.0,
          axis == CalibrationAxis::z ? 1.0 : 0.0};
}

double along(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Whether the handle stood still.
bool is_steady(const HoldFigures& figures) noexcept {
  return figures.measured && figures.noise_mm <= kMostNoiseMm && figures.drift_mm <= kMostDriftMm;
}

}  // namespace

std::string_view name_of(CalibrationAxis axis) noexcept {
  if (axis == CalibrationAxis::x) return "x";
  return axis == CalibrationAxis::y ? "y" : "z";
}

bool is_within_tolerance(const AxisResult& result) noexcept {
  return result.expected_n > 0.0 &&
         std::abs(result.measured_n / result.expected_n - 1.0) <= kForceTolerance;
}

bool Certificate::passed() const noexcept {
  return axes.size() == kCalibrationAxes.size() && free_air.passed &&
         std::ranges::all_of(axes, [](const AxisResult& result) { return result.passed; });
}

AxisResult judge_axis(CalibrationAxis axis, double mass_g, const HoldFigures& empty,
                      const HoldFigures& loaded) noexcept {
  const Vec3 more_n = loaded.force_n - empty.force_n;
  const double along_n = along(more_n, direction_of(axis));
  AxisResult result;
  result.axis = axis;
  result.mass_g = mass_g;
  result.expected_n = 0.001 * mass_g * kStandardGravityMS2;
  // Over a pulley the weight pulls to either side.
  result.measured_n = std::abs(along_n);
  result.cross_n = norm(more_n - along_n * direction_of(axis));
  result.passed = is_steady(empty) && is_steady(loaded) && is_within_tolerance(result);
  return result;
}

FreeAirResult judge_free_air(const HoldFigures& rest, const HoldFigures& empty) noexcept {
  return {rest.noise_mm, rest.drift_mm, norm(empty.force_n), is_steady(rest) && empty.measured};
}

std::string check_certificate(const Certificate& certificate, const DeviceInfo& device,
                              std::chrono::sys_seconds now) {
  constexpr const char* kRemedy = "; run touchtrial device calibrate ";
  if (certificate.driver != device.name || certificate.serial != device.serial) {
    throw DeviceError(one_line("the certificate is of " + certificate.driver + " " +
                               certificate.serial + ", the device is " + device.name + " " +
                               device.serial + kRemedy + device.name));
  }
  if (!certificate.passed()) {
    throw DeviceError(one_line(device.name + ": its certificate says that calibration failed" +
                               kRemedy + device.name));
  }
  if (now - certificate.made <= kCertificateAge) return "";
  const auto days = std::chrono::duration_cast<std::chrono::days>(now - certificate.made).count();
  return device.name + ": its certificate is " + std::to_string(days) + " days old" + kRemedy +
         device.name;
}

}  // namespace touchtrial::device
