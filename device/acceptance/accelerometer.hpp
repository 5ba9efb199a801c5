/// \file Records of an accelerometer at the stylus: what the hand feels above the frequencies that
/// encoders show. Source: docs/devices/acceptance.md.
#pragma once

#include "core/vec.hpp"
#include "device/acceptance/certificate.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

struct AccelerometerRecord {
  double rate_hz = 0.0;
  std::vector<Vec3> acceleration_m_s2;
  bool overdriven = false;  ///< samples lie at the end of the input's range
};

/// An accelerometer at the stylus that records while the device runs. Not thread-safe.
class Accelerometer {
 public:
  virtual ~Accelerometer() = default;
  Accelerometer() = default;
  Accelerometer(const Accelerometer&) = delete;
  Accelerometer& operator=(const Accelerometer&) = delete;

  /// Forgets what was recorded, and begins anew.
  /// \throws DeviceError with the remedy if it cannot record
  virtual void start() = 0;
  /// \return what was recorded since `start`
  /// \throws DeviceError if it went away meanwhile
  [[nodiscard]] virtual AccelerometerRecord stop() = 0;
};

/// Reads a CSV file with the header time_s,x_m_s2,y_m_s2,z_m_s2 and even times.
/// \throws FileError with line and remedy if it cannot be read, is no such file, lasts less than a
///   second, is slower than 200 Hz, or its times are uneven by more than a tenth of their distance
[[nodiscard]] AccelerometerRecord read_accelerometer_csv(const std::filesystem::path& file);
/// The same from text.
/// \param source  names the origin in errors
[[nodiscard]] AccelerometerRecord parse_accelerometer_csv(std::string_view text,
                                                          const std::string& source);

/// The root mean square in each third of an octave from 10 Hz to 1 kHz, or to 0.4 of the rate, all
/// axes together (Welch's method: Hann windows of half a second, half overlapping).
[[nodiscard]] std::vector<BandResult> acceleration_bands(const AccelerometerRecord& record);

}  // namespace touchtrial::device
