#include "engine/fourier/real_fft.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <thread>
#include <vector>

namespace touchtrial {
namespace {

template <typename Real>
void fill_with_noise(std::span<Real> plane, std::uint64_t seed) {
  RandomStream random(seed, "transform test");
  for (Real& sample : plane) sample = static_cast<Real>(random.uniform(-1.0, 1.0));
}

TEMPLATE_TEST_CASE("a transform agrees with the sum that defines it", "", float, double) {
  constexpr int kHeight = 6;
  constexpr int kWidth = 10;
  engine::RealFft<TestType> fft(kHeight, kWidth);
  fill_with_noise(fft.plane(), 1);
  const std::vector<TestType> plane(fft.plane().begin(), fft.plane().end());
  fft.forward();
  CHECK(std::equal(plane.begin(), plane.end(), fft.plane().begin()));
  for (int k = 0; k < kHeight; ++k) {
    for (int l = 0; l <= kWidth / 2; ++l) {
      std::complex<double> sum = 0.0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const double turns =
              static_cast<double>(k * y) / kHeight + static_cast<double>(l * x) / kWidth;
          sum += std::polar(1.0, -2.0 * std::numbers::pi * turns) *
                 static_cast<double>(plane[static_cast<std::size_t>(y * kWidth + x)]);
        }
      }
      const std::complex<double> coefficient(
          fft.spectrum()[static_cast<std::size_t>(k * (kWidth / 2 + 1) + l)]);
      CHECK(std::abs(coefficient - sum) < (sizeof(TestType) == 4 ? 1e-5 : 1e-13));
    }
  }
}

TEMPLATE_TEST_CASE("a transform and its inverse multiply by the number of samples", "", float,
                   double) {
  engine::RealFft<TestType> fft(36, 42);
  fill_with_noise(fft.plane(), 2);
  const std::vector<TestType> plane(fft.plane().begin(), fft.plane().end());
  fft.forward();
  fft.inverse();
  for (std::size_t i = 0; i < plane.size(); ++i) {
    REQUIRE(fft.plane()[i] / (36 * 42) == Approx(plane[i]).margin(1e-6));
  }
}

TEST_CASE("transforms can be created and used by several threads at once") {
  const auto transformed = [](std::vector<double>& result) {
    for (int round = 0; round < 20; ++round) {
      engine::RealFft<double> fft(40, 36);
      fill_with_noise(fft.plane(), 3);
      fft.forward();
      fft.inverse();
      result.assign(fft.plane().begin(), fft.plane().end());
    }
  };
  std::vector<double> here, there;
  std::thread other(transformed, std::ref(there));
  transformed(here);
  other.join();
  CHECK(here == there);
}

}  // namespace
}  // namespace touchtrial
