/// \file How TV-Gabor's solvers go towards the texture, step by step.
#pragma once

#include "core/plane.hpp"
#include "tests/engine/reference/tv_gabor_course.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// Where a solver is after some time.
struct CoursePoint {
  int steps = 0;
  double us = 0.0;     ///< of its own steps, set-up included; looking on costs nothing
  double error = 0.0;  ///< of v, relative, in the Euclidean norm
  double gap = 0.0;    ///< relative primal-dual gap
};

struct SolverCourse {
  std::string solver;
  std::vector<CoursePoint> points;
};

/// \param steps  between two looks \param looks  how many \param image  not flat
template <typename Real>
[[nodiscard]] std::vector<CoursePoint> watch_course(const GreyImage& image,
                                                    reference::TvGaborAlgorithm algorithm,
                                                    int steps, int looks);

/// Steps that ADMM in single precision takes to come this close, in tens; nothing if a few hundred
/// do not do.
[[nodiscard]] std::optional<CoursePoint> admm_until(const GreyImage& image, double error);

/// All solvers on one image.
[[nodiscard]] std::vector<SolverCourse> solver_courses(const GreyImage& image);

}  // namespace touchtrial::bench
