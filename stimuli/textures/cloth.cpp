#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

/// The warp or weft thread at a point.
struct ThreadPosition {
  std::int64_t number = 0;  ///< index of the thread
  double across = 0.0;      ///< -1 .. 1 from one side of its lane to the other
  double thickness = 1.0;   ///< of the thread here, relative to its lane
  double tone = 0.0;        ///< lightness of the thread here, about -1 .. 1
};

/// Parallel threads of different thickness, slightly bent.
class Threads {
 public:
  Threads(std::uint64_t seed, std::string_view purpose, double pitch_px)
      : traits_(seed, std::string(purpose) + "/traits"),
        wander_(seed, std::string(purpose) + "/wander"),
        pitch_px_(pitch_px) {}

  /// \param across,along  position in pixels, across and along the threads
  [[nodiscard]] ThreadPosition at(double across, double along) const {
    const double drift = 0.5 * wander_.fractal(across / 130, along / 130, 2);
    double lane = across / pitch_px_ + drift;
    // The wobble depends on the lane's number, so that it is constant across a thread.
    const double number = std::floor(lane);
    lane += 0.26 * wander_.fractal(number * 7.31, along / 42, 2);
    ThreadPosition position;
    position.number = static_cast<std::int64_t>(std::floor(lane));
    const auto n = static_cast<double>(position.number);
    position.across = 2.0 * (lane - n) - 1.0;
    const double slub = std::max(0.0, wander_.at(n * 3.7 + 50, along / 55) - 0.25);
    position.thickness = 0.80 + 0.22 * traits_.value(traits_.hash(position.number, 1)) +
                         0.45 * slub + 0.07 * wander_.at(n * 5.3, along / 9);
    position.tone = 2.0 * traits_.value(traits_.hash(position.number, 2)) - 1.0 +
                    0.8 * wander_.fractal(n * 9.1 + 20, along / 30, 3);
    return position;
  }

 private:
  Lattice traits_;
  Noise wander_;
  double pitch_px_;
};

/// Height of a woven thread, with a round cross-section.
double thread_height(const ThreadPosition& position, double lift) {
  const double u = position.across / position.thickness;
  const double round = u * u < 1.0 ? std::sqrt(1.0 - u * u) : -1.2;
  return 1.25 * round * position.thickness + 1.1 * lift;
}

class Cloth {
 public:
  explicit Cloth(const Specimen& specimen)
      : warp_(specimen.noise_seed(), "cloth/warp", 6.6 * specimen.factor("cloth/warp", 0.12)),
        weft_(specimen.noise_seed(), "cloth/weft", 7.3 * specimen.factor("cloth/weft", 0.12)),
        fibres_(specimen.noise_seed(), "cloth/fibres"),
        folds_(specimen.noise_seed(), "cloth/folds"),
        fold_height_(21.0 * specimen.factor("cloth/rumple", 0.6)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const double shear = 9.0 * folds_.fractal(x / 220, y / 220, 2);
    const ThreadPosition warp = warp_.at(x + shear, y);
    const ThreadPosition weft = weft_.at(y + 0.8 * shear + 0.03 * x, x);
    const double lift = warp_lift(warp, weft);
    const double warp_height = thread_height(warp, lift);
    const double weft_height = thread_height(weft, -lift);
    SurfacePoint point = warp_height > weft_height ? yarn_point(warp, warp_height, y)
                                                   : yarn_point(weft, weft_height, x);
    const double hair = fibres_.fractal(x / 2.1, y / 2.1, 2);
    point.height_px += 0.35 * hair + fold_height_ * folds_.fractal(x / 120, y / 150, 2);
    point.albedo += 0.05 * hair + 0.12 * folds_.fractal(x / 70 + 9, y / 70, 3);
    return point;
  }

 private:
  static constexpr double kGapHeight = -1.7;

  /// Plain weave: the warp is alternately over (1) and under (-1) the weft.
  static double warp_lift(const ThreadPosition& warp, const ThreadPosition& weft) {
    const double sign = ((warp.number + weft.number) & 1) == 1 ? 1.0 : -1.0;
    return sign * (1.0 - 0.55 * weft.across * weft.across) *
           (1.0 - 0.55 * warp.across * warp.across);
  }

  /// The upper thread at a point. It is twisted, so its fibres are oblique. Gaps are dark.
  [[nodiscard]] SurfacePoint yarn_point(const ThreadPosition& position, double height,
                                        double along) const {
    const double twist =
        fibres_.ridged((along + 4.0 * position.across) / 4.2,
                       static_cast<double>(position.number) * 3.3 + position.across, 2);
    const double albedo = 0.52 + 0.07 * position.tone + 0.10 * twist;
    const bool is_gap = height < kGapHeight + 0.5;
    return {std::max(height, kGapHeight) + 0.45 * twist, is_gap ? 0.75 * albedo : albedo};
  }

  Threads warp_;
  Threads weft_;
  Noise fibres_;
  Noise folds_;
  double fold_height_;  ///< height of the folds, pixels
};

}  // namespace

GreyImage make_cloth(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.5, -0.62, 0.8}, 0.42, 14.0, 2.0, 5.0};
  return draw_surface(specimen, size_px, Cloth(specimen), view_of(specimen, {0.15, 0.3, 0.2}), lamp,
                      {126.0, 0.75});
}

}  // namespace touchtrial::stimuli
