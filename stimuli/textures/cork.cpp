#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>

namespace touchtrial::stimuli {
namespace {

/// A sheet of pressed cork: granules of many sizes and shades, some torn out, dark flecks of bark.
class Cork {
 public:
  explicit Cork(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "cork/bend"),
        granules_(specimen.noise_seed(), "cork/granules"),
        crumbs_(specimen.noise_seed(), "cork/crumbs"),
        flecks_(specimen.noise_seed(), "cork/flecks"),
        torn_(0.10 * specimen.factor("cork/torn", 0.7)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx = x + 7.0 * bend_.fractal(x / 16, y / 16, 3);
    const double wy = y + 7.0 * bend_.fractal(x / 16 + 60, y / 16, 3);
    const CellPlace large = granules_.at(wx / 30, wy / 23);
    // Between large granules lie crumbs; some cells are nothing but crumbs.
    const bool crumbled = granules_.value(large.cell) < 0.35;
    const CellPlace small = crumbs_.at(wx / 10.5 + 4.0 * granules_.value(large.cell, 2), wy / 9.5);
    const double own = crumbled ? crumbs_.value(small.cell) : granules_.value(large.cell, 1);
    const double border =
        crumbled ? std::min(0.4 * small.to_border, large.to_border) : large.to_border;
    const double joint = smooth_step(0.13, 0.0, border);
    const bool missing =
        (crumbled ? crumbs_.value(small.cell, 1) : granules_.value(large.cell, 3)) < torn_;
    const double hole = missing ? smooth_step(0.02, 0.14, border) : 0.0;
    const double pith = bend_.fractal(wx / 3.1, wy / 3.1, 3);
    const CellPlace fleck = flecks_.at(wx / 19 + 30, wy / 8.5);
    const double bark =
        flecks_.value(fleck.cell) < 0.16 ? smooth_step(0.36, 0.18, fleck.to_centre) : 0.0;
    SurfacePoint point;
    point.height_px = 2.0 * (own - 0.5) - 1.2 * joint - 3.4 * hole + 1.1 * pith - 0.8 * bark +
                      0.8 * bend_.at(x / 1.9, y / 1.9) + 1.5 * bend_.fractal(x / 60 + 8, y / 60, 2);
    point.albedo = std::clamp(0.46 + 0.20 * own + 0.17 * pith - 0.07 * joint - 0.10 * hole -
                                  0.24 * bark + 0.05 * bend_.at(x / 1.6 + 9, y / 1.6),
                              0.06, 1.0);
    return point;
  }

 private:
  Noise bend_;
  Cells granules_;
  Cells crumbs_;
  Cells flecks_;
  double torn_;  ///< share of the granules that are missing
};

}  // namespace

GreyImage make_cork(const Specimen& specimen, int size_px) {
  Relief relief(size_px);
  fill(relief, Cork(specimen), view_of(specimen, {0.25, 0.4, 0.2}));
  const Lamp lamp{{-0.55, -0.6, 0.75}, 0.4, 12.0, 2.0, 6.0};
  return photographed(specimen, relief, lamp, {124.0});
}

}  // namespace touchtrial::stimuli
