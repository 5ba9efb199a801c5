/// \file The certificate of any dual point of TV-Gabor, by the engine's own measure of the gap.
#pragma once

#include "core/plane.hpp"
#include "engine/tv_gabor/solver.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial::reference {

template <typename Real>
struct TvGaborCertificate {
  Plane<Real> texture;  ///< v = M div p / lambda on the torus, grey levels
  double gap = 0.0;     ///< (primal - dual) / primal
};

/// \param field,scale  the dual point: p = -scale * field, its vectors shortened to 1 if longer
template <typename Real>
[[nodiscard]] TvGaborCertificate<Real> certificate_of(const engine::TvGaborProblem<Real>& problem,
                                                      const engine::VectorField<Real>& field,
                                                      double scale) {
  const int height = problem.image.height();
  const int width = problem.image.width();
  engine::TorusPlane<Real> plane(height, width, 1);
  plane.in_blocks([&](const engine::RowBlock& block) {
    typename engine::TorusPlane<Real>::DivergenceRows q(plane, block);
    for (int y = block.begin; y < block.end; ++y) {
      engine::row_kernels<Real>().clip(field.x.row(y).data(), field.y.row(y).data(),
                                       static_cast<std::size_t>(width), static_cast<Real>(scale),
                                       q.along_x(), q.along_y());
      q.next();
    }
  });
  plane.finish_divergence();
  TvGaborCertificate<Real> certificate;
  certificate.gap = engine::certified_gap(problem, field, scale, plane, 1.0);
  certificate.texture = Plane<Real>(height, width);
  plane.in_blocks([&](const engine::RowBlock& block) {
    typename engine::TorusPlane<Real>::Rows v(plane, block, static_cast<Real>(1 / problem.lambda));
    for (int y = block.begin; y < block.end; ++y) {
      v.go_to(y);
      std::copy_n(v.row(), width, certificate.texture.row(y).data());
    }
  });
  return certificate;
}

/// The part of a torus plane that belongs to an image of the given shape.
template <typename Real>
[[nodiscard]] Plane<Real> cropped_from_torus(const Plane<Real>& torus, int height, int width) {
  Plane<Real> image(height, width);
  for (int y = 0; y < height; ++y) {
    const auto from = torus.row(y + engine::kTorusMargin).subspan(engine::kTorusMargin, width);
    std::copy(from.begin(), from.end(), image.row(y).begin());
  }
  return image;
}

}  // namespace touchtrial::reference
