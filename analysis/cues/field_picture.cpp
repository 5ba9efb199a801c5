#include "analysis/cues/field_picture.hpp"

#include "engine/rendering/cubic_spline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::analysis {
namespace {

constexpr double kMidGrey = 127.5;
constexpr double kDeviations = 2.5;

std::vector<double> surface_of(engine::FieldView field) {
  std::vector<double> surface;
  for (const engine::FieldSample& sample : field.samples) surface.push_back(sample.surface);
  if (field.coefficients.empty()) return surface;
  const PlaneGeometry& plane = field.geometry;
  for (int y = 0; y < plane.height_px; ++y) {
    for (int x = 0; x < plane.width_px; ++x) {
      surface.push_back(
          engine::spline_at(field.coefficients, plane.height_px, plane.width_px, x, y).value);
    }
  }
  return surface;
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) moments.mean += value / n;
  for (const double value : values) {
    moments.deviation += (value - moments.mean) * (value - moments.mean) / n;
  }
  moments.deviation = std::sqrt(moments.deviation);
  return moments;
}

}  // namespace

GreyImage field_picture(engine::FieldView field) {
  if (field.empty()) return {};
  const std::vector<double> surface = surface_of(field);
  const Moments moments = moments_of(surface);
  // A field that varies by rounding alone is flat.
  const bool is_flat = moments.deviation <= 1e-6 * (1.0 + std::abs(moments.mean));
  const double gain = is_flat ? 0.0 : kMidGrey / (kDeviations * moments.deviation);
  GreyImage picture(field.geometry.height_px, field.geometry.width_px);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const double grey = kMidGrey + gain * (surface[i] - moments.mean);
    picture.samples()[i] = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
  }
  return picture;
}

}  // namespace touchtrial::analysis
