#include "core/random.hpp"
#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

struct Stalk {
  Vec2 middle_px;
  Vec2 direction{1.0, 0.0};  ///< length 1
  double half_length_px = 0.0;
  double half_width_px = 0.0;
  double bend_per_px = 0.0;  ///< quadratic departure from a straight line
  double base_px = 0.0;
  double albedo = 0.6;
  double noise_offset = 0.0;
  double split = 0.0;  ///< 0: round; 1: a flattened, folded leaf
};

/// The properties of a specimen's stalks.
struct StrawTraits {
  explicit StrawTraits(const Specimen& specimen)
      : scale(specimen.factor("view/scale", 0.22)),
        loose_share(0.22 * specimen.factor("straw/loose", 0.7)),
        slope(0.35 + specimen.shift("view/turn", 0.22)),
        thickness(specimen.factor("straw/thickness", 0.2)),
        pile_height_px(17.0 * scale * specimen.factor("view/relief", 0.3)) {}

  double scale;
  double loose_share;  ///< share of stalks with random direction
  double slope;        ///< mean direction of the other stalks
  double thickness;    ///< of the thicker stalks, relative
  double pile_height_px;
};

/// Draws a direction: similar for most stalks, random for the others.
Vec2 random_direction(RandomStream& random, const StrawTraits& traits) {
  if (random.uniform() < traits.loose_share) {
    const Vec2 random_vector{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    return (1.0 / std::max(1e-6, std::sqrt(random_vector.x * random_vector.x +
                                           random_vector.y * random_vector.y))) *
           random_vector;
  }
  const double slope =
      traits.slope + 0.55 * (random.uniform() + random.uniform() + random.uniform() - 1.5) * 1.4;
  return (1.0 / std::sqrt(1.0 + slope * slope)) * Vec2{1.0, slope};
}

Stalk random_stalk(RandomStream& random, int size_px, const StrawTraits& traits, double height_px) {
  Stalk stalk;
  stalk.middle_px = {random.uniform(-60.0, size_px + 60.0), random.uniform(-60.0, size_px + 60.0)};
  stalk.direction = random_direction(random, traits);
  stalk.half_length_px = traits.scale * random.uniform(45.0, 190.0);
  const double thick = random.uniform();
  stalk.half_width_px = traits.scale * (1.4 + 3.2 * traits.thickness * thick * thick);
  stalk.bend_per_px = random.uniform(-1.0, 1.0) * 0.0011;
  stalk.base_px = height_px + random.uniform(-2.0, 2.0);
  stalk.albedo = random.uniform(0.5, 0.82);
  stalk.noise_offset = random.uniform(0.0, 900.0);
  stalk.split = random.uniform() < 0.3 ? 1.0 : 0.0;
  return stalk;
}

class StrawPainter {
 public:
  StrawPainter(std::uint64_t seed, Relief& relief)
      : fibres_(seed, "straw/fibres"), relief_(relief) {}

  void paint_ground() {
    fill(relief_, [&](double x, double y) {
      const double dust = fibres_.fractal(x / 6, y / 6, 3);
      return SurfacePoint{-6.0 + 2.0 * dust, 0.3 + 0.1 * dust};
    });
  }

  /// Paints a stalk as cross-sections, one per grid point along the axis closer to it.
  void paint(const Stalk& stalk) {
    const bool is_horizontal = std::abs(stalk.direction.x) >= std::abs(stalk.direction.y);
    const double major = is_horizontal ? stalk.direction.x : stalk.direction.y;
    const double reach = std::abs(major) * stalk.half_length_px + 2 * stalk.half_width_px;
    const double centre = is_horizontal ? stalk.middle_px.x : stalk.middle_px.y;
    const int first = std::max(0, px_to_grid(centre - reach));
    const int last = std::min(relief_.side() - 1, px_to_grid(centre + reach));
    for (int i = first; i <= last; ++i) paint_cross_section(stalk, is_horizontal, i);
  }

 private:
  void paint_cross_section(const Stalk& stalk, bool is_horizontal, int i) {
    const double major = is_horizontal ? stalk.direction.x : stalk.direction.y;
    const double minor = is_horizontal ? stalk.direction.y : stalk.direction.x;
    const double middle_distance =
        grid_to_px(i) - (is_horizontal ? stalk.middle_px.x : stalk.middle_px.y);
    const double s = middle_distance / major;
    const double bend = stalk.bend_per_px * s * s / std::abs(major);
    const double centre = (is_horizontal ? stalk.middle_px.y : stalk.middle_px.x) + s * minor +
                          (is_horizontal == (major > 0) ? bend : -bend);
    const double reach = 1.6 * stalk.half_width_px / std::abs(major) + 1.0;
    const int first = std::max(0, px_to_grid(centre - reach));
    const int last = std::min(relief_.side() - 1, px_to_grid(centre + reach));
    for (int j = first; j <= last; ++j) {
      const double t = (grid_to_px(j) - centre) * std::abs(major);
      if (is_horizontal)
        paint_point(stalk, s, t, j, i);
      else
        paint_point(stalk, s, t, i, j);
    }
  }

  void paint_point(const Stalk& stalk, double s, double t, int y, int x) {
    if (std::abs(s) > stalk.half_length_px) return;
    const double width =
        stalk.half_width_px * (1.0 + 0.12 * fibres_.at(s / 30 + stalk.noise_offset, 1.5));
    const double u = t / width;
    if (u * u >= 1.0) return;
    const double groove = fibres_.ridged(t / 1.7 + stalk.noise_offset, s / 60, 2);
    const double round = std::sqrt(1.0 - u * u);
    const double folded = 0.75 * (1.0 - std::abs(u - 0.2));
    const double rise = stalk.split > 0.5 ? folded : round;
    relief_.height_px.at(y, x) = stalk.base_px + 1.1 * stalk.half_width_px * rise + 0.5 * groove;
    const double blotch = fibres_.fractal(s / 16 + stalk.noise_offset, t / 9, 3);
    const double knot = std::abs(s - 0.3 * stalk.half_length_px) < 2.0 ? -0.14 : 0.0;
    relief_.albedo.at(y, x) =
        std::clamp(stalk.albedo + 0.14 * blotch + 0.14 * (groove - 0.6) + knot, 0.1, 1.0);
  }

  Noise fibres_;
  Relief& relief_;
};

}  // namespace

GreyImage make_straw(const Specimen& specimen, int size_px) {
  constexpr double kStalksPerPixel = 0.0046;
  Relief relief(size_px);
  StrawPainter painter(specimen.noise_seed(), relief);
  painter.paint_ground();
  const StrawTraits traits(specimen);
  RandomStream random(specimen.noise_seed(), "straw/stalks");
  const double side = (size_px + 120) / traits.scale;
  const int count = static_cast<int>(kStalksPerPixel * side * side);
  for (int i = 0; i < count; ++i) {
    painter.paint(random_stalk(random, size_px, traits, traits.pile_height_px * i / count));
  }
  const Lamp lamp{{-0.45, -0.7, 0.78}, 0.42, 24.0, 3.5, 8.0};
  return photograph(specimen, relief, lamp, {122.0, 0.75});
}

}  // namespace touchtrial::stimuli
