#include "engine/tv_gabor/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial {
namespace {

template <typename Real>
Plane<Real> texture_of(const TvGaborProblem<Real>& problem, const VectorField<Real>& multiplier,
                       double scale, RealFft<Real>& fft) {
  negative_divergence(multiplier, fft.plane());
  fft.forward();
  const auto factor =
      static_cast<Real>(scale / (problem.lambda * static_cast<double>(problem.image.size())));
  const auto spectrum = fft.spectrum();
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    spectrum[i] *= factor * problem.spectrum.samples()[i];
  }
  fft.inverse();
  Plane<Real> texture(problem.image.height(), problem.image.width());
  std::copy(fft.plane().begin(), fft.plane().end(), texture.samples().begin());
  return texture;
}

/// With q = -p and u = f - v, the primal value is the sum of |grad u| + <q, grad v> / 2, and primal
/// minus dual is the sum of |grad u| - <q, grad u>: no term is negative, so nothing cancels between
/// pixels and the gap keeps its digits.
template <typename Real>
double relative_gap(const TvGaborProblem<Real>& problem, const Plane<Real>& texture,
                    const VectorField<Real>& multiplier, double scale) {
  const std::size_t width = static_cast<std::size_t>(texture.width());
  std::vector<Real> f_x(width), f_y(width), v_x(width), v_y(width);
  double primal = 0.0;
  double difference = 0.0;
  for (int y = 0; y < texture.height(); ++y) {
    const int below = y + 1 == texture.height() ? 0 : y + 1;
    gradient_of_row<Real>(problem.image.row(y), problem.image.row(below), f_x, f_y);
    gradient_of_row<Real>(texture.row(y), texture.row(below), v_x, v_y);
    for (std::size_t x = 0; x < width; ++x) {
      const double q_x = scale * multiplier.x.row(y)[x];
      const double q_y = scale * multiplier.y.row(y)[x];
      const double u_x = f_x[x] - v_x[x];
      const double u_y = f_y[x] - v_y[x];
      const double steepness = std::sqrt(u_x * u_x + u_y * u_y);
      primal += steepness + 0.5 * (q_x * v_x[x] + q_y * v_y[x]);
      difference += std::max(0.0, steepness - (q_x * u_x + q_y * u_y));
    }
  }
  return primal > 0.0 ? difference / primal : 0.0;
}

}  // namespace

template <typename Real>
TvGaborCertificate<Real> certify(const TvGaborProblem<Real>& problem,
                                 const VectorField<Real>& multiplier, double scale,
                                 RealFft<Real>& fft) {
  TvGaborCertificate<Real> certificate;
  certificate.texture = texture_of(problem, multiplier, scale, fft);
  certificate.gap = relative_gap(problem, certificate.texture, multiplier, scale);
  return certificate;
}

template TvGaborCertificate<float> certify(const TvGaborProblem<float>&, const VectorField<float>&,
                                           double, RealFft<float>&);
template TvGaborCertificate<double> certify(const TvGaborProblem<double>&,
                                            const VectorField<double>&, double, RealFft<double>&);

}  // namespace touchtrial
