/// \file Renders a height map as a photograph: one lamp, shadows, dark hollows, development; also
///   an object on a plain ground.
#pragma once

#include "core/plane.hpp"
#include "core/vec.hpp"
#include "stimuli/specimen.hpp"

#include <vector>

namespace touchtrial::stimuli {

/// Reliefs are computed on a grid this many times finer than the picture and then averaged, as in a
/// camera's sensor.
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

/// The picture coordinate of a point of the fine grid, pixels; pixel i spans i .. i + 1.
[[nodiscard]] constexpr double grid_to_px(int index) noexcept {
  return (index + 0.5) / kOversampling;
}
/// The first point of the fine grid at or beyond a picture coordinate.
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
  Vec3 towards = {-0.55, -0.6, 0.58};  ///< from the surface to the lamp, of any length
  double ambient = 0.3;                ///< share of the light that comes from all sides
  double shadow_reach_px = 40.0;       ///< length of the longest shadow
  double shadow_blur_px = 1.5;         ///< depth below the shadow's edge at which it is full
  double hollow_px = 7.0;              ///< size of the hollows that the ambient light misses
  double min_ambient = 0.15;           ///< share of the ambient light that the deepest hollow gets
};

/// The lamp of a specimen: turned by up to about half a radian, and higher or lower.
[[nodiscard]] Lamp lamp_for(const Specimen& specimen, Lamp lamp);

/// The light that a level surface of albedo 1 returns to the viewer.
[[nodiscard]] double light_on_level(const Lamp& lamp) noexcept;

/// The light that returns to the viewer, on the fine grid, in units of the lamp.
[[nodiscard]] Plane<double> lit(const Relief& relief, const Lamp& lamp);

/// A plane averaged three times over squares of 2 * radius + 1 points: close to a Gaussian with a
/// standard deviation of radius + 0.5. Edges repeat.
[[nodiscard]] Plane<double> blurred(const Plane<double>& plane, int radius);

/// Averages squares of the fine grid into pixels.
[[nodiscard]] Plane<double> averaged(const Plane<double>& fine);

/// The value below which a share of the samples lies. Reorders the samples.
/// \pre there is a sample
[[nodiscard]] double light_quantile(std::vector<double>& samples, double share);

/// How a picture is printed.
struct Print {
  double mean_grey = 120.0;
  double contrast = 1.0;  ///< 1: uses all grey levels; less brings them nearer to the mean
};

/// Exposure and tone: stretches the light between its extremes (except for a few in a thousand)
/// over the print's range of grey levels, and bends it so that the mean is the print's.
/// \param counts  of the light's shape; pixels that are not 0 decide the exposure
[[nodiscard]] GreyImage developed(const Plane<double>& light, const Print& print,
                                  const GreyImage& counts);
[[nodiscard]] GreyImage developed(const Plane<double>& light, const Print& print);

/// The print of a specimen: darker or lighter, of higher or lower contrast than others.
[[nodiscard]] Print print_for(const Specimen& specimen, Print print);

/// Lights the relief by the specimen's lamp, and prints it by the specimen's print.
[[nodiscard]] GreyImage photographed(const Specimen& specimen, const Relief& relief,
                                     const Lamp& lamp, const Print& print);

/// A picture that a surface fills.
/// \param surface  surface(x_px, y_px) gives a SurfacePoint
template <typename Surface>
[[nodiscard]] GreyImage surface_picture(const Specimen& specimen, int size_px,
                                        const Surface& surface, const View& view, const Lamp& lamp,
                                        const Print& print) {
  Relief relief(size_px);
  fill(relief, surface, view);
  return photographed(specimen, relief, lamp, print);
}

/// One point of a picture of an object.
struct ObjectPoint {
  bool covers = false;  ///< false where the ground shows
  SurfacePoint surface;
};

/// Recipes describe objects on a square of this many units, for a picture of any size.
inline constexpr double kObjectUnits = 500.0;

/// An object on its ground, on the fine grid.
struct StillLife {
  Relief relief;
  Plane<double> covered;  ///< 1 where the object is, 0 where the ground is
};

/// Lights the scene and develops it with the object's exposure; the ground is as light as the
/// object's lighter parts.
/// \param print  its mean grey is that of the object
[[nodiscard]] GreyImage photographed(const Specimen& specimen, const StillLife& scene, Lamp lamp,
                                     const Print& print);

/// The view of a further specimen of an object: turned a little about the middle, and not larger
/// than the first.
[[nodiscard]] View object_view(const Specimen& specimen);

/// Lays an object on a flat, even ground.
/// \param object  object(x, y) with x and y in 0 .. kObjectUnits; heights in the same units
template <typename Object>
[[nodiscard]] StillLife placed_object(const Object& object, int size_px, const View& view) {
  const double scale = size_px / kObjectUnits;
  StillLife scene{Relief(size_px), Plane<double>(kOversampling * size_px, kOversampling * size_px)};
  for (int y = 0; y < scene.relief.side(); ++y) {
    for (int x = 0; x < scene.relief.side(); ++x) {
      const Vec2 place = view.on_surface(grid_to_px(x) / scale, grid_to_px(y) / scale);
      const ObjectPoint point = object(place.x, place.y);
      const double height = scale * view.scale * view.relief * point.surface.height_px;
      scene.relief.height_px.at(y, x) = point.covers ? height : 0.0;
      scene.relief.albedo.at(y, x) = point.covers ? point.surface.albedo : 1.0;
      scene.covered.at(y, x) = point.covers ? 1.0 : 0.0;
    }
  }
  return scene;
}

/// A picture of an object on the ground.
/// \param object  as in placed_object
template <typename Object>
[[nodiscard]] GreyImage object_picture(const Specimen& specimen, int size_px, const Object& object,
                                       const Lamp& lamp, const Print& print) {
  return photographed(specimen, placed_object(object, size_px, object_view(specimen)), lamp, print);
}

}  // namespace touchtrial::stimuli
