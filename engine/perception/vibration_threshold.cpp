#include "engine/perception/vibration_threshold.hpp"

#include <cmath>
#include <cstddef>
#include <span>

namespace touchtrial::engine {
namespace {

struct Point {
  double frequency_hz;
  double level_db;  ///< re 1 um peak
};

// Levels at 10, 20 and 320 Hz are printed, levels at 40 to 160 Hz follow the printed slope, and the
// level at 500 Hz is an estimate.
constexpr std::array kIsrar{Point{10.0, 28.3},  Point{20.0, 18.6},   Point{40.0, 4.5},
                            Point{80.0, -9.6},  Point{160.0, -23.7}, Point{320.0, -24.4},
                            Point{500.0, -18.0}};
constexpr double kOctavesPerDecade = 3.321928094887362;
/// The curve is constant up to 30 Hz and falls by 12 dB per octave up to 300 Hz.
constexpr std::array kTan{Point{30.0, 28.0}, Point{300.0, 28.0 - 12.0 * kOctavesPerDecade}};

std::span<const Point> points_of(ThresholdCurve curve) noexcept {
  if (curve == ThresholdCurve::israr_2006) return kIsrar;
  return kTan;
}

double level_db(std::span<const Point> points, double frequency_hz) noexcept {
  if (frequency_hz <= points.front().frequency_hz) return points.front().level_db;
  if (frequency_hz >= points.back().frequency_hz) return points.back().level_db;
  std::size_t i = 1;
  while (points[i].frequency_hz < frequency_hz) ++i;
  const Point& low = points[i - 1];
  const Point& high = points[i];
  const double share =
      std::log(frequency_hz / low.frequency_hz) / std::log(high.frequency_hz / low.frequency_hz);
  return low.level_db + share * (high.level_db - low.level_db);
}

}  // namespace

std::string_view name_of(ThresholdCurve curve) noexcept {
  return curve == ThresholdCurve::israr_2006 ? "israr_2006" : "tan_1994";
}

double threshold_displacement_m(ThresholdCurve curve, double frequency_hz) noexcept {
  constexpr double kReferenceM = 1e-6;
  return kReferenceM * std::pow(10.0, level_db(points_of(curve), frequency_hz) / 20.0);
}

}  // namespace touchtrial::engine
