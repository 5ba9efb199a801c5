#include "engine/rendering/patch.hpp"

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/rendering/patch.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// A row of four values, in one or more registers.
using Doubles = hn::CappedTag<double, 4>;
using Values = hn::Vec<Doubles>;

/// The values of four columns.
struct Row {
  alignas(32) double lanes[4];
};

template <class Visit>
HWY_INLINE void for_all_lanes(const Visit& visit) {
  for (std::size_t i = 0; i < 4; i += hn::Lanes(Doubles())) visit(i);
}

HWY_INLINE Values load(const float* source) {
  return hn::PromoteTo(Doubles(), hn::LoadU(hn::Rebind<float, Doubles>(), source));
}

/// a + share * (b - a)
HWY_INLINE Values interpolate(Values a, Values b, Values share) {
  return hn::Add(a, hn::Mul(share, hn::Sub(b, a)));
}
HWY_INLINE double interpolate(double a, double b, double share) {
  return a + share * (b - a);
}

PatchSums sum_bilinear(const float* corner, std::size_t stride, double u, double v) {
  const Doubles d;
  const Values fraction_y = hn::Set(d, v);
  Row height;
  Row smooth;
  Row step;
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    const float* source = corner + i;
    const Values first = load(source);
    const Values second = load(source + stride);
    const Values third = load(source + 2 * stride);
    const Values fourth = load(source + 3 * stride);
    hn::Store(interpolate(second, third, fraction_y), d, height.lanes + i);
    const Values middle = hn::Add(second, third);
    hn::Store(
        hn::Add(middle, interpolate(hn::Add(first, second), hn::Add(third, fourth), fraction_y)), d,
        smooth.lanes + i);
    hn::Store(interpolate(hn::Sub(first, third), hn::Sub(second, fourth), fraction_y), d,
              step.lanes + i);
  });
  return {
      interpolate(height.lanes[1], height.lanes[2], u),
      0.5 * interpolate(smooth.lanes[0] - smooth.lanes[2], smooth.lanes[1] - smooth.lanes[3], u),
      0.5 * (step.lanes[1] + step.lanes[2] +
             interpolate(step.lanes[0] + step.lanes[1], step.lanes[2] + step.lanes[3], u))};
}

/// Weights of four coefficients, for the value and for the slope.
struct Weights {
  Row value;
  Row slope;
};

/// Computes the weights for a point at a distance t after the second coefficient.
HWY_INLINE void set_weights(double t, Weights& weights) {
  // Coefficients of 1, t, t^2 and t^3.
  constexpr double kSixth = 1.0 / 6.0;
  constexpr Row kOne = {{kSixth, 4.0 * kSixth, kSixth, 0.0}};
  constexpr Row kFirst = {{-0.5, 0.0, 0.5, 0.0}};
  constexpr Row kSecond = {{0.5, -1.0, 0.5, 0.0}};
  constexpr Row kThird = {{-kSixth, 0.5, -0.5, kSixth}};
  constexpr Row kTwiceSecond = {{1.0, -2.0, 1.0, 0.0}};
  constexpr Row kThriceThird = {{-0.5, 1.5, -1.5, 0.5}};
  const Doubles d;
  const Values t_lanes = hn::Set(d, t);
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    const auto factor = [&](const Row& row) HWY_ATTR { return hn::Load(d, row.lanes + i); };
    Values value = hn::Add(hn::Mul(factor(kThird), t_lanes), factor(kSecond));
    value = hn::Add(hn::Mul(value, t_lanes), factor(kFirst));
    hn::Store(hn::Add(hn::Mul(value, t_lanes), factor(kOne)), d, weights.value.lanes + i);
    const Values slope = hn::Add(hn::Mul(factor(kThriceThird), t_lanes), factor(kTwiceSecond));
    hn::Store(hn::Add(hn::Mul(slope, t_lanes), factor(kFirst)), d, weights.slope.lanes + i);
  });
}

HWY_INLINE double sum_of(const Row& row) {
  return (row.lanes[0] + row.lanes[2]) + (row.lanes[1] + row.lanes[3]);
}

PatchSums sum_spline(const float* corner, std::size_t stride, double u, double v) {
  const Doubles d;
  Weights weights_x;
  Weights weights_y;
  set_weights(u, weights_x);
  set_weights(v, weights_y);
  Row height;
  Row along_x;
  Row along_y;
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    Values value = hn::Zero(d);
    Values slope = hn::Zero(d);
    for (int row = 0; row < 4; ++row) {
      const Values c = load(corner + row * stride + i);
      value = hn::Add(value, hn::Mul(c, hn::Set(d, weights_y.value.lanes[row])));
      slope = hn::Add(slope, hn::Mul(c, hn::Set(d, weights_y.slope.lanes[row])));
    }
    const Values weight = hn::Load(d, weights_x.value.lanes + i);
    hn::Store(hn::Mul(value, weight), d, height.lanes + i);
    hn::Store(hn::Mul(value, hn::Load(d, weights_x.slope.lanes + i)), d, along_x.lanes + i);
    hn::Store(hn::Mul(slope, weight), d, along_y.lanes + i);
  });
  return {sum_of(height), sum_of(along_x), sum_of(along_y)};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(sum_bilinear);
HWY_EXPORT(sum_spline);

/// Chooses the best target for this processor, once.
void choose_target() {
  if (!hwy::GetChosenTarget().IsInitialized()) {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace

SumOfPatch bilinear_sum() {
  choose_target();
  return HWY_DYNAMIC_DISPATCH(sum_bilinear);
}

SumOfPatch spline_sum() {
  choose_target();
  return HWY_DYNAMIC_DISPATCH(sum_spline);
}

}  // namespace touchtrial::engine
#endif
