/// \file The TV-Gabor solver: runs ADMM steps with checks and a penalty schedule, and certifies the
/// primal-dual gap of the result. Source: docs/method.md, "TV-Gabor". Private to engine/tv_gabor.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"
#include "engine/tv_gabor/admm.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial::engine {

/// Computes the relative gap (primal - dual) / primal, >= 0, of a dual point p and the texture
/// v = M div p / lambda; 0 if the primal value is 0.
/// \param field,scale  p = -scale * field with vectors clipped to 1
/// \param plane  on entry gain * -div p; on return gain * lambda * v
template <typename Real>
[[nodiscard]] double certified_gap(const TvGaborProblem<Real>& problem,
                                   const VectorField<Real>& field, double scale,
                                   TorusPlane<Real>& plane, double gain);

/// The part of the plane that covers an image of the given shape, multiplied by `scale`.
template <typename Real>
[[nodiscard]] Plane<Real> cropped_texture(const TorusPlane<Real>& plane, double scale, int height,
                                          int width) {
  Plane<Real> texture(height, width);
  plane.for_each_block([&](const RowBlock& block) {
    typename TorusPlane<Real>::Rows rows(plane, block, static_cast<Real>(scale));
    for (int y = block.begin; y < block.end; ++y) {
      rows.go_to(y);
      const int image_y = y - kTorusMargin;
      if (image_y < 0 || image_y >= height) continue;
      std::copy_n(rows.row() + kTorusMargin, width, texture.row(image_y).data());
    }
  });
  return texture;
}

/// The penalty after each check. It starts high and falls by a constant factor at each of 20
/// checks, during which photographs converge. After that it balances the residuals, which suits
/// drawings. (Balanced from the start, photographs take up to twice as many steps.)
class PenaltySchedule {
 public:
  static constexpr int kStepsBetweenChecks = 10;

  /// \param mean_gradient  of the image, > 0; its inverse is the unit of the penalty
  explicit PenaltySchedule(double mean_gradient);

  /// Call after every check.
  /// \param gap  >= 0
  /// \param residuals  of the last step
  void next(double gap, const AdmmResiduals& residuals);

  /// Whether the next check needs residuals.
  [[nodiscard]] bool needs_residuals() const noexcept;
  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// Eager unless the last check showed little progress.
  [[nodiscard]] AdmmPace pace() const noexcept { return pace_; }

 private:
  void balance(const AdmmResiduals& residuals);

  double initial_penalty_;
  double penalty_;
  double previous_gap_ = 0.0;
  AdmmPace pace_ = AdmmPace::eager;
  int checks_ = 0;
};

/// Why a run stopped.
enum class SolverStop {
  converged,  ///< the gap is small enough
  exhausted,  ///< the maximum number of steps was reached
  stalled,    ///< the gap decreases too slowly
};

/// Whether a run may stop as stalled.
enum class Patience { limited, unlimited };

/// The state of a stopped solver.
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
  /// Continues from the state of a solver with the same image and options in another precision.
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

  /// Takes steps until a reason to stop; updates gap and texture.
  /// \param max_steps  limit of steps()
  [[nodiscard]] SolverStop run(int max_steps, Patience patience);

  /// The gap at the last check; 1 before the first.
  [[nodiscard]] double gap() const noexcept { return gap_; }
  /// v at the last check, without the margins of the torus, grey levels.
  /// \pre steps() > 0
  [[nodiscard]] Plane<Real> texture() const;
  /// Steps taken, including the steps of a continued solver.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] TvGaborState<Real> state() const {
    return {admm_.z(), admm_.penalty(), schedule_, steps_};
  }

 private:
  void step_to_check(int last_step);
  [[nodiscard]] bool is_stalled() const;

  int height_, width_;  // of the image
  double target_gap_;
  TvGaborProblem<Real> problem_;
  TorusPlane<Real> plane_;
  PenaltySchedule schedule_;
  TvGaborAdmm<Real> admm_;
  std::vector<double> gaps_;  // of this solver, at every check
  double gap_ = 1.0;
  int steps_ = 0;
};

}  // namespace touchtrial::engine
