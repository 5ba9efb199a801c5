/// \file How TV-Gabor's solvers converge to the texture, step by step.
#pragma once

#include "core/plane.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// The state of a solver after some time.
struct CoursePoint {
  int steps = 0;
  double us =
      0.0;  ///< of the solver's own steps, set-up included; taking this point is not counted
  double error = 0.0;  ///< of v, relative, in the Euclidean norm
  double gap = 0.0;    ///< relative primal-dual gap
};

struct SolverCourse {
  std::string solver;
  std::vector<CoursePoint> points;
};

/// The first point, in steps of ten, at which ADMM in single precision reaches this error.
/// \return nothing if it needs more than 300 steps
[[nodiscard]] std::optional<CoursePoint> admm_until(const GreyImage& image, double error);

/// The courses of all solvers on one image, which must not be flat.
[[nodiscard]] std::vector<SolverCourse> solver_courses(const GreyImage& image);

}  // namespace touchtrial::bench
