#include "stimuli/relief.hpp"

#include "stimuli/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

constexpr double kBlack = 4.0;
constexpr double kWhite = 251.0;

double clamped(const Plane<double>& plane, int y, int x) {
  return plane.at(std::clamp(y, 0, plane.height() - 1), std::clamp(x, 0, plane.width() - 1));
}

Vec3 normalised(Vec3 v) {
  return (1.0 / norm(v)) * v;
}

Vec3 normal_at(const Plane<double>& height, int y, int x) {
  constexpr double kSpan = 2.0 / kOversampling;
  const double dx = (clamped(height, y, x + 1) - clamped(height, y, x - 1)) / kSpan;
  const double dy = (clamped(height, y + 1, x) - clamped(height, y - 1, x)) / kSpan;
  return normalised({-dx, -dy, 1.0});
}

/// Walks from points of the surface towards the lamp.
class ShadowCaster {
 public:
  ShadowCaster(const Plane<double>& height, const Lamp& lamp)
      : height_(height), blur_px_(lamp.shadow_blur_px) {
    const double across = std::hypot(lamp.towards.x, lamp.towards.y);
    const int steps = static_cast<int>(lamp.shadow_reach_px * kOversampling);
    for (int step = 1; step <= steps; step += step < 12 ? 1 : 2) {
      path_.push_back({static_cast<int>(std::lround(step * lamp.towards.x / across)),
                       static_cast<int>(std::lround(step * lamp.towards.y / across)),
                       step * lamp.towards.z / across / kOversampling});
    }
    highest_ = *std::max_element(height.samples().begin(), height.samples().end());
  }

  /// \return 0 in full light, 1 in full shadow
  [[nodiscard]] double at(int y, int x) const {
    const double here = height_.at(y, x);
    double depth = 0.0;
    for (const Step& step : path_) {
      const int column = x + step.dx;
      const int row = y + step.dy;
      if (here + step.rise > highest_ || column < 0 || row < 0 || column >= height_.width() ||
          row >= height_.height()) {
        break;
      }
      depth = std::max(depth, height_.at(row, column) - here - step.rise);
    }
    return std::min(1.0, depth / blur_px_);
  }

 private:
  struct Step {
    int dx;
    int dy;
    double rise;
  };
  const Plane<double>& height_;
  double blur_px_;
  double highest_;
  std::vector<Step> path_;
};

/// Running mean along one line; edges repeat.
void box_line(const double* from, double* to, int count, std::ptrdiff_t stride, int radius) {
  const auto sample = [&](int i) { return from[std::clamp(i, 0, count - 1) * stride]; };
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) sum += sample(i);
  for (int i = 0; i < count; ++i) {
    to[i * stride] = sum / (2 * radius + 1);
    sum += sample(i + radius + 1) - sample(i - radius);
  }
}

Plane<double> box(const Plane<double>& plane, int radius) {
  Plane<double> rows(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); ++y) {
    box_line(plane.row(y).data(), rows.row(y).data(), plane.width(), 1, radius);
  }
  Plane<double> result(plane.height(), plane.width());
  for (int x = 0; x < plane.width(); ++x) {
    box_line(rows.row(0).data() + x, result.row(0).data() + x, plane.height(), plane.width(),
             radius);
  }
  return result;
}

/// A curve through (0, 0) and (1, 1) that raises (a > 0.5) or lowers the middle. It is a rational
/// function, because powers differ in their last digit between mathematical libraries.
double bent(double t, double a) {
  return t / ((1.0 / a - 2.0) * (1.0 - t) + 1.0);
}

double find_bend(const std::vector<double>& tones, double mean) {
  double low = 0.02;
  double high = 0.98;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    double sum = 0.0;
    for (const double tone : tones) sum += bent(tone, middle);
    (sum < mean * static_cast<double>(tones.size()) ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The ground is as light as this quantile of the object.
constexpr double kGroundQuantile = 0.85;

void dim_ground(Plane<double>& light, const Plane<double>& covered, double light_on_ground) {
  std::vector<double> of_object;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (covered.samples()[i] > 0.5) of_object.push_back(light.samples()[i]);
  }
  if (of_object.empty()) return;
  const double albedo = light_quantile(of_object, kGroundQuantile) / light_on_ground;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (covered.samples()[i] < 0.5) light.samples()[i] *= albedo;
  }
}

}  // namespace

int px_to_grid(double coordinate_px) noexcept {
  return static_cast<int>(std::ceil(coordinate_px * kOversampling - 0.5));
}

Lamp lamp_for(const Specimen& specimen, Lamp lamp) {
  const Vec2 turn = specimen.turn("lamp/turn", 0.45);
  const Vec3 towards = lamp.towards;
  lamp.towards = {turn.x * towards.x - turn.y * towards.y, turn.y * towards.x + turn.x * towards.y,
                  towards.z * specimen.factor("lamp/height", 0.15)};
  return lamp;
}

