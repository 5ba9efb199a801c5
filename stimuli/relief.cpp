#include "stimuli/relief.hpp"

#include "stimuli/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

constexpr double kBlack = 4.0;
constexpr double kWhite = 251.0;

double clamped_sample(const Plane<double>& plane, int y, int x) {
  return plane.at(std::clamp(y, 0, plane.height() - 1), std::clamp(x, 0, plane.width() - 1));
}

Vec3 normalise(Vec3 v) {
  return (1.0 / norm(v)) * v;
}

Vec3 normal_at(const Plane<double>& height, int y, int x) {
  constexpr double kSpan = 2.0 / kOversampling;
  const double dx = (clamped_sample(height, y, x + 1) - clamped_sample(height, y, x - 1)) / kSpan;
  const double dy = (clamped_sample(height, y + 1, x) - clamped_sample(height, y - 1, x)) / kSpan;
  return normalise({-dx, -dy, 1.0});
}

/// Computes shadows by ray marching from surface points towards the lamp.
class ShadowCaster {
 public:
  ShadowCaster(const Plane<double>& height, const Lamp& lamp)
      : height_(height), blur_px_(lamp.shadow_blur_px) {
    const double horizontal_length = std::hypot(lamp.direction.x, lamp.direction.y);
    const int steps = static_cast<int>(lamp.shadow_reach_px * kOversampling);
    for (int step = 1; step <= steps; step += step < 12 ? 1 : 2) {
      path_.push_back({static_cast<int>(std::lround(step * lamp.direction.x / horizontal_length)),
                       static_cast<int>(std::lround(step * lamp.direction.y / horizontal_length)),
                       step * lamp.direction.z / horizontal_length / kOversampling});
    }
    highest_ = *std::max_element(height.samples().begin(), height.samples().end());
  }

  /// \return 0 in full light, 1 in full shadow
  [[nodiscard]] double at(int y, int x) const {
    const double start_height = height_.at(y, x);
    double depth = 0.0;
    for (const Step& step : path_) {
      const int column = x + step.dx;
      const int row = y + step.dy;
      if (start_height + step.rise > highest_ || column < 0 || row < 0 ||
          column >= height_.width() || row >= height_.height()) {
        break;
      }
      depth = std::max(depth, height_.at(row, column) - start_height - step.rise);
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

/// Computes the running mean along one line, with repeated edges.
void box_mean_of_line(const double* source, double* target, int count, std::ptrdiff_t stride,
                      int radius) {
  const auto sample = [&](int i) { return source[std::clamp(i, 0, count - 1) * stride]; };
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) sum += sample(i);
  for (int i = 0; i < count; ++i) {
    target[i * stride] = sum / (2 * radius + 1);
    sum += sample(i + radius + 1) - sample(i - radius);
  }
}

Plane<double> box_mean(const Plane<double>& plane, int radius) {
  Plane<double> rows(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); ++y) {
    box_mean_of_line(plane.row(y).data(), rows.row(y).data(), plane.width(), 1, radius);
  }
  Plane<double> result(plane.height(), plane.width());
  for (int x = 0; x < plane.width(); ++x) {
    box_mean_of_line(rows.row(0).data() + x, result.row(0).data() + x, plane.height(),
                     plane.width(), radius);
  }
  return result;
}

/// A tone curve through (0, 0) and (1, 1) that raises (a > 0.5) or lowers the middle. It is
/// rational, because powers differ in their last digit between libraries.
double tone_curve(double t, double a) {
  return t / ((1.0 / a - 2.0) * (1.0 - t) + 1.0);
}

double find_bend(const std::vector<double>& tones, double mean) {
  double low = 0.02;
  double high = 0.98;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    double sum = 0.0;
    for (const double tone : tones) sum += tone_curve(tone, middle);
    (sum < mean * static_cast<double>(tones.size()) ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The ground is as light as this quantile of the object's light.
constexpr double kGroundQuantile = 0.85;

void dim_ground(Plane<double>& light, const Plane<double>& coverage, double light_on_ground) {
  std::vector<double> object_light;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (coverage.samples()[i] > 0.5) object_light.push_back(light.samples()[i]);
  }
  if (object_light.empty()) return;
  const double albedo = light_quantile(object_light, kGroundQuantile) / light_on_ground;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (coverage.samples()[i] < 0.5) light.samples()[i] *= albedo;
  }
}

}  // namespace

