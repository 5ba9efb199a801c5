// TV-Gabor on extreme images, over the whole useful range of lambda.
#include "engine/extraction.hpp"
#include "engine/finite_plane.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kLambdas[] = {1e-6, 1e-4, 1e-2, 1.0, 1e3};

engine::ExtractionOptions tv_gabor_options(double lambda, int max_steps = 300) {
  engine::ExtractionOptions options{.method = engine::Method::tv_gabor};
  options.tv_gabor.lambda = lambda;
  options.tv_gabor.max_steps = max_steps;
  return options;
}

void check_decomposition(const GreyImage& image, double lambda) {
  const auto check = [&]<typename Real>() {
    const auto result = engine::extract_texture<Real>(image, tv_gabor_options(lambda),
                                                      engine::RequestedPlanes::all());
    REQUIRE(engine::all_finite(result.texture));
    REQUIRE(engine::all_finite(result.cartoon));
    REQUIRE(result.gap >= 0.0);
    REQUIRE(std::isfinite(result.gap));
    REQUIRE(result.converged == (result.gap <= 1e-5));
    REQUIRE(largest_magnitude(result.texture) <= 1e4);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const double sum = static_cast<double>(result.cartoon.samples()[i]) +
                         static_cast<double>(result.texture.samples()[i]);
      REQUIRE(std::abs(sum - image.samples()[i]) <= 1e-4);
    }
  };
  check.template operator()<float>();
  check.template operator()<double>();
}

TEST_CASE("tv-gabor splits every extreme image for lambda from 1e-6 to 1e3") {
  for (const Size size :
       {Size{1, 1}, Size{1, 9}, Size{9, 1}, Size{2, 2}, Size{3, 5}, Size{12, 11}}) {
    for (const auto& [name, image] : extreme_images(size)) {
      for (const double lambda : kLambdas) {
        INFO(name << ", " << size.height << " x " << size.width << ", lambda " << lambda);
        check_decomposition(image, lambda);
      }
    }
  }
}

TEST_CASE("tv-gabor's gap falls as steps are added, and never below zero") {
  for (const double lambda : {1e-3, 1e-2, 1e-1}) {
    for (const GreyImage& image : {noise_image({24, 20}), cloth_image({24, 20})}) {
      std::vector<double> gaps;
      for (const int steps : {10, 40, 160, 640}) {
        engine::ExtractionOptions options = tv_gabor_options(lambda, steps);
        options.tv_gabor.gap = 1e-12;
        gaps.push_back(engine::extract_texture<double>(image, options).gap);
        REQUIRE(gaps.back() >= 0.0);
      }
      INFO("lambda " << lambda << ", gaps " << gaps[0] << " " << gaps[1] << " " << gaps[2] << " "
                     << gaps[3]);
      CHECK(gaps.back() < 0.1 * gaps.front());
      for (std::size_t i = 1; i < gaps.size(); ++i) CHECK(gaps[i] <= 2.0 * gaps[i - 1]);
    }
  }
}

}  // namespace
}  // namespace touchtrial
