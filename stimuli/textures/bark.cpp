#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

namespace touchtrial::stimuli {
namespace {

/// Tall plates with deep furrows in between, transverse cracks and longitudinal fibres.
class Bark {
 public:
  explicit Bark(const Specimen& specimen)
      : bend_(specimen.noise_seed(), "bark/bend"),
        plates_(specimen.noise_seed(), "bark/plates"),
        scales_(specimen.noise_seed(), "bark/scales"),
        fibres_(specimen.noise_seed(), "bark/fibres"),
        grain_(specimen.noise_seed(), "bark/grain"),
        width_(36.0 * specimen.factor("bark/width", 0.25)),
        furrow_(0.42 * specimen.factor("bark/furrow", 0.3)),
        depth_(17.0 * specimen.factor("bark/depth", 0.25)),
        roughness_(specimen.factor("bark/roughness", 0.35)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx = x + 20.0 * bend_.fractal(x / 70, y / 120, 3) + 5.0 * bend_.at(x / 13, y / 22);
    // The ends of the plates shift from one column to the next, so that they do not form rows.
    const double wy = y + 150.0 * bend_.fractal(wx / 48 + 9, y / 400 + 5, 2);
    const CellPosition plate = plates_.at(wx / width_, wy / 165);
    const CellPosition scale = scales_.at(wx / 17 + 3.1 * plates_.value(plate.cell), wy / 42);
    const double top = smooth_step(0.02, furrow_, plate.to_border);
    const double crack = smooth_step(0.0, 0.16, scale.to_border);
    const double fibre = fibres_.ridged(wx / 5.5, wy / 45, 3);
    const double grain = grain_.fractal(x / 3.2, y / 5.0, 3);
    SurfacePoint point;
    point.height_px = depth_ * top * mix(0.7, 1.0, plates_.value(plate.cell, 1)) +
                      top * (3.6 * crack * mix(0.4, 1.0, scales_.value(scale.cell, 2))) +
                      3.4 * roughness_ * fibre + 1.0 * grain +
                      2.5 * bend_.fractal(x / 25, y / 60, 2);
    point.albedo = 0.42 + 0.18 * top + 0.1 * scales_.value(scale.cell, 3) + 0.10 * fibre +
                   0.12 * grain + 0.10 * bend_.fractal(x / 40 + 3, y / 90, 3);
    return point;
  }

 private:
  Noise bend_;
  Cells plates_;
  Cells scales_;
  Noise fibres_;
  Noise grain_;
  double width_;   ///< of a plate, pixels
  double furrow_;  ///< share of a plate that slopes towards the furrow
  double depth_;   ///< of the furrows, pixels
  double roughness_;
};

}  // namespace

GreyImage make_bark(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.75, -0.35, 0.62}, 0.32, 30.0, 3.0, 9.0};
  return draw_surface(specimen, size_px, Bark(specimen), view_of(specimen), lamp, {122.0, 0.84});
}

}  // namespace touchtrial::stimuli
