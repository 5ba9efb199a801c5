/// \file The course of a TV-Gabor decomposition: steps, checks, and the schedule of the penalty;
/// and the gap that certifies how far a result is from the optimum. Source: docs/method.md,
/// "TV-Gabor". Private to engine/tv_gabor.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"
#include "engine/tv_gabor/admm.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial::engine {

/// The relative gap (primal - dual) / primal, >= 0, of a dual point p, and with it v = M div p /
/// lambda; 0 where the primal value is 0.
/// \param field,scale  p = -scale * field, its vectors shortened to 1 if longer
/// \param plane  holds -div p, multiplied by any factor; afterwards v, multiplied by lambda and that
///   factor
/// \param gain  that factor
template <typename Real>
[[nodiscard]] double certified_gap(const TvGaborProblem<Real>& problem,
                                   const VectorField<Real>& field, double scale,
                                   TorusPlane<Real>& plane, double gain);

/// The part of the plane that belongs to an image of the given shape.
/// \param scale  of all samples
template <typename Real>
[[nodiscard]] Plane<Real> cropped_texture(const TorusPlane<Real>& plane, double scale, int height,
                                          int width) {
  Plane<Real> texture(height, width);
  plane.in_blocks([&](const RowBlock& block) {
    typename TorusPlane<Real>::Rows rows(plane, block, static_cast<Real>(scale));
    for (int y = block.begin; y < block.end; ++y) {
      rows.go_to(y);
      const int in_image = y - kTorusMargin;
      if (in_image < 0 || in_image >= height) continue;
      std::copy_n(rows.row() + kTorusMargin, width, texture.row(in_image).data());
    }
  });
  return texture;
}

/// The penalty of the iteration, check by check. It starts high and falls by the same factor at
/// each of 20 checks, which suits photographs: they converge meanwhile. From then on it balances
/// the residuals of the others, mostly drawings. (Balanced from the start, photographs take up to
/// twice as many steps.)
class PenaltySchedule {
 public:
  static constexpr int kStepsBetweenChecks = 10;

  /// \param mean_gradient  of the image, > 0: the penalty's natural unit is its inverse
  explicit PenaltySchedule(double mean_gradient);

  /// Call after every check.
  /// \param gap  >= 0
  /// \param residuals  of the last step
  void next(double gap, const AdmmResiduals& residuals);

  /// Whether the next check needs residuals.
  [[nodiscard]] bool wants_residuals() const noexcept;
  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// Eager, unless the last check showed hardly any progress.
  [[nodiscard]] AdmmPace pace() const noexcept { return pace_; }

 private:
  void balance(const AdmmResiduals& residuals);

  double first_penalty_;
  double penalty_;
  double last_gap_ = 0.0;
  AdmmPace pace_ = AdmmPace::eager;
  int checks_ = 0;
};

/// Why a run stopped.
enum class SolverStop {
  converged,  ///< the gap is small enough
  exhausted,  ///< no steps are left
  stalled,    ///< the gap hardly shrinks
};

/// Whether a run may stop because the gap hardly shrinks.
enum class Patience { limited, unlimited };

/// Where a solver stopped.
template <typename Real>
struct TvGaborState {
  VectorField<Real> z;
  double penalty;  ///< of z; the schedule may have advanced
  PenaltySchedule schedule;
  int steps;
};

template <typename Real>
class TvGaborSolver {
 public:
  /// \param image  neither flat nor empty
  /// \param options  max_steps has no effect
  /// \param jobs  number of threads, as for in_parallel; results do not depend on it
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options, int jobs = 1);
  /// Continues where a solver of the same image and options, but of another precision, stopped.
  template <typename Other>
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options, int jobs,
                const TvGaborState<Other>& state)
      : TvGaborSolver(image, options, jobs) {
    schedule_ = state.schedule;
    admm_.resume(state.z, state.penalty);
    steps_ = state.steps;
  }

  TvGaborSolver(const TvGaborSolver&) = delete;
  TvGaborSolver& operator=(const TvGaborSolver&) = delete;

  /// Takes steps until there is a reason to stop; gap and texture are then those of the last step.
  /// \param max_steps  the number of steps() at which they are exhausted
  [[nodiscard]] SolverStop run(int max_steps, Patience patience);

  /// The gap at the last check; 1 before the first.
  [[nodiscard]] double gap() const noexcept { return gap_; }
  /// v of the last check, without the torus' margins, grey levels.
  /// \pre steps() > 0
  [[nodiscard]] Plane<Real> texture() const;
  /// Steps taken, including those of the solver that this one continues.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] TvGaborState<Real> state() const {
    return {admm_.z(), admm_.penalty(), schedule_, steps_};
  }

 private:
  void step_to_check(int last);
  [[nodiscard]] bool is_stalled() const;

  int height_, width_;  // of the image
  double wanted_gap_;
  TvGaborProblem<Real> problem_;
  TorusPlane<Real> plane_;
  PenaltySchedule schedule_;
  TvGaborAdmm<Real> admm_;
  std::vector<double> gaps_;  // of this solver, at every check
  double gap_ = 1.0;
  int steps_ = 0;
};

}  // namespace touchtrial::engine
