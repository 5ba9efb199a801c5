#include "engine/reference/tv_gabor_fixed_point.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <cmath>
#include <cstddef>
#include <span>

namespace touchtrial::reference {
namespace {

/// out = -div field.
/// \param out  height x width samples, row-major
void negative_divergence(const engine::VectorField<float>& field, std::span<float> out) noexcept {
  const int height = field.x.height();
  for (int y = 0; y < height; ++y) {
    const auto x = field.x.row(y), here = field.y.row(y);
    const auto above = field.y.row(y == 0 ? height - 1 : y - 1);
    float* const row = out.data() + static_cast<std::size_t>(y) * x.size();
    row[0] = (x.back() - x[0]) + (above[0] - here[0]);
    for (std::size_t i = 1; i < x.size(); ++i) row[i] = (x[i - 1] - x[i]) + (above[i] - here[i]);
  }
}

/// p <- (p + tau w) / (1 + tau |w|), with tau = 1/8 and w = grad(M div p - lambda f), from p = 0.
class FixedPoint {
 public:
  FixedPoint(const GreyImage& image, const engine::TvGaborOptions& options)
      : image_(engine::extended_to_torus<float>(image)),
        lambda_(static_cast<float>(options.lambda)),
        spectrum_(converted<float>(
            engine::gabor_spectrum(options.components, image_.height(), image_.width()))),
        fft_(image_.height(), image_.width()),
        q_(image_.height(), image_.width()) {}

  void take_step() {
    apply_m();
    const auto plane = fft_.plane();
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] -= lambda_ * image_.samples()[i];
    // Steps of the projected gradient up to this length converge: |grad M div| <= 8.
    constexpr float kTau = 0.125F;
    const auto width = static_cast<std::size_t>(image_.width());
    const int height = image_.height();
    for (int y = 0; y < height; ++y) {
      const float* const here = plane.data() + static_cast<std::size_t>(y) * width;
      const float* const below = plane.data() + static_cast<std::size_t>((y + 1) % height) * width;
      const auto q_x = q_.x.row(y), q_y = q_.y.row(y);
      for (std::size_t x = 0; x < width; ++x) {
        const float w_x = here[(x + 1) % width] - here[x];
        const float w_y = below[x] - here[x];
        const float share = 1.0F / (1.0F + kTau * std::sqrt(w_x * w_x + w_y * w_y));
        q_x[x] = share * (q_x[x] - kTau * w_x);
        q_y[x] = share * (q_y[x] - kTau * w_y);
      }
    }
  }

  [[nodiscard]] Plane<float> texture(int height, int width) {
    apply_m();
    Plane<float> v(height, width);
    for (int y = 0; y < height; ++y) {
      const auto row = static_cast<std::size_t>(y + engine::kTorusMargin) * image_.width();
      for (int x = 0; x < width; ++x) {
        v.at(y, x) = fft_.plane()[row + engine::kTorusMargin + x] / lambda_;
      }
    }
    return v;
  }

 private:
  /// Leaves M div p in the transform's plane.
  void apply_m() {
    negative_divergence(q_, fft_.plane());
    fft_.forward();
    const auto spectrum = fft_.spectrum();
    const float scale = 1.0F / static_cast<float>(image_.size());
    for (std::size_t i = 0; i < spectrum.size(); ++i) {
      spectrum[i] *= scale * spectrum_.samples()[i];
    }
    fft_.inverse();
  }

  Plane<float> image_;
  float lambda_;
  Plane<float> spectrum_;
  engine::RealFft<float> fft_;
  engine::VectorField<float> q_;  ///< -p, with vectors of length at most 1
};

}  // namespace

Plane<float> tv_gabor_fixed_point(const GreyImage& image, const engine::TvGaborOptions& options,
                                  int steps) {
  FixedPoint solver(image, options);
  for (int step = 0; step < steps; ++step) solver.take_step();
  return solver.texture(image.height(), image.width());
}

}  // namespace touchtrial::reference
