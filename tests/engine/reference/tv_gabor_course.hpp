/// \file TV-Gabor by two solvers, step by step, to compare them: the engine's ADMM, and a slower one
/// on the dual, which shares the engine's transforms but not its iteration. Source:
/// docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

#include <memory>

namespace touchtrial::reference {

enum class TvGaborAlgorithm {
  admm,  ///< the one that extraction uses, its checks included
  /// The semi-implicit fixed point, tau = 1/8: A. Chambolle, "An algorithm for total variation
  /// minimization and applications", 2004. The baseline to beat.
  fixed_point,
};

/// A solver's result after some steps.
template <typename Real>
struct TvGaborPoint {
  int steps = 0;
  double gap = 0.0;     ///< relative primal-dual gap, >= 0
  Plane<Real> texture;  ///< v, grey levels, of the image's shape
};

/// A solver that stays in one precision: float does not continue in double as in extraction. One
/// object belongs to one thread at a time.
template <typename Real>
class TvGaborCourse {
 public:
  /// \param image  at least 1 x 1
  /// \param options  gap and max_steps have no effect
  /// \throws std::invalid_argument if the image is empty or flat, or too small to choose a
  /// component
  TvGaborCourse(const GreyImage& image, const engine::TvGaborOptions& options,
                TvGaborAlgorithm algorithm);
  ~TvGaborCourse();
  TvGaborCourse(const TvGaborCourse&) = delete;
  TvGaborCourse& operator=(const TvGaborCourse&) = delete;

  /// Takes steps; benchmarks time this. ADMM checks every tenth step and the last one of each call.
  /// \param steps  >= 0
  void advance(int steps);
  /// The present texture and gap; does not change the course. Costs about a step.
  [[nodiscard]] TvGaborPoint<Real> point();

 private:
  class Solver;
  class Admm;
  class FixedPoint;

  int height_, width_;
  int steps_ = 0;
  std::unique_ptr<Solver> solver_;
};

}  // namespace touchtrial::reference
