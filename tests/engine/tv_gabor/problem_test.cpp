#include "engine/tv_gabor/problem.hpp"

#include "engine/example_images.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/mirror.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial {
namespace {

TEST_CASE("torus_length is even, long enough, and has no prime factor above 7") {
  CHECK(engine::torus_length(500) == 540);
  CHECK(engine::torus_length(1) == 36);
  CHECK(engine::torus_length(10) == 42);
  CHECK(engine::torus_length(12) == 48);
  for (int n = 1; n < 700; ++n) {
    const int length = engine::torus_length(n);
    INFO("n " << n);
    REQUIRE(length % 2 == 0);
    REQUIRE(length >= n + 32);
    REQUIRE(length >= engine::torus_length(n > 1 ? n - 1 : 1));
  }
}

TEMPLATE_TEST_CASE("extended_to_torus mirrors the image on all sides", "", float, double) {
  for (const Size size : {Size{1, 1}, Size{1, 6}, Size{5, 3}, Size{40, 33}}) {
    const GreyImage image = noise_image(size);
    const Plane<TestType> torus = engine::extended_to_torus<TestType>(image);
    REQUIRE(torus.height() == engine::torus_length(size.height));
    REQUIRE(torus.width() == engine::torus_length(size.width));
    for (int y = 0; y < torus.height(); ++y) {
      for (int x = 0; x < torus.width(); ++x) {
        REQUIRE(torus.at(y, x) == reference::mirrored_sample(image, y - 16, x - 16));
      }
    }
  }
}

const std::vector<engine::GaborComponent>& default_components() {
  static const std::vector<engine::GaborComponent> components = engine::TvGaborOptions{}.components;
  return components;
}

TEST_CASE("gabor_spectrum is what the convolution with M's kernel multiplies by") {
  const GreyImage image(10, 8);
  const reference::TvGabor by_convolution(image, engine::TvGaborOptions{});
  Plane<double> impulse(by_convolution.torus().height(), by_convolution.torus().width());
  impulse.at(0, 0) = 1.0;
  const Plane<double> response = by_convolution.apply_m(impulse);
  engine::RealFft<double> fft(impulse.height(), impulse.width());
  std::copy(response.samples().begin(), response.samples().end(), fft.plane().begin());
  fft.forward();
  const Plane<double> spectrum =
      engine::gabor_spectrum(default_components(), impulse.height(), impulse.width());
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    REQUIRE(fft.spectrum()[i].real() == Approx(spectrum.samples()[i]).margin(1e-13));
    REQUIRE(fft.spectrum()[i].imag() == Approx(0.0).margin(1e-13));
  }
}

}  // namespace
}  // namespace touchtrial
