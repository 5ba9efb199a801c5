/// \file An object on a plain ground, photographed from above.
#pragma once

#include "stimuli/relief.hpp"

namespace touchtrial::stimuli {

/// One point of an object; `covers` is false where the ground shows.
struct ObjectPoint {
  bool covers = false;
  SurfacePoint surface;
};

/// Objects are described on a square of this many units, whatever the size of the picture.
inline constexpr double kObjectUnits = 500.0;

/// An object on its ground, on the fine grid.
struct StillLife {
  Relief relief;
  Plane<double> covered;  ///< 1 where the object is, 0 where the ground is
};

/// Lights the scene and develops it for the object's sake; the ground is as light as the object's
/// lighter parts.
/// \param print  its mean is that of the object
[[nodiscard]] GreyImage photographed(const Specimen& specimen, const StillLife& scene, Lamp lamp,
                                     const Print& print);

/// How a further piece lies: turned a little about the middle, and not larger than the first.
[[nodiscard]] View object_view(const Specimen& specimen);

/// Lays an object on a flat, even ground.
/// \param object  object(x, y) with x and y in 0 .. kObjectUnits; heights in the same units
template <typename Object>
[[nodiscard]] StillLife laid_out(const Object& object, int size_px, const View& view = {}) {
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

}  // namespace touchtrial::stimuli
