/// \file From a height map to a photograph of it: one lamp, shadows, dark hollows, development.
#pragma once

#include "core/plane.hpp"
#include "core/vec.hpp"
#include "stimuli/specimen.hpp"

#include <vector>

namespace touchtrial::stimuli {

/// Reliefs are computed on a grid this many times finer than the picture, then averaged, as the
/// sensor of a camera does.
inline constexpr int kOversampling = 2;

/// One point of a surface.
struct SurfacePoint {
  double height_px = 0.0;  ///< towards the viewer, in pixels of the picture
  double albedo = 0.5;     ///< share of the light that the material returns, 0 .. 1
};

/// A surface seen from above, on the fine grid.
struct Relief {
  Plane<double> height_px;
  Plane<double> albedo;

  explicit Relief(int size_px)
      : height_px(kOversampling * size_px, kOversampling * size_px),
        albedo(kOversampling * size_px, kOversampling * size_px) {}

  /// Points of the fine grid along a side.
  [[nodiscard]] int side() const noexcept { return height_px.width(); }
};

/// Picture coordinate (pixels, pixel i spans i .. i + 1) of a point of the fine grid, and back: the
/// first point of the grid at or beyond a coordinate.
[[nodiscard]] constexpr double grid_to_px(int index) noexcept {
  return (index + 0.5) / kOversampling;
}
[[nodiscard]] int px_to_grid(double coordinate_px) noexcept;

/// Fills the relief with surface(x_px, y_px), seen from the view.
template <typename Surface>
void fill(Relief& relief, const Surface& surface, const View& view = {}) {
  for (int y = 0; y < relief.side(); ++y) {
    for (int x = 0; x < relief.side(); ++x) {
      const Vec2 place = view.on_surface(grid_to_px(x), grid_to_px(y));
      const SurfacePoint point = surface(place.x, place.y);
      relief.height_px.at(y, x) = view.scale * view.relief * point.height_px;
      relief.albedo.at(y, x) = point.albedo;
    }
  }
}

struct Lamp {
  Vec3 towards = {-0.55, -0.6, 0.58};  ///< from the surface to the lamp, need not have length 1
  double ambient = 0.3;                ///< share of the light that comes from everywhere
  double shadow_reach_px = 40.0;       ///< longest shadow
  double shadow_blur_px = 1.5;         ///< depth below the shadow's edge at which it is full
  double hollow_px = 7.0;              ///< size of the hollows that the ambient light misses
  double least_open = 0.15;            ///< share of the ambient light that the deepest hollow gets
};

/// The lamp as it stands for a piece: turned by up to about half a radian, higher or lower.
[[nodiscard]] Lamp lamp_for(const Specimen& specimen, Lamp lamp);

/// The light that comes back to the viewer from a level surface of albedo 1.
[[nodiscard]] double light_on_level(const Lamp& lamp) noexcept;

/// The light that comes back to the viewer, on the fine grid, in units of the lamp.
[[nodiscard]] Plane<double> lit(const Relief& relief, const Lamp& lamp);

/// A plane averaged over squares of about 2 * radius + 1 points, three times over: close to a
/// Gaussian with a standard deviation of radius + 0.5. Edges repeat.
[[nodiscard]] Plane<double> blurred(const Plane<double>& plane, int radius);

/// Averages squares of the fine grid into pixels.
[[nodiscard]] Plane<double> averaged(const Plane<double>& fine);

/// The value below which a share of the samples lies; reorders them. \pre not empty
[[nodiscard]] double light_quantile(std::vector<double>& samples, double share);

/// How a picture is printed.
struct Print {
  double mean_grey = 120.0;
  double contrast = 1.0;  ///< 1: over all grey levels; less draws them towards the mean
};

/// Exposure and tone: stretches the light between its extremes (but for a few in a thousand) over
/// the print's range of grey levels, and bends it so that the mean is the print's.
/// \param counts  which pixels decide about exposure: those that are not 0; same shape as light
[[nodiscard]] GreyImage developed(const Plane<double>& light, const Print& print,
                                  const GreyImage& counts);
[[nodiscard]] GreyImage developed(const Plane<double>& light, const Print& print);

/// The print of a piece: some are darker or lighter, harder or softer than others.
[[nodiscard]] Print print_for(const Specimen& specimen, Print print);

/// Sets up the lamp for the piece, lights the relief and prints the picture as fits the piece.
[[nodiscard]] GreyImage photographed(const Specimen& specimen, const Relief& relief,
                                     const Lamp& lamp, const Print& print);

}  // namespace touchtrial::stimuli
