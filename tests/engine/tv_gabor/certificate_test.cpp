#include "core/random.hpp"
#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/tv_gabor_certificate.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "support/catch.hpp"

#include <cmath>
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

TEST_CASE("a certificate agrees with the definitions of primal and dual") {
  const GreyImage image = cloth_image({9, 14});
  engine::TvGaborOptions options;
  options.lambda = 0.02;
  const engine::TvGaborProblem<double> problem = problem_of(image, options);
  const int height = problem.image.height();
  const int width = problem.image.width();
  const engine::VectorField<double> half = random_multiplier(height, width);  // of norm < 1
  const auto certificate = reference::certificate_of(problem, half, 0.9);

  const reference::TvGabor definition(image, options);
  const reference::Dual p{scaled(half.x, -0.9), scaled(half.y, -0.9)};
  const double primal = definition.primal(p);
  CHECK(certificate.gap == Approx((primal - definition.dual(p)) / primal).epsilon(1e-10));
  CHECK(largest_difference(certificate.texture, definition.texture(p)) < 1e-10);
}

TEST_CASE("a certificate of a flat image has gap zero") {
  const engine::TvGaborProblem<double> problem = problem_of(flat_image({8, 8}, 90), {});
  const auto certificate = reference::certificate_of(
      problem, engine::VectorField<double>(problem.image.height(), problem.image.width()), 1.0);
  CHECK(certificate.gap == 0.0);
}

}  // namespace
}  // namespace touchtrial
