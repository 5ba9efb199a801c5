#include "device/acceptance/accelerometer.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSlowestRecordHz = 200.0;
constexpr double kLeastTimeS = 1.0;
constexpr double kSpectrumWindowS = 0.5;
constexpr double kLowestHz = 10.0;
constexpr double kHighestHz = 1000.0;
constexpr double kHighestShare = 0.4;  ///< of the rate
constexpr std::string_view kRecordHeader = "time_s,x_m_s2,y_m_s2,z_m_s2";

[[noreturn]] void refuse_line(const std::string& source, std::size_t line, const std::string& why) {
  throw FileError(one_line(
      fmt::format("{}: line {}: {}; export the record as {}", source, line, why, kRecordHeader)));
}

std::array<double, 4> numbers_in(std::string_view row, const std::string& source,
                                 std::size_t line) {
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = row.find(',');
    const bool is_last = i + 1 == numbers.size();
    if (is_last != (comma == std::string_view::npos))
      refuse_line(source, line, "has not 4 columns");
    const auto number = number_in<double>(row.substr(0, comma));
    if (!number || !std::isfinite(*number) || std::abs(*number) > 1e6) {
      refuse_line(source, line, in_quotes(row.substr(0, comma)) + " is not a number in range");
    }
    numbers[i] = *number;
    if (!is_last) row.remove_prefix(comma + 1);
  }
  return numbers;
}

double axis_of(Vec3 v, int axis) {
  if (axis == 0) return v.x;
  return axis == 1 ? v.y : v.z;
}

}  // namespace

AccelerometerRecord parse_accelerometer_csv(std::string_view text, const std::string& source) {
  AccelerometerRecord record;
  std::vector<double> times_s;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (line == 1) {
      if (row != kRecordHeader) refuse_line(source, line, in_quotes(row) + " is not the header");
      continue;
    }
    if (row.empty()) continue;
    const std::array<double, 4> numbers = numbers_in(row, source, line);
    times_s.push_back(numbers[0]);
    record.acceleration_m_s2.push_back({numbers[1], numbers[2], numbers[3]});
  }
  const std::size_t n = times_s.size();
  const double time_s = n > 1 ? times_s.back() - times_s.front() : 0.0;
  if (!(time_s >= kLeastTimeS)) {
    throw FileError(
        one_line(source + ": lasts less than a second; record while the stylus strokes"));
  }
  record.rate_hz = static_cast<double>(n - 1) / time_s;
  if (record.rate_hz < kSlowestRecordHz) {
    throw FileError(
        one_line(fmt::format("{}: has {:.0f} samples a second; record at {:.0f} Hz or "
                             "more",
                             source, record.rate_hz, kSlowestRecordHz)));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double even_s = times_s.front() + static_cast<double>(i) / record.rate_hz;
    if (std::abs(times_s[i] - even_s) * record.rate_hz > 0.5) {
      refuse_line(source, i + 2, "times are uneven");
    }
  }
  return record;
}

AccelerometerRecord read_accelerometer_csv(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest = 256U << 20U;
  return parse_accelerometer_csv(text_of(read_file(file, kLargest)), file.string());
}

std::vector<BandResult> acceleration_bands(const AccelerometerRecord& record) {
  const auto window = static_cast<std::size_t>(kSpectrumWindowS * record.rate_hz);
  const double bin_hz = record.rate_hz / static_cast<double>(window);
  const double highest_hz = std::min(kHighestHz, kHighestShare * record.rate_hz);
  const auto bins = static_cast<std::size_t>(highest_hz * std::pow(2.0, 1.0 / 6.0) / bin_hz) + 1;
  std::vector<double> hann(window);
  double hann_squares = 0.0;
  for (std::size_t i = 0; i < window; ++i) {
    hann[i] =
        0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / static_cast<double>(window));
    hann_squares += hann[i] * hann[i];
  }
  std::vector<double> power(bins, 0.0);  // mean square of each bin
  std::size_t windows = 0;
  const std::vector<Vec3>& a = record.acceleration_m_s2;
  for (std::size_t from = 0; from + window <= a.size(); from += window / 2, ++windows) {
    for (int axis = 0; axis < 3; ++axis) {
      double mean = 0.0;
      for (std::size_t i = 0; i < window; ++i) mean += axis_of(a[from + i], axis);
      mean /= static_cast<double>(window);
      for (std::size_t bin = 1; bin < bins; ++bin) {
        // Few bins are wanted, so each is summed by itself with a turning phase.
        const std::complex<double> turn =
            std::polar(1.0, -2.0 * kPi * static_cast<double>(bin) / static_cast<double>(window));
        std::complex<double> phase = 1.0;
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < window; ++i) {
          sum += (axis_of(a[from + i], axis) - mean) * hann[i] * phase;
          phase *= turn;
        }
        power[bin] += 2.0 * std::norm(sum) / (static_cast<double>(window) * hann_squares);
      }
    }
  }
  std::vector<BandResult> bands;
  const double sixth = std::pow(2.0, 1.0 / 6.0);
  for (double middle_hz = kLowestHz; middle_hz <= highest_hz; middle_hz *= sixth * sixth) {
    BandResult band{middle_hz / sixth, middle_hz * sixth, 0.0};
    double squares = 0.0;
    for (std::size_t bin = 1; bin < bins; ++bin) {
      const double hz = static_cast<double>(bin) * bin_hz;
      if (hz >= band.from_hz && hz < band.to_hz) squares += power[bin];
    }
    band.acceleration_m_s2 = windows == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(windows));
    bands.push_back(band);
  }
  return bands;
}

}  // namespace touchtrial::device
