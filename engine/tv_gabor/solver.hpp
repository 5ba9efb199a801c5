/// \file The course of a TV-Gabor decomposition: steps, checks, a penalty that follows a schedule.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/admm.hpp"
#include "engine/tv_gabor/certificate.hpp"
#include "engine/tv_gabor/penalty_schedule.hpp"
#include "engine/tv_gabor/problem.hpp"

#include <vector>

namespace touchtrial::engine {

enum class SolverStop {
  converged,  ///< the gap is small enough
  exhausted,  ///< no steps are left
  stalled,    ///< the gap no longer shrinks as it should
};

/// Whether a run may end because the gap no longer shrinks.
enum class Patience { limited, unlimited };

template <typename Real>
class TvGaborSolver {
 public:
  /// \param image  not flat, not empty \param options  max_steps does not count
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options);
  /// Goes on where a solver of the same image and options, of another precision, stopped.
  template <typename Other>
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options, const VectorField<Other>& z,
                const PenaltySchedule& schedule, int steps)
      : TvGaborSolver(image, options) {
    schedule_ = schedule;
    admm_.resume(z, schedule.penalty());
    steps_ = steps;
    admm_.start_again();
  }

  TvGaborSolver(const TvGaborSolver&) = delete;
  TvGaborSolver& operator=(const TvGaborSolver&) = delete;

  /// Takes steps until one of the reasons to stop holds; the certificate is then that of the last
  /// one. \param max_steps  after which no steps are left
  [[nodiscard]] SolverStop run(int max_steps, Patience patience);

  /// Texture on the torus and gap at the last check; empty before the first.
  [[nodiscard]] const TvGaborCertificate<Real>& certificate() const noexcept {
    return certificate_;
  }
  /// Steps taken, those of the former solver among them.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] const VectorField<Real>& z() const noexcept { return admm_.z(); }
  [[nodiscard]] const PenaltySchedule& schedule() const noexcept { return schedule_; }

 private:
  void step_to_check(int last);
  [[nodiscard]] bool is_stalled() const;

  double wanted_gap_;
  TvGaborProblem<Real> problem_;
  RealFft<Real> fft_;
  PenaltySchedule schedule_;
  TvGaborAdmm<Real> admm_;
  TvGaborCertificate<Real> certificate_;
  std::vector<double> gaps_;  // at every check of this solver
  int steps_ = 0;
};

}  // namespace touchtrial::engine
