/// \file TV-Gabor by accelerated projected gradient (FISTA) on the dual, with M applied as a direct
/// convolution: it has no Fourier transform and no ADMM, and shares nothing with the product's
/// code.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

#include <vector>

namespace touchtrial::reference {

/// A vector at each place of the torus.
struct Dual {
  Plane<double> x;
  Plane<double> y;
};

/// J(u) + (lambda / 2) <f - u, K (f - u)> and its dual, by definition.
class TvGabor {
 public:
  TvGabor(const GreyImage& image, const engine::TvGaborOptions& options);

  [[nodiscard]] const Plane<double>& torus() const { return f_; }
  [[nodiscard]] Plane<double> apply_m(const Plane<double>& plane) const;
  /// M div p / lambda, on the torus.
  [[nodiscard]] Plane<double> texture(const Dual& p) const;
  [[nodiscard]] double primal(const Dual& p) const;
  [[nodiscard]] double dual(const Dual& p) const;

  [[nodiscard]] Dual fista(int steps) const;
  /// p <- (p + w / 8) / (1 + |w| / 8)
  [[nodiscard]] Dual fixed_point(int steps) const;
  [[nodiscard]] Plane<double> cropped(const Plane<double>& torus) const;

 private:
  /// w = grad(M div p - lambda f)
  [[nodiscard]] Dual ascent(const Dual& p) const;

  int height_, width_;  // of the image
  double lambda_;
  Plane<double> f_;
  Plane<double> kernel_;  // of M, 21 x 21, centre at (10, 10)
};

}  // namespace touchtrial::reference
