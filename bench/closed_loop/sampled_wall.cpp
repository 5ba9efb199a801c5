#include "bench/closed_loop/sampled_wall.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace touchtrial::bench {
namespace {

/// The damping b that absorbs the energy of one triangular motion with `side` samples on each side.
double damping_for_triangle(const SampledWall& wall, int side) {
  const double speed_m_s = 1.0 / wall.period_s;  // one metre per sample: the wall is linear
  const int period = 2 * side;
  const auto position_m = [&](int k) {
    const int at = ((k % period) + period) % period;
    return static_cast<double>(at < side ? at : period - at) - 0.5 * side;
  };
  double given_j = 0.0;
  for (int k = 0; k < period; ++k) {
    const double rate_m_s = (position_m(k) - position_m(k - 1)) / wall.period_s;
    const double force_n =
        -(wall.stiffness_n_per_m * position_m(k) + wall.damping_n_s_per_m * rate_m_s);
    given_j += force_n * (position_m(k + 1) - position_m(k));
  }
  return given_j / (speed_m_s * speed_m_s * period * wall.period_s);
}

/// A mass with physical damping under the force of a wall.
class HeldMass {
 public:
  HeldMass(const SampledWall& wall, double mass_kg, double damping_n_s_per_m)
      : wall_(wall), damping_(damping_n_s_per_m), time_s_(mass_kg / damping_n_s_per_m) {
    left_ = -std::expm1(-wall.period_s / time_s_);
  }

  /// Moves on to the next sample.
  void step() {
    const double rate_m_s = (x_m_ - before_m_) / wall_.period_s;
    const double force_n = -(wall_.stiffness_n_per_m * x_m_ + wall_.damping_n_s_per_m * rate_m_s);
    const double last_m_s = force_n / damping_;  // the final velocity under a constant force
    const double extra_m_s = v_m_s_ - last_m_s;
    before_m_ = x_m_;
    x_m_ += last_m_s * wall_.period_s + extra_m_s * time_s_ * left_;
    v_m_s_ = last_m_s + extra_m_s * (1.0 - left_);
  }
  [[nodiscard]] double position_m() const { return x_m_; }

 private:
  SampledWall wall_;
  double damping_;
  double time_s_;
  double left_ = 0.0;
  double x_m_ = 1.0;
  double before_m_ = 1.0;
  double v_m_s_ = 0.0;
};

/// Whether the second half of the motion has smaller oscillations than the first.
bool comes_to_rest(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  constexpr int kSamples = 40'000;
  HeldMass mass(wall, mass_kg, damping_n_s_per_m);
  double first = 0.0;
  double second = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    mass.step();
    double& half = k < kSamples / 2 ? first : second;
    if (k > kSamples / 100) half += mass.position_m() * mass.position_m();
    if (!(std::abs(mass.position_m()) < 1e6)) return false;
  }
  return second < first * (1.0 - 1.0 / 50.0);
}

}  // namespace

double passivity_bound(const SampledWall& wall) noexcept {
  return 0.5 * wall.stiffness_n_per_m * wall.period_s + std::abs(wall.damping_n_s_per_m);
}

double damping_by_frequency(const SampledWall& wall, int frequencies) {
  double most = 0.0;
  for (int i = 1; i <= frequencies; ++i) {
    const double angle = std::numbers::pi * i / frequencies;
    const std::complex<double> z = std::polar(1.0, angle);
    const std::complex<double> response =
        wall.stiffness_n_per_m + wall.damping_n_s_per_m * (z - 1.0) / (wall.period_s * z);
    const double real = std::real((1.0 - 1.0 / z) * response);
    most = std::max(most, 0.5 * wall.period_s / (1.0 - std::cos(angle)) * real);
  }
  return most;
}

double damping_by_energy(const SampledWall& wall) {
  double most = 0.0;
  for (int side = 1; side <= 1024; side *= 2) {
    most = std::max(most, damping_for_triangle(wall, side));
  }
  return most;
}

double damping_for_rest(const SampledWall& wall, double mass_kg) {
  double least = 0.0;
  double most = 10.0 * passivity_bound(wall);
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (least + most);
    (comes_to_rest(wall, mass_kg, middle) ? most : least) = middle;
  }
  return most;
}

}  // namespace touchtrial::bench
