/// \file The maximum of a smooth function within bounds, by NLopt.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// \param slopes  empty, or receives the derivatives
using SmoothFunction =
    std::function<double(std::span<const double> point, std::span<double> slopes)>;

struct Bounds {
  std::vector<double> lower;
  std::vector<double> upper;
};

struct Optimum {
  std::vector<double> point;
  double value = 0.0;
};

struct OptimiserOptions {
  double tolerance = 1e-7;  ///< of the value, relative, > 0
  int max_evaluations = 200;
  std::vector<double> scales{};  ///< typical size of each number's changes, > 0; empty: 1
};

/// Sequential quadratic programming (NLopt's LD_SLSQP; Kraft 1994), from one start, deterministic.
/// \param start  is clamped to the bounds; if it is empty, the function is evaluated once
/// \return the best point seen, even if rounding or the limit of evaluations ended the search
/// \throws what the function throws
[[nodiscard]] Optimum maximise(const SmoothFunction& function, std::vector<double> start,
                               const Bounds& bounds, const OptimiserOptions& options = {});

}  // namespace touchtrial::planning
