#include "core/random.hpp"
#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial {
namespace {

engine::TvGaborProblem<double> problem_of(const GreyImage& image,
                                          const engine::TvGaborOptions& options) {
  const Plane<double> torus = engine::extended_to_torus<double>(image);
  const Plane<double> spectrum =
      engine::gabor_spectrum(options.components, torus.height(), torus.width());
  return {torus, engine::arranged_factors<double>(spectrum, torus.width()), options.lambda};
}

engine::VectorField<double> random_multiplier(int height, int width) {
  engine::VectorField<double> multiplier(height, width);
  RandomStream random(7, "multiplier");
  for (std::size_t i = 0; i < multiplier.x.size(); ++i) {
    multiplier.x.samples()[i] = random.uniform(-0.7, 0.7);
    multiplier.y.samples()[i] = random.uniform(-0.7, 0.7);
  }
  return multiplier;
}

Plane<double> scaled(const Plane<double>& plane, double factor) {
  Plane<double> result = plane;
  for (double& sample : result.samples()) sample *= factor;
  return result;
}

struct Certificate {
  Plane<double> texture;  ///< v = M div p / lambda on the torus, grey levels
  double gap = 0.0;       ///< (primal - dual) / primal
};

/// By the engine's own measure of the gap.
/// \param field,scale  the dual point: p = -scale * field, its vectors shortened to 1 if longer
Certificate certificate_of(const engine::TvGaborProblem<double>& problem,
                           const engine::VectorField<double>& field, double scale) {
  const int height = problem.image.height();
  const int width = problem.image.width();
  engine::TorusPlane<double> plane(height, width, 1);
  plane.for_each_block([&](const engine::RowBlock& block) {
    engine::TorusPlane<double>::DivergenceRows q(plane, block);
    for (int y = block.begin; y < block.end; ++y) {
      engine::row_kernels<double>().clip(field.x.row(y).data(), field.y.row(y).data(),
                                         static_cast<std::size_t>(width), scale, q.along_x(),
                                         q.along_y());
      q.next();
    }
  });
  plane.finish_divergence();
  Certificate certificate{Plane<double>(height, width),
                          engine::certified_gap(problem, field, scale, plane, 1.0)};
  plane.for_each_block([&](const engine::RowBlock& block) {
    engine::TorusPlane<double>::Rows v(plane, block, 1 / problem.lambda);
    for (int y = block.begin; y < block.end; ++y) {
      v.go_to(y);
      std::copy_n(v.row(), width, certificate.texture.row(y).data());
    }
  });
  return certificate;
}

TEST_CASE("a certificate agrees with the definitions of primal and dual") {
  const GreyImage image = cloth_image({9, 14});
  engine::TvGaborOptions options{.lambda = 0.02};
  const engine::TvGaborProblem<double> problem = problem_of(image, options);
  const int height = problem.image.height();
  const int width = problem.image.width();
  const engine::VectorField<double> half = random_multiplier(height, width);  // of norm < 1
  const auto certificate = certificate_of(problem, half, 0.9);

  const reference::TvGabor definition(image, options);
  const reference::Dual p{scaled(half.x, -0.9), scaled(half.y, -0.9)};
  const double primal = definition.primal(p);
  CHECK(certificate.gap == Approx((primal - definition.dual(p)) / primal).epsilon(1e-10));
  CHECK(largest_difference(certificate.texture, definition.texture(p)) < 1e-10);
}

TEST_CASE("a certificate of a flat image has gap zero") {
  const engine::TvGaborProblem<double> problem = problem_of(flat_image({8, 8}, 90), {});
  const auto certificate = certificate_of(
      problem, engine::VectorField<double>(problem.image.height(), problem.image.width()), 1.0);
  CHECK(certificate.gap == 0.0);
}

}  // namespace
}  // namespace touchtrial
