#include "device/model/device_model.hpp"

#include "device/safety/safety_limits.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace touchtrial::device {
namespace {

/// The stops at the ends of a workspace: stiff and well damped, so that a handle comes to rest.
constexpr double kStopNPerMm = 5.0;
constexpr double kStopNSPerMm = 0.05;

/// \return f(a, b, ...) on each axis
template <typename Function, typename... Vectors>
Vec3 map_axes(const Function& f, const Vectors&... vectors) noexcept {
  return {f(vectors.x...), f(vectors.y...), f(vectors.z...)};
}

Vec3 whole_steps(Vec3 a, double step) noexcept {
  return map_axes([step](double value) { return step * std::nearbyint(value / step); }, a);
}

double checked_tick(double tick_s) {
  constexpr double kMaxTickS = 0.01;
  if (tick_s > 0.0 && tick_s <= kMaxTickS) return tick_s;
  throw std::invalid_argument("DeviceDynamics: a tick must be in (0, 0.01] s");
}

const DeviceModel& checked_model(const DeviceModel& model) {
  check_device_model(model);
  return model;
}

/// \return the nearest point of the workspace; nothing if the position is inside it
std::optional<Vec3> nearest_point(const Workspace& workspace, Vec3 position_mm) noexcept {
  if (workspace.shape == WorkspaceShape::box) {
    const auto clamped = [](double value, double low, double high) {
      return std::clamp(value, low, high);
    };
    const Vec3 end_mm = map_axes(clamped, position_mm, workspace.min_mm, workspace.max_mm);
    return end_mm == position_mm ? std::nullopt : std::optional(end_mm);
  }
  const Vec3 middle_mm = 0.5 * (workspace.min_mm + workspace.max_mm);
  const Vec3 half_mm = workspace.max_mm - middle_mm;
  const Vec3 from_middle_mm = position_mm - middle_mm;
  const double radii = norm(map_axes([](double distance, double half) { return distance / half; },
                                     from_middle_mm, half_mm));
  if (radii <= 1.0) return std::nullopt;
  return middle_mm + (1.0 / radii) * from_middle_mm;
}

}  // namespace

DeviceDynamics::DeviceDynamics(const DeviceModel& model, double tick_s)
    : model_(checked_model(model)),
      tick_s_(checked_tick(tick_s)),
      static_n_(std::max(model.static_n, model.coulomb_n)),
      has_motors_(model.delay_ticks > 0 || model.max_force_n > 0.0 || model.force_step_n > 0.0 ||
                  model.lowpass_hz > 0.0 ||
                  model.planted_faults.force_sign_scale !=
                      DeviceModel::PlantedFaults{}.force_sign_scale),
      has_friction_(static_n_ > 0.0),
      has_true_readings_(model.position_step_mm == 0.0 && model.velocity_readings == 0 &&
                         model.planted_faults.position_noise_mm == 0.0) {
  if (model.structure.stiffness_n_per_mm > 0.0) {
    const double k = model.structure.stiffness_n_per_mm;
    tip_kg_ = model.structure.tip_share * model.mass_kg;
    joint_ = 0.25 * k * tick_s + model.structure.damping_ratio * std::sqrt(k * kMPerMm * tip_kg_);
  }
  if (model.lowpass_hz > 0.0) {
    filter_share_ = -std::expm1(-2.0 * std::numbers::pi * model.lowpass_hz * tick_s);
  }
  if (model.planted_faults.position_noise_mm > 0.0) {
    noise_.emplace(model.planted_faults.seed, "device model's position noise");
  }
  is_plain_ = !has_motors_ && !has_friction_ && has_true_readings_ && joint_ == 0.0 &&
              model.planted_faults.gravity_n == 0.0;
  delayed_n_.resize(static_cast<std::size_t>(model.delay_ticks));
  readings_mm_.resize(static_cast<std::size_t>(model.velocity_readings));
  place({});
}

void DeviceDynamics::place(Vec3 position_mm) noexcept {
  tip_mm_ = motor_mm_ = position_mm;
  tip_mm_s_ = motor_mm_s_ = {};
  filtered_n_ = delivered_n_ = {};
  std::ranges::fill(delayed_n_, Vec3{});
  take_reading();
  std::ranges::fill(readings_mm_, read_mm_);
  read_mm_s_ = {};
}

