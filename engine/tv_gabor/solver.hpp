/// \file The course of a TV-Gabor decomposition: steps, checks, a penalty that follows the image.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/admm.hpp"
#include "engine/tv_gabor/certificate.hpp"
#include "engine/tv_gabor/problem.hpp"

#include <vector>

namespace touchtrial {

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
  /// \param image  not flat, not empty. Keeps a reference to the options.
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options);
  /// Goes on where a solver of the same image and options, of another precision, stopped.
  template <typename Other>
  TvGaborSolver(const GreyImage& image, const TvGaborOptions& options,
                const TvGaborSolver<Other>& former);

  TvGaborSolver(const TvGaborSolver&) = delete;
  TvGaborSolver& operator=(const TvGaborSolver&) = delete;

  /// Takes steps until one of the reasons to stop holds.
  SolverStop run(Patience patience);

  /// Texture on the torus and gap at the last check; empty before a run.
  [[nodiscard]] const TvGaborCertificate<Real>& certificate() const noexcept {
    return certificate_;
  }
  /// Steps taken, those of the former solver among them.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] const TvGaborAdmm<Real>& admm() const noexcept { return admm_; }

 private:
  void check();
  void balance(const AdmmResiduals& residuals);
  [[nodiscard]] bool is_stalled() const;

  const TvGaborOptions& options_;
  TvGaborProblem<Real> problem_;
  RealFft<Real> fft_;
  double first_penalty_;
  TvGaborAdmm<Real> admm_;
  TvGaborCertificate<Real> certificate_;
  std::vector<double> gaps_;  // at every check of this solver
  int steps_ = 0;
};

}  // namespace touchtrial
