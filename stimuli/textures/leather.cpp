#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>

namespace touchtrial::stimuli {
namespace {

/// Grained leather: cushions of two sizes between creases, wrinkles where it was bent, pores.
class Leather {
 public:
  explicit Leather(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "leather/bend"),
        cushions_(specimen.noise_seed(), "leather/cushions"),
        grain_(specimen.noise_seed(), "leather/grain"),
        wrinkles_(specimen.noise_seed(), "leather/wrinkles"),
        pores_(specimen.noise_seed(), "leather/pores"),
        wrinkled_(2.6 * specimen.factor("leather/wrinkled", 0.6)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx =
        x + 4.5 * bend_.fractal(x / 26, y / 26, 2) + 30.0 * bend_.fractal(x / 170 + 5, y / 170, 2);
    const double wy = y + 4.5 * bend_.fractal(x / 26 + 70, y / 26, 2) +
                      30.0 * bend_.fractal(x / 170, y / 170 + 5, 2);
    const CellPlace cushion = cushions_.at(wx / 19.0, wy / 16.0);
    const CellPlace grain = grain_.at(wx / 7.3, wy / 6.7);
    const double groove = smooth_step(0.0, 0.22, cushion.to_border);
    const double round = 0.6 * groove + 0.4 * std::min(1.0, 1.6 * cushion.to_border);
    const double fine = smooth_step(0.0, 0.6, grain.to_border);
    const double wrinkle = wrinkles_.ridged(wx / 75, wy / 52, 3);
    const double crease = smooth_step(0.84, 0.98, wrinkle);
    const CellPlace pore = pores_.at(x / 11, y / 11);
    const double hole =
        pores_.value(pore.cell) < 0.3 ? smooth_step(0.12, 0.05, pore.to_centre) : 0.0;
    SurfacePoint point;
    point.height_px = 3.6 * round * mix(0.6, 1.0, cushions_.value(cushion.cell, 1)) + 0.45 * fine -
                      wrinkled_ * crease - 1.6 * hole +
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
  double wrinkled_;  ///< depth of the wrinkles, pixels
};

}  // namespace

GreyImage make_leather(const Specimen& specimen, int size_px) {
  Relief relief(size_px);
  fill(relief, Leather(specimen), view_of(specimen, {0.22, 0.4, 0.25}));
  const Lamp lamp{{-0.6, -0.55, 0.9}, 0.4, 16.0, 3.0, 8.0};
  return photographed(specimen, relief, lamp, {116.0});
}

}  // namespace touchtrial::stimuli
