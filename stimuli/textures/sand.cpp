#include "core/random.hpp"
#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

/// One of the waves that make up the ripples.
struct Wave {
  Vec2 per_px;  ///< periods a pixel
  double phase = 0.0;
};

/// Ripples that wind left in sand. Many waves of nearly one length and direction add up to crests
/// that fork, end and begin anew, as those of sand do.
class Sand {
 public:
  explicit Sand(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "sand/bend"),
        grains_(specimen.noise_seed(), "sand/grains"),
        height_(4.6 * specimen.factor("sand/height", 0.25)) {
    RandomStream random(specimen.noise_seed(), "sand/waves");
    for (int i = 0; i < kWaves; ++i) {
      const double slope = 0.34 + random.uniform(-0.32, 0.32);
      const double periods = random.uniform(0.82, 1.18) / kRipple_px;
      const double length = std::sqrt(1.0 + slope * slope);
      waves_.push_back({{periods * slope / length, periods / length}, random.uniform()});
    }
  }

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx = x + 5.0 * bend_.fractal(x / 60, y / 60, 2);
    const double wy = y + 7.0 * bend_.fractal(x / 55 + 40, y / 55, 2);
    const double ripple = ripples(wx, wy);
    // Crests are sharper than troughs.
    const double crest = ripple > 0.0 ? ripple * (0.7 + 0.3 * ripple) : 0.75 * ripple;
    const double coarse = grains_.fractal(x / 2.6, y / 2.6, 2);
    const double fine = grains_.at(x / 1.3 + 90, y / 1.3);
    SurfacePoint point;
    point.height_px = height_ * crest + 4.0 * bend_.fractal(x / 150 + 80, y / 150, 2) +
                      0.55 * coarse + 0.25 * fine;
    point.albedo = 0.5 + 0.05 * crest + 0.13 * coarse + 0.10 * fine +
                   0.06 * bend_.fractal(x / 35 + 20, y / 35, 3);
    return point;
  }

 private:
  static constexpr int kWaves = 28;
  static constexpr double kRipple_px = 25.0;

  /// About -1 .. 1.
  [[nodiscard]] double ripples(double x, double y) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      const double place = x * wave.per_px.x + y * wave.per_px.y + wave.phase;
      const double t = 2.0 * std::abs(2.0 * (place - std::floor(place)) - 1.0) - 1.0;
      sum += t * (1.5 - 0.5 * t * t);  // a cosine but for the last digits
    }
    const double strength = sum / (0.9 * std::sqrt(static_cast<double>(kWaves)));
    return strength / std::sqrt(1.0 + 0.6 * strength * strength);
  }

  Noise bend_;
  Noise grains_;
  double height_;  ///< of the ripples, pixels
  std::vector<Wave> waves_;
};

}  // namespace

GreyImage make_sand(const Specimen& specimen, int size_px) {
  Relief relief(size_px);
  fill(relief, Sand(specimen), view_of(specimen, {0.2, 0.3, 0.2}));
  const Lamp lamp{{-0.42, -0.74, 0.5}, 0.34, 24.0, 2.0, 9.0};
  return photographed(specimen, relief, lamp, {120.0});
}

}  // namespace touchtrial::stimuli
