#include "engine/tv_gabor/solver.hpp"

#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial::engine {
namespace {

/// Rows of q = -p, computed on demand: the field itself stays as the solver needs it.
template <typename Real>
class DualRows {
 public:
  DualRows(const VectorField<Real>& field, double scale)
      : field_(field),
        scale_(static_cast<Real>(scale)),
        x_(static_cast<std::size_t>(field.x.width())),
        y_(x_.size()) {}

  void go_to(int y) {
    clip_row(field_.x.row(y).data(), field_.y.row(y).data(), x_.size(), scale_, x_.data(),
             y_.data());
  }
  [[nodiscard]] std::vector<Real>& x() noexcept { return x_; }
  [[nodiscard]] std::vector<Real>& y() noexcept { return y_; }

 private:
  const VectorField<Real>& field_;
  Real scale_;
  std::vector<Real> x_, y_;
};

template <typename Real>
void load_divergence(const VectorField<Real>& field, double scale, std::span<Real> plane) {
  DualRows<Real> q(field, scale);
  const int height = field.x.height();
  const auto width = static_cast<std::size_t>(field.x.width());
  q.go_to(height - 1);
  std::vector<Real> above = q.y();
  for (int y = 0; y < height; ++y) {
    q.go_to(y);
    negative_divergence_of_row<Real>(q.x(), q.y(), above,
                                     plane.subspan(static_cast<std::size_t>(y) * width, width));
    std::swap(above, q.y());
  }
}

template <typename Real>
Plane<Real> texture_of(const TvGaborProblem<Real>& problem, const VectorField<Real>& field,
                       double scale, RealFft<Real>& fft) {
  load_divergence(field, scale, fft.plane());
  fft.forward();
  const auto factor =
      static_cast<Real>(1.0 / (problem.lambda * static_cast<double>(problem.image.size())));
  const auto spectrum = fft.spectrum();
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    spectrum[i] *= factor * problem.spectrum.samples()[i];
  }
  fft.inverse();
  Plane<Real> texture(problem.image.height(), problem.image.width());
  std::copy(fft.plane().begin(), fft.plane().end(), texture.samples().begin());
  return texture;
}

/// With q = -p and u = f - v, the primal value is the sum of |grad u| + <q, grad v> / 2, and primal
/// minus dual is the sum of |grad u| - <q, grad u>: no term is negative, so nothing cancels between
/// pixels and the gap keeps its digits.
template <typename Real>
double relative_gap(const TvGaborProblem<Real>& problem, const Plane<Real>& texture,
                    const VectorField<Real>& field, double scale) {
  const std::size_t width = static_cast<std::size_t>(texture.width());
  std::vector<Real> u_x(width), u_y(width), v_x(width), v_y(width), steepness(width);
  DualRows<Real> q(field, scale);
  double primal = 0.0;
  double difference = 0.0;
  for (int y = 0; y < texture.height(); ++y) {
    const int below = y + 1 == texture.height() ? 0 : y + 1;
    gradient_of_row<Real>(problem.image.row(y), problem.image.row(below), u_x, u_y);
    gradient_of_row<Real>(texture.row(y), texture.row(below), v_x, v_y);
    for (std::size_t x = 0; x < width; ++x) {
      u_x[x] -= v_x[x];
      u_y[x] -= v_y[x];
    }
    norm_row(u_x.data(), u_y.data(), width, steepness.data());
    q.go_to(y);
    for (std::size_t x = 0; x < width; ++x) {
      const double q_x = q.x()[x];
      const double q_y = q.y()[x];
      primal += steepness[x] + 0.5 * (q_x * v_x[x] + q_y * v_y[x]);
      difference += std::max(0.0, steepness[x] - (q_x * u_x[x] + q_y * u_y[x]));
    }
  }
  return primal > 0.0 ? difference / primal : 0.0;
}

}  // namespace

template <typename Real>
TvGaborCertificate<Real> certify(const TvGaborProblem<Real>& problem,
                                 const VectorField<Real>& field, double scale, RealFft<Real>& fft) {
  TvGaborCertificate<Real> certificate;
  certificate.texture = texture_of(problem, field, scale, fft);
  certificate.gap = relative_gap(problem, certificate.texture, field, scale);
  return certificate;
}

template TvGaborCertificate<float> certify(const TvGaborProblem<float>&, const VectorField<float>&,
                                           double, RealFft<float>&);
template TvGaborCertificate<double> certify(const TvGaborProblem<double>&,
                                            const VectorField<double>&, double, RealFft<double>&);

