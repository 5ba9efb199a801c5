#include "bench/closed_loop/sampled_wall.hpp"

#include "device/model/device_model.hpp"

#include <algorithm>
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

/// The friction that absorbs the energy of a triangular motion across the edge of a step, beyond
/// what the damping of `passivity_bound` dissipates.
/// \param half_mm  from the edge to where the motion turns
double friction_for_triangle(const SampledWall& wall, int side, double half_mm) {
  const int period = 2 * side;
  const double edge_mm = 0.5 * wall.step_mm;
  const auto position_mm = [&](int k) {
    const int at = ((k % period) + period) % period;
    const double share = static_cast<double>(at < side ? at : period - at) / side;
    return edge_mm + half_mm * (2.0 * share - 1.0);
  };
  double given_n_mm = 0.0;
  for (int k = 0; k < period; ++k) {
    const double read_mm =
        wall.step_mm * std::round(position_mm(k - wall.delay_ticks) / wall.step_mm);
    const double force_n = -wall.stiffness_n_per_m * read_mm / kMmPerM;
    given_n_mm += force_n * (position_mm(k + 1) - position_mm(k));
  }
  const double way_mm = 4.0 * half_mm;
  const double speed_mm_s = way_mm / (period * wall.period_s);
  return given_n_mm / way_mm - passivity_bound(wall) * speed_mm_s / kMmPerM;
}

/// A modelled device that is pressed on the wall.
class PressedDevice {
 public:
  /// \param mass_kg  of the device and what moves with it
  PressedDevice(const SampledWall& wall, double mass_kg, double damping_n_s_per_m,
                double friction_n)
      : wall_(wall),
        mass_kg_(mass_kg),
        tip_(model_of(wall, damping_n_s_per_m, friction_n), wall.period_s) {}

  /// Puts it there, at rest, and lets it go.
  /// \param push_n  against the wall's spring
  void let_go(double place_mm, double push_n) {
    tip_.place({place_mm, 0.0, 0.0});
    push_n_ = push_n;
  }
  void step() {
    const double force_n = -(wall_.stiffness_n_per_m * tip_.read_position_mm().x +
                             wall_.damping_n_s_per_m * tip_.read_velocity_mm_s().x) /
                           kMmPerM;
    device::DeviceDynamics::Outside outside;
    outside.force_n = {push_n_, 0.0, 0.0};
    outside.mass_kg = mass_kg_;
    tip_.tick({force_n, 0.0, 0.0}, outside);
  }
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
    model.velocity_readings = wall.velocity_readings;
    model.delay_ticks = wall.delay_ticks;
    model.zero_order_hold = true;
    return model;
  }

  SampledWall wall_;
  double mass_kg_;
  device::DeviceDynamics tip_;
  double push_n_ = 0.0;
};

/// Whether the second half of the motion has smaller oscillations than the first.
bool calms_down(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  constexpr int kSamples = 40'000;
  PressedDevice device(wall, mass_kg, damping_n_s_per_m, 0.0);
  device.let_go(1.0, 0.0);
  double first = 0.0;
  double second = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    device.step();
    double& half = k < kSamples / 2 ? first : second;
    if (k > kSamples / 100) half += device.position_mm() * device.position_mm();
    if (!(std::abs(device.position_mm()) < 1e6)) return false;
  }
  return second < first * (1.0 - 1.0 / 50.0);
}

/// Pushes between two steps, as a share of a step's force: the middle is where friction has most to
/// hold.
constexpr double kPushes[] = {0.1, 0.3, 0.5, 0.7, 0.9};
constexpr int kManySteps = 20;

double push_between(const SampledWall& wall, double share) {
  return (kManySteps + share) * wall.stiffness_n_per_m * wall.step_mm / kMmPerM;
}

bool comes_to_rest(const SampledWall& wall, double mass_kg, double damping_n_s_per_m,
                   double friction_n) {
  constexpr int kSamples = 20'000;
  return std::ranges::all_of(kPushes, [&](double share) {
    PressedDevice device(wall, mass_kg, damping_n_s_per_m, friction_n);
    device.let_go((kManySteps + share) * wall.step_mm, push_between(wall, share));
    for (int k = 0; k < kSamples; ++k) device.step();
    return device.speed_mm_s() == 0.0;
  });
}

/// \return the least value that is enough, within 2^-24 of the first guess
template <typename Enough>
double least_of(double most, const Enough& is_enough) {
  double least = 0.0;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (least + most);
    (is_enough(middle) ? most : least) = middle;
  }
  return most;
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

double damping_for_rest(const SampledWall& wall) {
  constexpr double kHeaviness = 0.01;
  const double lag_s = wall.period_s + 2.0 * delay_s(wall);
  const double mass_kg = wall.stiffness_n_per_m * lag_s * lag_s / kHeaviness;
  return least_of(10.0 * passivity_bound(wall), [&](double damping_n_s_per_m) {
    return calms_down(wall, mass_kg, damping_n_s_per_m);
  });
}

double friction_bound(const SampledWall& wall) noexcept {
  return 0.5 * wall.stiffness_n_per_m * wall.step_mm / kMmPerM;
}

double friction_by_energy(const SampledWall& wall) {
  double most = 0.0;
  for (int side = 1; side <= 8; side *= 2) {
    for (double half_mm = 0.5 * wall.step_mm; half_mm > 1e-4 * wall.step_mm; half_mm *= 0.5) {
      most = std::max(most, friction_for_triangle(wall, side, half_mm));
    }
  }
  return most;
}

double friction_for_rest(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  return least_of(4.0 * friction_bound(wall), [&](double friction_n) {
    return comes_to_rest(wall, mass_kg, damping_n_s_per_m, friction_n);
  });
}

LimitCycle limit_cycle(const SampledWall& wall, double mass_kg, double damping_n_s_per_m) {
  constexpr int kSamples = 40'000;
  PressedDevice device(wall, mass_kg, damping_n_s_per_m, 0.0);
  device.let_go((kManySteps + 0.5) * wall.step_mm, push_between(wall, 0.5));
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
