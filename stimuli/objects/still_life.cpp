#include "stimuli/objects/still_life.hpp"

#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

/// Lightness of the ground among the lightnesses of the object.
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
