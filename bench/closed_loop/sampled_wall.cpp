#include "bench/closed_loop/sampled_wall.hpp"

#include "device/model/device_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace touchtrial::bench {
namespace {

constexpr double kMmPerM = 1000.0;

double delay_s(const SampledWall& wall) {
  return wall.period_s * static_cast<double>(wall.delay_ticks);
}

/// Factors of the newest samples, the newest first, in the slope of the line through them.
std::vector<double> slope_weights(const SampledWall& wall) {
  const double n = wall.velocity_readings;
  std::vector<double> weights;
  for (int age = 0; age < wall.velocity_readings; ++age) {
    weights.push_back(6.0 * (n - 1.0 - 2.0 * age) / (n * (n * n - 1.0) * wall.period_s));
  }
  return weights;
}

/// The damping b that absorbs the energy of one triangular motion with `side` samples on each side.
double damping_for_triangle(const SampledWall& wall, int side) {
  const double speed_m_s = 1.0 / wall.period_s;  // one metre per sample: the wall is linear
  const int period = 2 * side;
  const std::vector<double> slope = slope_weights(wall);
  const auto position_m = [&](int k) {
    const int at = ((k % period) + period) % period;
    return static_cast<double>(at < side ? at : period - at) - 0.5 * side;
  };
  double given_j = 0.0;
  for (int k = 0; k < period; ++k) {
    const int read = k - wall.delay_ticks;
    double rate_m_s = 0.0;
    for (std::size_t age = 0; age < slope.size(); ++age) {
      rate_m_s += slope[age] * position_m(read - static_cast<int>(age));
    }
    const double force_n =
        -(wall.stiffness_n_per_m * position_m(read) + wall.damping_n_s_per_m * rate_m_s);
    given_j += force_n * (position_m(k + 1) - position_m(k));
  }
  return given_j / (speed_m_s * speed_m_s * period * wall.period_s);
}

constexpr int kManySteps = 20;

/// A modelled device that is pressed on a wall without damping, from rest between two steps.
class PressedDevice {
 public:
  /// \param mass_kg  of the device and what moves with it
  /// \param share  of a step, at which the push and the wall's spring would balance
  PressedDevice(const SampledWall& wall, double mass_kg, double damping_n_s_per_m,
                double friction_n, double share)
      : stiffness_n_per_mm_(wall.stiffness_n_per_m / kMmPerM),
        outside_{.force_n = {(kManySteps + share) * stiffness_n_per_mm_ * wall.step_mm, 0.0, 0.0},
                 .mass_kg = mass_kg},
        tip_(model_of(wall, damping_n_s_per_m, friction_n), wall.period_s) {
    tip_.place({(kManySteps + share) * wall.step_mm, 0.0, 0.0});
  }

  void step() { tip_.tick({-stiffness_n_per_mm_ * tip_.read_position_mm().x, 0.0, 0.0}, outside_); }
  [[nodiscard]] double position_mm() const { return tip_.true_position_mm().x; }
  [[nodiscard]] double speed_mm_s() const { return std::abs(tip_.true_velocity_mm_s().x); }

 private:
  static device::DeviceModel model_of(const SampledWall& wall, double damping_n_s_per_m,
                                      double friction_n) {
    device::DeviceModel model;
    model.name = "pressed";
    model.viscous_n_s_per_m = damping_n_s_per_m;
    model.coulomb_n = friction_n;
    model.position_step_mm = wall.step_mm;
    model.zero_order_hold = true;
    return model;
  }

  double stiffness_n_per_mm_;
  device::DeviceDynamics::Outside outside_;
  device::DeviceDynamics tip_;
};

/// Under pushes at several places between two steps: in the middle friction has most to hold.
bool comes_to_rest(const SampledWall& wall, double mass_kg, double damping_n_s_per_m,
                   double friction_n) {
  constexpr int kSamples = 20'000;
  return std::ranges::all_of(std::array{0.1, 0.3, 0.5, 0.7, 0.9}, [&](double share) {
    PressedDevice device(wall, mass_kg, damping_n_s_per_m, friction_n, share);
    for (int k = 0; k < kSamples; ++k) device.step();
    return device.speed_mm_s() == 0.0;
  });
}

}  // namespace

double passivity_bound(const SampledWall& wall) noexcept {
  return wall.stiffness_n_per_m * (0.5 * wall.period_s + delay_s(wall)) +
         std::abs(wall.damping_n_s_per_m);
}

double damping_by_frequency(const SampledWall& wall, int frequencies) {
  const std::vector<double> slope = slope_weights(wall);
  double most = 0.0;
  for (int i = 1; i <= frequencies; ++i) {
    const double angle = std::numbers::pi * i / frequencies;
    std::complex<double> response = wall.stiffness_n_per_m;
    for (std::size_t age = 0; age < slope.size(); ++age) {
      response +=
          wall.damping_n_s_per_m * slope[age] * std::polar(1.0, -angle * static_cast<double>(age));
    }
    response *= std::polar(1.0, -angle * static_cast<double>(wall.delay_ticks));
    const double real = std::real((1.0 - std::polar(1.0, -angle)) * response);
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

double friction_bound(const SampledWall& wall) noexcept {
  return 0.5 * wall.stiffness_n_per_m * wall.step_mm / kMmPerM;
}

double friction_for_rest(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  double too_little_n = 0.0;
  double enough_n = 4.0 * friction_bound(wall);
  for (int i = 0; i < 24; ++i) {
    const double middle_n = 0.5 * (too_little_n + enough_n);
    (comes_to_rest(wall, mass_kg, damping_n_s_per_m, middle_n) ? enough_n : too_little_n) =
        middle_n;
  }
  return enough_n;
}

LimitCycle limit_cycle(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  constexpr int kSamples = 40'000;
  PressedDevice device(wall, mass_kg, damping_n_s_per_m, 0.0, 0.5);
  LimitCycle cycle;
  double least_mm = std::numeric_limits<double>::infinity();
  double greatest_mm = -least_mm;
  for (int k = 0; k < kSamples; ++k) {
    device.step();
    if (k < kSamples / 2) continue;
    cycle.mm_s += device.speed_mm_s() * device.speed_mm_s();
    least_mm = std::min(least_mm, device.position_mm());
    greatest_mm = std::max(greatest_mm, device.position_mm());
  }
  cycle.mm_s = std::sqrt(2.0 * cycle.mm_s / kSamples);
  cycle.mm = greatest_mm - least_mm;
  return cycle;
}

}  // namespace touchtrial::bench