namespace {

/// First penalty, in units of the inverse mean gradient.
constexpr double kFirst = 6.0;
constexpr double kFall = 0.86;
constexpr int kChecksOfFall = 20;

/// Primal residuals count six times: equal residuals leave the penalty too small for the gap.
constexpr double kPrimalEmphasis = 6.0;
/// Ratios of residuals up to this count as balanced.
constexpr double kDeadBand = 1.2;
/// One correction changes the penalty at most by this factor.
constexpr double kMostChange = 4.0;
/// The penalty stays within this factor of the first, either way.
constexpr double kRange = 1e4;

/// Momentum pauses after a check that finds more than this share of the last gap left.
constexpr double kHardlyAnyProgress = 0.95;

/// A solver stalls unless the gap falls to this share of itself within this many checks.
constexpr double kShareLeft = 0.7;
constexpr std::size_t kChecksToFall = 5;

}  // namespace

PenaltySchedule::PenaltySchedule(double mean_gradient)
    : first_penalty_(kFirst / mean_gradient), penalty_(first_penalty_) {}

bool PenaltySchedule::wants_residuals() const noexcept {
  return checks_ >= kChecksOfFall;
}

void PenaltySchedule::next(double gap, const AdmmResiduals& residuals) {
  ++checks_;
  pace_ =
      checks_ > 1 && gap > kHardlyAnyProgress * last_gap_ ? AdmmPace::cautious : AdmmPace::eager;
  last_gap_ = gap;
  if (checks_ <= kChecksOfFall) {
    penalty_ *= kFall;
  } else {
    balance(residuals);
  }
}

void PenaltySchedule::balance(const AdmmResiduals& residuals) {
  const double ratio = kPrimalEmphasis * residuals.primal / residuals.dual;
  if (!(ratio > kDeadBand || ratio < 1.0 / kDeadBand)) return;  // balanced, or not a number
  const double factor = std::clamp(std::sqrt(ratio), 1.0 / kMostChange, kMostChange);
  penalty_ = std::clamp(penalty_ * factor, first_penalty_ / kRange, first_penalty_ * kRange);
}

template <typename Real>
TvGaborSolver<Real>::TvGaborSolver(const GreyImage& image, const TvGaborOptions& options)
    : wanted_gap_(options.gap),
      problem_(tv_gabor_problem<Real>(image, options)),
      fft_(problem_.image.height(), problem_.image.width(), FftPlan::measured),
      schedule_(mean_gradient(problem_.image)),
      admm_(problem_, fft_, schedule_.penalty()) {
  admm_.start_again();
}

template <typename Real>
SolverStop TvGaborSolver<Real>::run(int max_steps, Patience patience) {
  while (steps_ < max_steps) {
    step_to_check(max_steps);
    if (certificate_.gap <= wanted_gap_) return SolverStop::converged;
    // Without steps left nobody can continue: the steps are exhausted, not stalled.
    const bool may_stall = patience == Patience::limited && steps_ < max_steps;
    if (may_stall && is_stalled()) return SolverStop::stalled;
  }
  return SolverStop::exhausted;
}

/// Certifies after every tenth step, because it costs as much as one; only then does the penalty
/// change.
template <typename Real>
void TvGaborSolver<Real>::step_to_check(int last) {
  const int left = PenaltySchedule::kStepsBetweenChecks;
  const int check = std::min(last, steps_ + left - steps_ % left);
  for (; steps_ < check - 1; ++steps_) admm_.step(schedule_.pace());
  AdmmResiduals residuals;
  if (schedule_.wants_residuals()) {
    residuals = admm_.measured_step();
  } else {
    admm_.step(AdmmPace::cautious);  // uninterrupted momentum can go round in circles
  }
  ++steps_;
  certificate_ = certify(problem_, admm_.z(), admm_.penalty(), fft_);
  gaps_.push_back(certificate_.gap);
  schedule_.next(certificate_.gap, residuals);
  if (schedule_.penalty() != admm_.penalty()) admm_.set_penalty(schedule_.penalty());
  admm_.start_again();
}

template <typename Real>
bool TvGaborSolver<Real>::is_stalled() const {
  return gaps_.size() > kChecksToFall &&
         gaps_.back() > kShareLeft * gaps_[gaps_.size() - 1 - kChecksToFall];
}

template class TvGaborSolver<float>;
template class TvGaborSolver<double>;

}  // namespace touchtrial::engine
