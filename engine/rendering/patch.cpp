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

/// A row of four, in one register or in several.
using Doubles = hn::CappedTag<double, 4>;
using Values = hn::Vec<Doubles>;

/// The values of four columns.
struct Row {
  alignas(32) double at[4];
};

template <class Visit>
HWY_INLINE void for_all_lanes(const Visit& visit) {
  for (std::size_t i = 0; i < 4; i += hn::Lanes(Doubles())) visit(i);
}

HWY_INLINE Values load(const float* from) {
  return hn::PromoteTo(Doubles(), hn::LoadU(hn::Rebind<float, Doubles>(), from));
}

/// a + share * (b - a)
HWY_INLINE Values between(Values a, Values b, Values share) {
  return hn::Add(a, hn::Mul(share, hn::Sub(b, a)));
}
HWY_INLINE double between(double a, double b, double share) {
  return a + share * (b - a);
}

PatchSums bilinear(const float* corner, std::size_t stride, double u, double v) {
  const Doubles d;
  const Values down = hn::Set(d, v);
  Row height;
  Row smooth;
  Row step;
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    const float* from = corner + i;
    const Values first = load(from);
    const Values second = load(from + stride);
    const Values third = load(from + 2 * stride);
    const Values fourth = load(from + 3 * stride);
    hn::Store(between(second, third, down), d, height.at + i);
    const Values middle = hn::Add(second, third);
    hn::Store(hn::Add(middle, between(hn::Add(first, second), hn::Add(third, fourth), down)), d,
              smooth.at + i);
    hn::Store(between(hn::Sub(first, third), hn::Sub(second, fourth), down), d, step.at + i);
  });
  return {between(height.at[1], height.at[2], u),
          0.5 * between(smooth.at[0] - smooth.at[2], smooth.at[1] - smooth.at[3], u),
          0.5 * (step.at[1] + step.at[2] +
                 between(step.at[0] + step.at[1], step.at[2] + step.at[3], u))};
}

/// Weights of four coefficients, for the value and for the slope.
struct Weights {
  Row value;
  Row slope;
};

/// Weights for a point at a distance t beyond the second coefficient.
HWY_INLINE void weigh(double t, Weights& weights) {
  // Coefficients of 1, t, t^2 and t^3.
  constexpr double kSixth = 1.0 / 6.0;
  constexpr Row kOne = {{kSixth, 4.0 * kSixth, kSixth, 0.0}};
  constexpr Row kFirst = {{-0.5, 0.0, 0.5, 0.0}};
  constexpr Row kSecond = {{0.5, -1.0, 0.5, 0.0}};
  constexpr Row kThird = {{-kSixth, 0.5, -0.5, kSixth}};
  constexpr Row kTwiceSecond = {{1.0, -2.0, 1.0, 0.0}};
  constexpr Row kThriceThird = {{-0.5, 1.5, -1.5, 0.5}};
  const Doubles d;
  const Values at = hn::Set(d, t);
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    const auto factor = [&](const Row& row) HWY_ATTR { return hn::Load(d, row.at + i); };
    Values value = hn::Add(hn::Mul(factor(kThird), at), factor(kSecond));
    value = hn::Add(hn::Mul(value, at), factor(kFirst));
    hn::Store(hn::Add(hn::Mul(value, at), factor(kOne)), d, weights.value.at + i);
    const Values slope = hn::Add(hn::Mul(factor(kThriceThird), at), factor(kTwiceSecond));
    hn::Store(hn::Add(hn::Mul(slope, at), factor(kFirst)), d, weights.slope.at + i);
  });
}

HWY_INLINE double sum_of(const Row& row) {
  return (row.at[0] + row.at[2]) + (row.at[1] + row.at[3]);
}

PatchSums spline(const float* corner, std::size_t stride, double u, double v) {
  const Doubles d;
  Weights across;
  Weights down;
  weigh(u, across);
  weigh(v, down);
  Row height;
  Row along_x;
  Row along_y;
  for_all_lanes([&](std::size_t i) HWY_ATTR {
    Values value = hn::Zero(d);
    Values slope = hn::Zero(d);
    for (int row = 0; row < 4; ++row) {
      const Values c = load(corner + row * stride + i);
      value = hn::Add(value, hn::Mul(c, hn::Set(d, down.value.at[row])));
      slope = hn::Add(slope, hn::Mul(c, hn::Set(d, down.slope.at[row])));
    }
    const Values weight = hn::Load(d, across.value.at + i);
    hn::Store(hn::Mul(value, weight), d, height.at + i);
    hn::Store(hn::Mul(value, hn::Load(d, across.slope.at + i)), d, along_x.at + i);
    hn::Store(hn::Mul(slope, weight), d, along_y.at + i);
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

HWY_EXPORT(bilinear);
HWY_EXPORT(spline);

/// Chooses the processor's target, once.
void choose_target() {
  if (!hwy::GetChosenTarget().IsInitialized()) {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace

SumOfPatch bilinear_sum() {
  choose_target();
  return HWY_DYNAMIC_DISPATCH(bilinear);
}

SumOfPatch spline_sum() {
  choose_target();
  return HWY_DYNAMIC_DISPATCH(spline);
}

}  // namespace touchtrial::engine
#endif