Vec3 DeviceDynamics::motor_force_n(const Vec3& commanded_n) noexcept {
  Vec3 force_n = copy_by_component(commanded_n);
  if (!delayed_n_.empty()) {
    std::swap(force_n, delayed_n_[next_command_]);
    if (++next_command_ == delayed_n_.size()) next_command_ = 0;
  }
  if (model_.max_force_n > 0.0) {
    const double magnitude_n = norm(force_n);
    if (magnitude_n > model_.max_force_n) force_n = (model_.max_force_n / magnitude_n) * force_n;
  }
  if (model_.force_step_n > 0.0) force_n = whole_steps(force_n, model_.force_step_n);
  if (model_.lowpass_hz > 0.0) {
    filtered_n_ = filtered_n_ + filter_share_ * (force_n - filtered_n_);
    force_n = filtered_n_;
  }
  const auto product = [](double a, double b) { return a * b; };
  return map_axes(product, force_n, model_.planted_faults.force_sign_scale);
}

double DeviceDynamics::friction_n(double speed_mm_s) const noexcept {
  if (model_.stribeck_mm_s == 0.0) return model_.coulomb_n;
  const double ratio = speed_mm_s / model_.stribeck_mm_s;
  return model_.coulomb_n + (static_n_ - model_.coulomb_n) * std::exp(-ratio * ratio);
}

/// \param velocity_mm_s  before the tick
/// \param stop_n  the friction that would stop the motion within the tick
/// \param free_mm_s  the velocity after the tick without friction
/// \return the velocity after the tick: zero if friction suffices to stop the motion, else reduced
///   by the share of friction in `stop_n`
Vec3 DeviceDynamics::apply_friction(const Vec3& velocity_mm_s, const Vec3& stop_n,
                                    const Vec3& free_mm_s) const noexcept {
  const auto remaining_share = [this](double before_mm_s, double needed_n, double speed_mm_s) {
    const double slip_n = friction_n(speed_mm_s);
    const double hold_n = before_mm_s == 0.0 ? static_n_ : slip_n;
    return needed_n <= hold_n ? 0.0 : 1.0 - slip_n / needed_n;
  };
  if (model_.friction == FrictionShape::isotropic) {
    return remaining_share(norm(velocity_mm_s), norm(stop_n), norm(free_mm_s)) * free_mm_s;
  }
  const auto on_axis = [&](double before, double needed, double free) {
    return remaining_share(before, std::abs(needed), std::abs(free)) * free;
  };
  return map_axes(on_axis, velocity_mm_s, stop_n, free_mm_s);
}

/// Two masses and the spring between them, by the trapezium rule, which neither damps nor excites
/// their resonance; damping to ground is implicit, as in a rigid device. Equations:
/// docs/devices/models.md.
void DeviceDynamics::move_structure(const Vec3& motor_n, const TipLoad& load) noexcept {
  const double joint = joint_;
  const double motor_mass = kMPerMm * (model_.mass_kg - tip_kg_) / tick_s_;
  const double tip_mass = kMPerMm * (tip_kg_ + load.mass_kg) / tick_s_;
  const double motor_coefficient = motor_mass + kMPerMm * model_.viscous_n_s_per_m + joint;

  const Vec3 spring_n = model_.structure.stiffness_n_per_mm * (motor_mm_ - tip_mm_) +
                        joint * (motor_mm_s_ - tip_mm_s_);
  const Vec3 on_motor_n = motor_n + motor_mass * motor_mm_s_ - spring_n;
  const Vec3 on_tip_n = load.force_n + tip_mass * tip_mm_s_ + spring_n;
  const Vec3 tip_coefficients =
      map_axes([=](double d) { return tip_mass + d + joint; }, load.damping_n_s_per_mm);

  const auto stop_force = [=](double motor, double tip, double c) {
    return motor + joint * tip / c;
  };
  const auto motor_velocity = [=](double stop_n, double c) {
    return stop_n / (motor_coefficient - joint * joint / c);
  };
  const auto tip_velocity = [=](double tip, double motor_mm_s, double c) {
    return (tip + joint * motor_mm_s) / c;
  };
  const Vec3 stop_n = map_axes(stop_force, on_motor_n, on_tip_n, tip_coefficients);
  Vec3 motor_mm_s = map_axes(motor_velocity, stop_n, tip_coefficients);
  if (has_friction_) motor_mm_s = apply_friction(motor_mm_s_, stop_n, motor_mm_s);
  const Vec3 tip_mm_s = map_axes(tip_velocity, on_tip_n, motor_mm_s, tip_coefficients);

  motor_mm_ = motor_mm_ + 0.5 * tick_s_ * (motor_mm_s_ + motor_mm_s);
  tip_mm_ = tip_mm_ + 0.5 * tick_s_ * (tip_mm_s_ + tip_mm_s);
  motor_mm_s_ = motor_mm_s;
  tip_mm_s_ = tip_mm_s;
}

