/// \file The practice textures: sand, leather and cork.
#include "core/random.hpp"
#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

/// One of the waves that add up to the ripples.
struct Wave {
  Vec2 per_px;  ///< periods per pixel
  double phase = 0.0;
};

/// Wind ripples in sand: the sum of many waves of similar length and direction, whose crests fork
/// and end.
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

  /// The relative height of the ripples, about -1 .. 1.
  [[nodiscard]] double ripples(double x, double y) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      const double position = x * wave.per_px.x + y * wave.per_px.y + wave.phase;
      const double t = 2.0 * std::abs(2.0 * (position - std::floor(position)) - 1.0) - 1.0;
      sum += t * (1.5 - 0.5 * t * t);  // nearly a cosine
    }
    const double strength = sum / (0.9 * std::sqrt(static_cast<double>(kWaves)));
    return strength / std::sqrt(1.0 + 0.6 * strength * strength);
  }

  Noise bend_;
  Noise grains_;
  double height_;  ///< of the ripples, pixels
  std::vector<Wave> waves_;
};

/// Grained leather: cushions of two sizes between creases, wrinkles where it was bent, and pores.
class Leather {
 public:
  explicit Leather(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "leather/bend"),
        cushions_(specimen.noise_seed(), "leather/cushions"),
        grain_(specimen.noise_seed(), "leather/grain"),
        wrinkles_(specimen.noise_seed(), "leather/wrinkles"),
        pores_(specimen.noise_seed(), "leather/pores"),
        wrinkle_depth_(2.6 * specimen.factor("leather/wrinkled", 0.6)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx =
        x + 4.5 * bend_.fractal(x / 26, y / 26, 2) + 30.0 * bend_.fractal(x / 170 + 5, y / 170, 2);
    const double wy = y + 4.5 * bend_.fractal(x / 26 + 70, y / 26, 2) +
                      30.0 * bend_.fractal(x / 170, y / 170 + 5, 2);
    const CellPosition cushion = cushions_.at(wx / 19.0, wy / 16.0);
    const CellPosition grain = grain_.at(wx / 7.3, wy / 6.7);
    const double groove = smooth_step(0.0, 0.22, cushion.to_border);
    const double round = 0.6 * groove + 0.4 * std::min(1.0, 1.6 * cushion.to_border);
    const double fine = smooth_step(0.0, 0.6, grain.to_border);
    const double wrinkle = wrinkles_.ridged(wx / 75, wy / 52, 3);
    const double crease = smooth_step(0.84, 0.98, wrinkle);
    const CellPosition pore = pores_.at(x / 11, y / 11);
    const double hole =
        pores_.value(pore.cell) < 0.3 ? smooth_step(0.12, 0.05, pore.to_centre) : 0.0;
    SurfacePoint point;
    point.height_px = 3.6 * round * mix(0.6, 1.0, cushions_.value(cushion.cell, 1)) + 0.45 * fine -
                      wrinkle_depth_ * crease - 1.6 * hole +
                      9.0 * bend_.fractal(x / 120 + 30, y / 140, 2) +
                      0.25 * wrinkles_.at(x / 2.2, y / 2.2);
    point.albedo = 0.40 + 0.15 * groove + 0.02 * fine - 0.10 * crease - 0.12 * hole +
                   0.12 * bend_.fractal(x / 75 + 9, y / 75, 3) +
                   0.03 * wrinkles_.at(x / 1.8, y / 1.8);
    return point;
  }

 private:
  Noise bend_;
  Cells cushions_;
  Cells grain_;
  Noise wrinkles_;
  Cells pores_;
  double wrinkle_depth_;  ///< depth of the wrinkles, pixels
};

/// A sheet of pressed cork: granules of many sizes and shades, some torn out, dark flecks of bark.
class Cork {
 public:
  explicit Cork(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "cork/bend"),
        granules_(specimen.noise_seed(), "cork/granules"),
        crumbs_(specimen.noise_seed(), "cork/crumbs"),
        flecks_(specimen.noise_seed(), "cork/flecks"),
        torn_share_(0.10 * specimen.factor("cork/torn", 0.7)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx = x + 7.0 * bend_.fractal(x / 16, y / 16, 3);
    const double wy = y + 7.0 * bend_.fractal(x / 16 + 60, y / 16, 3);
    const CellPosition large = granules_.at(wx / 30, wy / 23);
    // Crumbs lie between large granules; some cells contain only crumbs.
    const bool is_crumbled = granules_.value(large.cell) < 0.35;
    const CellPosition small =
        crumbs_.at(wx / 10.5 + 4.0 * granules_.value(large.cell, 2), wy / 9.5);
    const double shade = is_crumbled ? crumbs_.value(small.cell) : granules_.value(large.cell, 1);
    const double border =
        is_crumbled ? std::min(0.4 * small.to_border, large.to_border) : large.to_border;
    const double joint = smooth_step(0.13, 0.0, border);
    const bool is_missing =
        (is_crumbled ? crumbs_.value(small.cell, 1) : granules_.value(large.cell, 3)) < torn_share_;
    const double hole = is_missing ? smooth_step(0.02, 0.14, border) : 0.0;
    const double pith = bend_.fractal(wx / 3.1, wy / 3.1, 3);
    const CellPosition fleck = flecks_.at(wx / 19 + 30, wy / 8.5);
    const double bark =
        flecks_.value(fleck.cell) < 0.16 ? smooth_step(0.36, 0.18, fleck.to_centre) : 0.0;
    SurfacePoint point;
    point.height_px = 2.0 * (shade - 0.5) - 1.2 * joint - 3.4 * hole + 1.1 * pith - 0.8 * bark +
                      0.8 * bend_.at(x / 1.9, y / 1.9) + 1.5 * bend_.fractal(x / 60 + 8, y / 60, 2);
    point.albedo = std::clamp(0.46 + 0.20 * shade + 0.17 * pith - 0.07 * joint - 0.10 * hole -
                                  0.24 * bark + 0.05 * bend_.at(x / 1.6 + 9, y / 1.6),
                              0.06, 1.0);
    return point;
  }

 private:
  Noise bend_;
  Cells granules_;
  Cells crumbs_;
  Cells flecks_;
  double torn_share_;  ///< share of the granules that are missing
};

}  // namespace

GreyImage make_sand(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.42, -0.74, 0.5}, 0.34, 24.0, 2.0, 9.0};
  return draw_surface(specimen, size_px, Sand(specimen), view_of(specimen, {0.2, 0.3, 0.2}), lamp,
                      {120.0});
}

GreyImage make_leather(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.6, -0.55, 0.9}, 0.4, 16.0, 3.0, 8.0};
  return draw_surface(specimen, size_px, Leather(specimen), view_of(specimen, {0.22, 0.4, 0.25}),
                      lamp, {116.0});
}

GreyImage make_cork(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.55, -0.6, 0.75}, 0.4, 12.0, 2.0, 6.0};
  return draw_surface(specimen, size_px, Cork(specimen), view_of(specimen, {0.25, 0.4, 0.2}), lamp,
                      {124.0});
}

}  // namespace touchtrial::stimuli
