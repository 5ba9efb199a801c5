#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

namespace touchtrial {
namespace {

/// Tall plates with deep furrows between them, cracked across, with fibres along.
class Bark {
 public:
  explicit Bark(std::uint64_t seed)
      : bend_(seed, "bark/bend"),
        plates_(seed, "bark/plates"),
        scales_(seed, "bark/scales"),
        fibres_(seed, "bark/fibres"),
        grain_(seed, "bark/grain") {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double wx = x + 20.0 * bend_.fractal(x / 70, y / 120, 3) + 5.0 * bend_.at(x / 13, y / 22);
    // The plates' ends are shifted from one column to the next, or they would form rows.
    const double wy = y + 150.0 * bend_.fractal(wx / 48 + 9, y / 400 + 5, 2);
    const CellPlace plate = plates_.at(wx / 36, wy / 165);
    const CellPlace scale = scales_.at(wx / 17 + 3.1 * plates_.value(plate.cell), wy / 42);
    const double top = smooth_step(0.02, 0.42, plate.to_border);
    const double crack = smooth_step(0.0, 0.16, scale.to_border);
    const double fibre = fibres_.ridged(wx / 5.5, wy / 45, 3);
    const double grain = grain_.fractal(x / 3.2, y / 5.0, 3);
    SurfacePoint point;
    point.height_px = 17.0 * top * mix(0.7, 1.0, plates_.value(plate.cell, 1)) +
                      top * (3.6 * crack * mix(0.4, 1.0, scales_.value(scale.cell, 2))) +
                      3.4 * fibre + 1.0 * grain + 2.5 * bend_.fractal(x / 25, y / 60, 2);
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
};

}  // namespace

GreyImage make_bark(std::uint64_t seed, int size_px) {
  Relief relief(size_px);
  fill(relief, Bark(seed));
  const Lamp lamp{{-0.75, -0.35, 0.62}, 0.32, 30.0, 3.0, 9.0};
  return developed(averaged(lit(relief, lamp)), 122.0);
}

}  // namespace touchtrial
