/// \file Renders a height map as a photograph, with one lamp, shadows, dark hollows and exposure;
/// also an object on a plain ground.
#pragma once

#include "core/plane.hpp"
#include "core/vec.hpp"
#include "stimuli/specimen.hpp"

#include <vector>

namespace touchtrial::stimuli {

/// Reliefs are computed on a grid this many times finer than the picture, then averaged.
inline constexpr int kOversampling = 2;

/// One point of a surface.
struct SurfacePoint {
  double height_px = 0.0;  ///< towards the viewer, in pixels of the picture
  double albedo = 0.5;     ///< share of the light that the material reflects, 0 .. 1
};

/// A surface seen from above, on the fine grid.
struct Relief {
  Plane<double> height_px;
  Plane<double> albedo;

  explicit Relief(int size_px)
      : height_px(kOversampling * size_px, kOversampling * size_px),
        albedo(kOversampling * size_px, kOversampling * size_px) {}

  /// Number of fine grid points along a side.
  [[nodiscard]] int side() const noexcept { return height_px.width(); }
};

/// The picture coordinate of a point of the fine grid, pixels; pixel i spans i .. i + 1.
[[nodiscard]] constexpr double grid_to_px(int index) noexcept {
  return (index + 0.5) / kOversampling;
}
/// The first fine grid point at or after a picture coordinate.
[[nodiscard]] int px_to_grid(double coordinate_px) noexcept;

/// Fills the relief with surface(x_px, y_px) as seen in the view.
template <typename Surface>
void fill(Relief& relief, const Surface& surface, const View& view = {}) {
  for (int y = 0; y < relief.side(); ++y) {
    for (int x = 0; x < relief.side(); ++x) {
      const Vec2 position = view.surface_position(grid_to_px(x), grid_to_px(y));
      const SurfacePoint point = surface(position.x, position.y);
      relief.height_px.at(y, x) = view.scale * view.relief * point.height_px;
      relief.albedo.at(y, x) = point.albedo;
    }
  }
}

struct Lamp {
  Vec3 direction = {-0.55, -0.6, 0.58};  ///< from the surface to the lamp, of any length
  double ambient = 0.3;                  ///< share of ambient light
  double shadow_reach_px = 40.0;         ///< length of the longest shadow
  double shadow_blur_px = 1.5;           ///< depth below the shadow's edge at which shadow is full
  double hollow_px = 7.0;                ///< size of the hollows that ambient light does not reach
  double min_ambient = 0.15;             ///< share of ambient light in the deepest hollow
};

/// The lamp varied for a specimen: turned by up to about half a radian, and raised or lowered.
[[nodiscard]] Lamp lamp_for(const Specimen& specimen, Lamp lamp);

/// The light that a level surface of albedo 1 reflects to the viewer.
[[nodiscard]] double light_on_level(const Lamp& lamp) noexcept;

/// The light reflected to the viewer, on the fine grid, in units of the lamp.
[[nodiscard]] Plane<double> render_light(const Relief& relief, const Lamp& lamp);

/// Averages a plane three times over squares of 2 * radius + 1 points, close to a Gaussian with a
/// standard deviation of radius + 0.5. Edges are repeated.
[[nodiscard]] Plane<double> blur(const Plane<double>& plane, int radius);

/// Averages squares of the fine grid into pixels.
[[nodiscard]] Plane<double> average_to_pixels(const Plane<double>& fine);

/// A quantile of the samples. Reorders the samples.
/// \pre samples is not empty
[[nodiscard]] double light_quantile(std::vector<double>& samples, double share);

/// The tone range of a picture.
struct Print {
  double mean_grey = 120.0;
  double contrast = 1.0;  ///< 1: all grey levels; lower values compress them towards the mean
};

/// Applies exposure and tone: stretches the light between its 0.2 % and 99.8 % quantiles over the
/// print's range of grey levels, with a tone curve that gives the print's mean.
/// \param mask  of the light's shape; pixels that are not 0 determine the exposure
[[nodiscard]] GreyImage develop(const Plane<double>& light, const Print& print,
                                const GreyImage& mask);
[[nodiscard]] GreyImage develop(const Plane<double>& light, const Print& print);

/// The print varied for a specimen in brightness and contrast.
[[nodiscard]] Print print_for(const Specimen& specimen, Print print);

/// Renders the relief with the specimen's lamp and print.
[[nodiscard]] GreyImage photograph(const Specimen& specimen, const Relief& relief, const Lamp& lamp,
                                   const Print& print);

/// Draws a picture filled by a surface.
/// \param surface  surface(x_px, y_px) returns a SurfacePoint
template <typename Surface>
[[nodiscard]] GreyImage draw_surface(const Specimen& specimen, int size_px, const Surface& surface,
                                     const View& view, const Lamp& lamp, const Print& print) {
  Relief relief(size_px);
  fill(relief, surface, view);
  return photograph(specimen, relief, lamp, print);
}

/// One point of a picture of an object.
struct ObjectPoint {
  bool is_object = false;  ///< false on the ground
  SurfacePoint surface;
};

/// The side of the square on which recipes describe objects, for pictures of any size.
inline constexpr double kObjectUnits = 500.0;

/// An object on its ground, on the fine grid.
struct StillLife {
  Relief relief;
  Plane<double> coverage;  ///< 1 where the object is, 0 where the ground is
};

/// Renders the scene with the exposure of the object; the ground is as light as the object's
/// lighter parts.
/// \param print  its mean grey applies to the object
[[nodiscard]] GreyImage photograph(const Specimen& specimen, const StillLife& scene, Lamp lamp,
                                   const Print& print);

/// The view of a specimen of an object: slightly rotated about the middle, and not larger than
/// exemplar 1.
[[nodiscard]] View object_view(const Specimen& specimen);

/// Places an object on a flat, uniform ground.
/// \param object  object(x, y) with x and y in 0 .. kObjectUnits; heights in the same units
template <typename Object>
[[nodiscard]] StillLife place_object(const Object& object, int size_px, const View& view) {
  const double scale = size_px / kObjectUnits;
  StillLife scene{Relief(size_px), Plane<double>(kOversampling * size_px, kOversampling * size_px)};
  for (int y = 0; y < scene.relief.side(); ++y) {
    for (int x = 0; x < scene.relief.side(); ++x) {
      const Vec2 position = view.surface_position(grid_to_px(x) / scale, grid_to_px(y) / scale);
      const ObjectPoint point = object(position.x, position.y);
      const double height = scale * view.scale * view.relief * point.surface.height_px;
      scene.relief.height_px.at(y, x) = point.is_object ? height : 0.0;
      scene.relief.albedo.at(y, x) = point.is_object ? point.surface.albedo : 1.0;
      scene.coverage.at(y, x) = point.is_object ? 1.0 : 0.0;
    }
  }
  return scene;
}

/// Draws a picture of an object on the ground.
/// \param object  as in place_object()
template <typename Object>
[[nodiscard]] GreyImage draw_object(const Specimen& specimen, int size_px, const Object& object,
                                    const Lamp& lamp, const Print& print) {
  return photograph(specimen, place_object(object, size_px, object_view(specimen)), lamp, print);
}

}  // namespace touchtrial::stimuli