int px_to_grid(double coordinate_px) noexcept {
  return static_cast<int>(std::ceil(coordinate_px * kOversampling - 0.5));
}

Lamp lamp_for(const Specimen& specimen, Lamp lamp) {
  const Vec2 turn = specimen.turn("lamp/turn", 0.45);
  const Vec3 direction = lamp.direction;
  lamp.direction = {turn.x * direction.x - turn.y * direction.y,
                    turn.y * direction.x + turn.x * direction.y,
                    direction.z * specimen.factor("lamp/height", 0.15)};
  return lamp;
}

double light_on_level(const Lamp& lamp) noexcept {
  return lamp.ambient + (1.0 - lamp.ambient) * lamp.direction.z / norm(lamp.direction);
}

Plane<double> render_light(const Relief& relief, const Lamp& lamp) {
  const Vec3 direction = normalise(lamp.direction);
  const ShadowCaster shadow(relief.height_px, lamp);
  const int radius = std::max(1, static_cast<int>(lamp.hollow_px * kOversampling / 2));
  const Plane<double> surroundings = blur(relief.height_px, radius);
  Plane<double> light(relief.side(), relief.side());
  for (int y = 0; y < relief.side(); ++y) {
    for (int x = 0; x < relief.side(); ++x) {
      const double direct = std::max(0.0, dot(normal_at(relief.height_px, y, x), direction)) *
                            (1.0 - shadow.at(y, x));
      const double depth = (surroundings.at(y, x) - relief.height_px.at(y, x)) / lamp.hollow_px;
      const double exposure = std::clamp(1.0 - 1.2 * depth, lamp.min_ambient, 1.3);
      light.at(y, x) =
          relief.albedo.at(y, x) * (lamp.ambient * exposure + (1.0 - lamp.ambient) * direct);
    }
  }
  return light;
}

Plane<double> blur(const Plane<double>& plane, int radius) {
  return box_mean(box_mean(box_mean(plane, radius), radius), radius);
}

Plane<double> average_to_pixels(const Plane<double>& fine) {
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

GreyImage develop(const Plane<double>& light, const Print& print, const GreyImage& mask) {
  std::vector<double> tones;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (mask.samples()[i] != 0) tones.push_back(light.samples()[i]);
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
    const double grey = mix(black, white, tone_curve(tone(light.samples()[i]), bend));
    picture.samples()[i] = static_cast<std::uint8_t>(std::floor(grey + 0.5));
  }
  return picture;
}

GreyImage develop(const Plane<double>& light, const Print& print) {
  return develop(light, print, GreyImage(light.height(), light.width(), 1));
}

Print print_for(const Specimen& specimen, Print print) {
  print.mean_grey += specimen.shift("print/mean", 9.0);
  print.contrast = std::min(1.0, print.contrast * specimen.factor("print/contrast", 0.15));
  return print;
}

GreyImage photograph(const Specimen& specimen, const Relief& relief, const Lamp& lamp,
                     const Print& print) {
  return develop(average_to_pixels(render_light(relief, lamp_for(specimen, lamp))),
                 print_for(specimen, print));
}

View object_view(const Specimen& specimen) {
  View view = view_of(specimen, {0.0, 0.12, 0.15});
  view.scale = 1.0 / (1.0 + 0.15 * std::abs(specimen.shift("view/scale", 1.0)));
  view.middle = {kObjectUnits / 2, kObjectUnits / 2};
  return view;
}

GreyImage photograph(const Specimen& specimen, const StillLife& scene, Lamp lamp,
                     const Print& print) {
  const double scale = scene.relief.side() / (kOversampling * kObjectUnits);
  lamp.shadow_reach_px *= scale;
  lamp.shadow_blur_px *= scale;
  lamp.hollow_px *= scale;
  lamp = lamp_for(specimen, lamp);
  Plane<double> light = render_light(scene.relief, lamp);
  dim_ground(light, scene.coverage, light_on_level(lamp));
  const Plane<double> share = average_to_pixels(scene.coverage);
  GreyImage mask(share.height(), share.width());
  for (std::size_t i = 0; i < share.size(); ++i) {
    mask.samples()[i] = share.samples()[i] > 0.5 ? 1 : 0;
  }
  return develop(average_to_pixels(light), print_for(specimen, print), mask);
}

}  // namespace touchtrial::stimuli
