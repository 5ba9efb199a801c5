#include "engine/tv_gabor/row_kernels.hpp"

#include "core/random.hpp"
#include "engine/every_simd_target.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial {
namespace {

template <typename Real>
std::vector<Real> noise(std::size_t width, const char* name) {
  RandomStream random(3, name);
  std::vector<Real> row(width);
  for (Real& sample : row) sample = static_cast<Real>(random.uniform(-2.0, 2.0));
  return row;
}

/// The definition, in double.
double target_of(double gradient, double z, double other_z, double limit) {
  return gradient - z + 2.0 * z * limit / std::max(limit, std::hypot(z, other_z));
}

TEMPLATE_TEST_CASE("TV-Gabor's row kernels agree with their definition on every target", "", float,
                   double) {
  on_every_simd_target([] {
    for (const std::size_t width : {1U, 2U, 5U, 16U, 37U}) {
      const auto f = noise<TestType>(width, "f"), below = noise<TestType>(width, "below");
      const auto v = noise<TestType>(width, "v"), v_below = noise<TestType>(width, "v below");
      const auto old_x = noise<TestType>(width, "x"), old_y = noise<TestType>(width, "y");
      const auto was_x = noise<TestType>(width, "was x"), was_y = noise<TestType>(width, "was y");
      auto z_x = old_x, z_y = old_y, previous_x = was_x, previous_y = was_y;
      std::vector<TestType> target_x(width), target_y(width);
      engine::AdmmNumbers<TestType> numbers{.relaxation = TestType(1.5),
                                            .limit = TestType(0.75),
                                            .momentum = TestType(0.25),
                                            .store_previous = true,
                                            .b_only = false};
      engine::row_kernels<TestType>().admm(
          {f.data(), below.data(), v.data(), v_below.data(), z_x.data(), z_y.data(),
           previous_x.data(), previous_y.data(), target_x.data(), target_y.data()},
          width, numbers);
      for (std::size_t i = 0; i < width; ++i) {
        const std::size_t right = i + 1 == width ? 0 : i + 1;
        const double f_x = static_cast<double>(f[right]) - f[i];
        const double v_x = static_cast<double>(v[right]) - v[i];
        const double b_x = old_x[i] * 0.75 / std::max<double>(0.75, std::hypot(old_x[i], old_y[i]));
        const double next_x = 1.5 * (f_x - v_x) - 0.5 * (old_x[i] - b_x) + b_x;
        REQUIRE(previous_x[i] == Approx(next_x).margin(1e-5));
        REQUIRE(z_x[i] == Approx(next_x + 0.25 * (next_x - was_x[i])).margin(1e-5));
        REQUIRE(target_x[i] == Approx(target_of(f_x, z_x[i], z_y[i], 0.75)).margin(1e-5));
        REQUIRE(target_y[i] ==
                Approx(target_of(static_cast<double>(below[i]) - f[i], z_y[i], z_x[i], 0.75))
                    .margin(1e-5));
      }
      // The last step: no momentum, the former value stays, and the targets are b.
      z_x = old_x, z_y = old_y;
      const auto next_x = previous_x, next_y = previous_y;
      previous_x = was_x;
      numbers.momentum = 0;
      numbers.store_previous = false;
      numbers.b_only = true;
      engine::row_kernels<TestType>().admm(
          {f.data(), below.data(), v.data(), v_below.data(), z_x.data(), z_y.data(),
           previous_x.data(), previous_y.data(), target_x.data(), target_y.data()},
          width, numbers);
      CHECK(z_x == next_x);
      CHECK(previous_x == was_x);
      for (std::size_t i = 0; i < width; ++i) {
        const double share = 0.75 / std::max<double>(0.75, std::hypot(next_x[i], next_y[i]));
        REQUIRE(target_x[i] == Approx(share * next_x[i]).margin(1e-5));
        REQUIRE(target_y[i] == Approx(share * next_y[i]).margin(1e-5));
      }
    }
  });
}

TEMPLATE_TEST_CASE(
    "a row that starts again at another limit keeps w and rescales b on every target", "", float,
    double) {
  on_every_simd_target([] {
    for (const std::size_t width : {1U, 2U, 5U, 16U, 37U}) {
      const auto f = noise<TestType>(width, "f"), below = noise<TestType>(width, "below");
      const auto old_x = noise<TestType>(width, "x"), old_y = noise<TestType>(width, "y");
      auto z_x = old_x, z_y = old_y;
      std::vector<TestType> target_x(width), target_y(width);
      engine::row_kernels<TestType>().restart(
          {f.data(), below.data(), nullptr, nullptr, z_x.data(), z_y.data(), nullptr, nullptr,
           target_x.data(), target_y.data()},
          width, {TestType(0.75), TestType(1.25)});
      for (std::size_t i = 0; i < width; ++i) {
        const std::size_t right = i + 1 == width ? 0 : i + 1;
        const double share = 0.75 / std::max<double>(0.75, std::hypot(old_x[i], old_y[i]));
        const double change = share * (1.25 / 0.75 - 1.0);
        REQUIRE(z_x[i] == Approx(old_x[i] * (1.0 + change)).margin(1e-5));
        REQUIRE(z_y[i] == Approx(old_y[i] * (1.0 + change)).margin(1e-5));
        const double f_x = static_cast<double>(f[right]) - f[i];
        const double f_y = static_cast<double>(below[i]) - f[i];
        REQUIRE(target_x[i] == Approx(target_of(f_x, z_x[i], z_y[i], 1.25)).margin(1e-5));
        REQUIRE(target_y[i] == Approx(target_of(f_y, z_y[i], z_x[i], 1.25)).margin(1e-5));
      }
    }
  });
}

TEMPLATE_TEST_CASE(
    "the divergence and the gap of a row agree with their definition on every target", "", float,
    double) {
  on_every_simd_target([] {
    for (const std::size_t width : {2U, 5U, 16U, 37U}) {
      const auto f = noise<TestType>(width, "f"), below = noise<TestType>(width, "below");
      const auto v = noise<TestType>(width, "v"), v_below = noise<TestType>(width, "v below");
      const auto q_x = noise<TestType>(width, "x"), q_y = noise<TestType>(width, "y");
      std::vector<TestType> divergence(width);
      engine::row_kernels<TestType>().divergence(q_x.data(), q_y.data(), v.data(), width,
                                                 divergence.data());
      const engine::GapSums sums = engine::row_kernels<TestType>().gap(
          {f.data(), below.data(), v.data(), v_below.data(), q_x.data(), q_y.data()}, width);
      double primal = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < width; ++i) {
        const std::size_t left = i == 0 ? width - 1 : i - 1, right = i + 1 == width ? 0 : i + 1;
        REQUIRE(divergence[i] ==
                Approx(static_cast<double>(q_x[left]) - q_x[i] + v[i] - q_y[i]).margin(2e-6));
        const double v_x = static_cast<double>(v[right]) - v[i];
        const double v_y = static_cast<double>(v_below[i]) - v[i];
        const double u_x = static_cast<double>(f[right]) - f[i] - v_x;
        const double u_y = static_cast<double>(below[i]) - f[i] - v_y;
        primal += std::hypot(u_x, u_y) + 0.5 * (q_x[i] * v_x + q_y[i] * v_y);
        difference += std::max(0.0, std::hypot(u_x, u_y) - (q_x[i] * u_x + q_y[i] * u_y));
      }
      CHECK(sums.primal == Approx(primal).epsilon(1e-12));
      CHECK(sums.difference == Approx(difference).epsilon(1e-12));
    }
  });
}

TEMPLATE_TEST_CASE("a clipped row is nowhere longer than 1 on any target", "", float, double) {
  on_every_simd_target([] {
    const auto x = noise<TestType>(41, "x"), y = noise<TestType>(41, "y");
    std::vector<TestType> out_x(41), out_y(41);
    engine::row_kernels<TestType>().clip(x.data(), y.data(), 41, TestType(3), out_x.data(),
                                         out_y.data());
    for (std::size_t i = 0; i < 41; ++i) {
      CHECK(std::hypot(out_x[i], out_y[i]) <= Approx(1.0).epsilon(1e-6));
    }
  });
}

}  // namespace
}  // namespace touchtrial