void DeviceDynamics::update_reading() noexcept {
  if (noise_) {
    const double deviation_mm = model_.planted_faults.position_noise_mm;
    read_mm_ =
        map_axes([&](double value) { return value + deviation_mm * noise_->normal(); }, read_mm_);
  }
  if (model_.position_step_mm > 0.0) read_mm_ = whole_steps(read_mm_, model_.position_step_mm);
  if (readings_mm_.empty()) {
    read_mm_s_ = copy_by_component(joint_ > 0.0 ? motor_mm_s_ : tip_mm_s_);
  } else {
    estimate_velocity();
  }
}

/// The least-squares line through n readings at equal times has the slope
/// 6 / (n (n^2 - 1) T) * sum over i = 0 .. n - 1 of (2 i - (n - 1)) x_i.
void DeviceDynamics::estimate_velocity() noexcept {
  const std::size_t n = readings_mm_.size();
  const Vec3 now_mm = copy_by_component(read_mm_);
  readings_mm_[next_reading_] = now_mm;
  if (++next_reading_ == n) next_reading_ = 0;
  const double count = static_cast<double>(n);
  Vec3 sum_mm;
  double weight = 1.0 - count;
  std::size_t index = next_reading_;  // the oldest
  for (std::size_t i = 0; i < n; ++i, weight += 2.0) {
    sum_mm = sum_mm + weight * (readings_mm_[index] - now_mm);
    if (++index == n) index = 0;
  }
  read_mm_s_ = (6.0 / (count * (count * count - 1.0) * tick_s_)) * sum_mm;
}

ModelledDevice::ModelledDevice(DeviceModel model, Hand hand)
    : model_(std::move(model)), dynamics_(model_, kServoTickS), hand_(std::move(hand)) {
  if (model_.workspace) {
    dynamics_.place(0.5 * (model_.workspace->min_mm + model_.workspace->max_mm));
  }
}

std::chrono::nanoseconds ModelledDevice::now() const noexcept {
  return tick_ * kServoTick;
}

double ModelledDevice::time_s() const noexcept {
  return static_cast<double>(tick_) * kServoTickS;
}

bool ModelledDevice::is_silent() const noexcept {
  return model_.planted_faults.silent_after_s > 0.0 &&
         time_s() >= model_.planted_faults.silent_after_s;
}

bool ModelledDevice::is_lost() const noexcept {
  return model_.planted_faults.lost_after_s > 0.0 && time_s() >= model_.planted_faults.lost_after_s;
}

DeviceInfo ModelledDevice::info() const {
  DeviceInfo info;
  info.name = "modelled";
  info.model = model_.name;
  info.simulated = true;
  info.max_force_n = model_.max_force_n > 0.0 ? model_.max_force_n : SafetyLimits{}.max_force_n;
  info.continuous_force_n = model_.continuous_force_n;
  info.workspace = model_.workspace;
  info.max_stiffness_n_per_mm = model_.max_stiffness_n_per_mm;
  return info;
}

DeviceStatus ModelledDevice::read(DeviceSample& sample) noexcept {
  if (is_lost()) return DeviceStatus::fault;
  if (!is_silent()) {
    last_sample_.position_mm = dynamics_.read_position_mm();
    last_sample_.velocity_mm_s = dynamics_.read_velocity_mm_s();
    last_sample_.sequence = static_cast<std::uint64_t>(tick_) + 1;
  }
  sample = last_sample_;
  return DeviceStatus::ok;
}

DeviceStatus ModelledDevice::write(Vec3 force_n) noexcept {
  const bool is_link_lost = is_lost();
  const bool is_off = is_link_lost || is_silent() || halted_.load();
  DeviceDynamics::TipLoad load;
  const Vec3 position_mm = dynamics_.true_position_mm();
  if (hand_) load = hand_(time_s(), position_mm, dynamics_.true_velocity_mm_s());
  if (model_.workspace) {
    if (const auto end_mm = nearest_point(*model_.workspace, position_mm)) {
      load.force_n = load.force_n - kStopNPerMm * (position_mm - *end_mm);
      load.damping_n_s_per_mm =
          load.damping_n_s_per_mm + Vec3{kStopNSPerMm, kStopNSPerMm, kStopNSPerMm};
    }
  }
  dynamics_.tick(is_off ? Vec3{} : force_n, load);
  ++tick_;
  return is_link_lost ? DeviceStatus::fault : DeviceStatus::ok;
}

DeviceFault ModelledDevice::fault() const noexcept {
  return is_lost() ? DeviceFault::link_lost : DeviceFault::none;
}

}  // namespace touchtrial::device
