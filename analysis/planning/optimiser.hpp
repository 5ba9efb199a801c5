/// \file The largest value of a smooth function between bounds. The method is NLopt's.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// \param slopes  gets the derivatives unless empty
using SmoothFunction = std::function<double(std::span<const double> at, std::span<double> slopes)>;

struct Bounds {
  std::vector<double> lower;
  std::vector<double> upper;
};

struct Optimum {
  std::vector<double> at;
  double value = 0.0;
};

struct OptimiserOptions {
  double tolerance = 1e-7;  ///< of the value, relative, > 0
  int most_evaluations = 200;
  std::vector<double> scales{};  ///< by how much a number matters, > 0 each; empty: 1
};

/// Sequential quadratic programming (NLopt's LD_SLSQP; Kraft 1994), from one start, deterministic.
/// The best point seen is returned, also where rounding or the evaluations' number ended it.
/// \param start  is moved between the bounds; without numbers, the function is evaluated once
/// \throws what the function throws
[[nodiscard]] Optimum maximise(const SmoothFunction& function, std::vector<double> start,
                               const Bounds& bounds, const OptimiserOptions& options = {});

}  // namespace touchtrial::planning
