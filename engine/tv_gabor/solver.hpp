/// \file The course of a TV-Gabor decomposition: steps, checks, and the schedule of the penalty; and
/// the certificate of how far a result is from the optimum.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"
#include "engine/tv_gabor/admm.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <vector>

namespace touchtrial::engine {

template <typename Real>
struct TvGaborCertificate {
  Plane<Real> texture;  ///< v = M div p / lambda on the torus, grey levels
  double gap = 0.0;     ///< (primal - dual) / primal, >= 0; 0 where the primal value is 0
};

/// \param field,scale  the dual point: p = -scale * field, its vectors shortened to 1 if longer
/// \param plane  of the problem's size; overwritten
/// \param certificate  its former texture's memory is used again
template <typename Real>
void certify(const TvGaborProblem<Real>& problem, const VectorField<Real>& field, double scale,
             TorusPlane<Real>& plane, TvGaborCertificate<Real>& certificate);

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
  stalled,    ///< the gap hardly shrinks any more
};

/// Whether a run may stop because the gap hardly shrinks any more.
enum class Patience { limited, unlimited };

/// Where a solver stopped.
template <typename Real>
struct TvGaborState {
  VectorField<Real> z;
  double penalty;  ///< of z; the schedule may have gone on
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

  /// Takes steps until there is a reason to stop; the certificate is then that of the last step.
  /// \param max_steps  the number of steps() at which they are exhausted
  [[nodiscard]] SolverStop run(int max_steps, Patience patience);

  /// Texture on the torus and gap at the last check; empty before the first.
  [[nodiscard]] const TvGaborCertificate<Real>& certificate() const noexcept {
    return certificate_;
  }
  /// Steps taken, including those of the solver that this one continues.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] TvGaborState<Real> state() const {
    return {admm_.z(), admm_.penalty(), schedule_, steps_};
  }

 private:
  void step_to_check(int last);
  [[nodiscard]] bool is_stalled() const;

  double wanted_gap_;
  TvGaborProblem<Real> problem_;
  TorusPlane<Real> plane_;
  PenaltySchedule schedule_;
  TvGaborAdmm<Real> admm_;
  TvGaborCertificate<Real> certificate_;
  std::vector<double> gaps_;  // of this solver, at every check
  int steps_ = 0;
};

}  // namespace touchtrial::engine