double light_on_level(const Lamp& lamp) noexcept {
  return lamp.ambient + (1.0 - lamp.ambient) * lamp.towards.z / norm(lamp.towards);
}

Plane<double> lit(const Relief& relief, const Lamp& lamp) {
  const Vec3 towards = normalised(lamp.towards);
  const ShadowCaster shadow(relief.height_px, lamp);
  const int radius = std::max(1, static_cast<int>(lamp.hollow_px * kOversampling / 2));
  const Plane<double> surroundings = blurred(relief.height_px, radius);
  Plane<double> light(relief.side(), relief.side());
  for (int y = 0; y < relief.side(); ++y) {
    for (int x = 0; x < relief.side(); ++x) {
      const double direct =
          std::max(0.0, dot(normal_at(relief.height_px, y, x), towards)) * (1.0 - shadow.at(y, x));
      const double depth = (surroundings.at(y, x) - relief.height_px.at(y, x)) / lamp.hollow_px;
      const double open = std::clamp(1.0 - 1.2 * depth, lamp.min_ambient, 1.3);
      light.at(y, x) =
          relief.albedo.at(y, x) * (lamp.ambient * open + (1.0 - lamp.ambient) * direct);
    }
  }
  return light;
}

Plane<double> blurred(const Plane<double>& plane, int radius) {
  return box(box(box(plane, radius), radius), radius);
}

Plane<double> averaged(const Plane<double>& fine) {
  Plane<double> pixels(fine.height() / kOversampling, fine.width() / kOversampling);
  for (int y = 0; y < pixels.height() * kOversampling; ++y) {
    for (int x = 0; x < pixels.width() * kOversampling; ++x) {
      pixels.at(y / kOversampling, x / kOversampling) +=
          fine.at(y, x) / (kOversampling * kOversampling);
    }
  }
  return pixels;
}

double light_quantile(std::vector<double>& samples, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size() - 1));
  std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
  return samples[static_cast<std::size_t>(rank)];
}

GreyImage developed(const Plane<double>& light, const Print& print, const GreyImage& counts) {
  std::vector<double> tones;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (counts.samples()[i] != 0) tones.push_back(light.samples()[i]);
  }
  if (tones.empty()) return {light.height(), light.width()};
  const double dark = light_quantile(tones, 0.002);
  const double span = std::max(1e-9, light_quantile(tones, 0.998) - dark);
  const auto tone = [&](double value) { return std::clamp((value - dark) / span, 0.0, 1.0); };
  for (double& value : tones) value = tone(value);
  const double bend = find_bend(tones, (print.mean_grey - kBlack) / (kWhite - kBlack));
  const double black = mix(print.mean_grey, kBlack, print.contrast);
  const double white = mix(print.mean_grey, kWhite, print.contrast);
  GreyImage picture(light.height(), light.width());
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double grey = mix(black, white, bent(tone(light.samples()[i]), bend));
    picture.samples()[i] = static_cast<std::uint8_t>(std::floor(grey + 0.5));
  }
  return picture;
}

GreyImage developed(const Plane<double>& light, const Print& print) {
  return developed(light, print, GreyImage(light.height(), light.width(), 1));
}

Print print_for(const Specimen& specimen, Print print) {
  print.mean_grey += specimen.shift("print/mean", 9.0);
  print.contrast = std::min(1.0, print.contrast * specimen.factor("print/contrast", 0.15));
  return print;
}

GreyImage photographed(const Specimen& specimen, const Relief& relief, const Lamp& lamp,
                       const Print& print) {
  return developed(averaged(lit(relief, lamp_for(specimen, lamp))), print_for(specimen, print));
}

View object_view(const Specimen& specimen) {
  View view = view_of(specimen, {0.0, 0.12, 0.15});
  view.scale = 1.0 / (1.0 + 0.15 * std::abs(specimen.shift("view/scale", 1.0)));
  view.middle = {kObjectUnits / 2, kObjectUnits / 2};
  return view;
}

GreyImage photographed(const Specimen& specimen, const StillLife& scene, Lamp lamp,
                       const Print& print) {
  const double scale = scene.relief.side() / (kOversampling * kObjectUnits);
  lamp.shadow_reach_px *= scale;
  lamp.shadow_blur_px *= scale;
  lamp.hollow_px *= scale;
  lamp = lamp_for(specimen, lamp);
  Plane<double> light = lit(scene.relief, lamp);
  dim_ground(light, scene.covered, light_on_level(lamp));
  const Plane<double> share = averaged(scene.covered);
  GreyImage counts(share.height(), share.width());
  for (std::size_t i = 0; i < share.size(); ++i) {
    counts.samples()[i] = share.samples()[i] > 0.5 ? 1 : 0;
  }
  return developed(averaged(light), print_for(specimen, print), counts);
}

}  // namespace touchtrial::stimuli
