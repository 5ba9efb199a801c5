#include "device/drivers/simulated/simulated_hand.hpp"

#include "device/drivers/drivers.hpp"
#include "device/drivers/registry.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace touchtrial::device {
namespace {

/// The part of the plane in which the path stays.
struct PathArea {
  double left_mm, right_mm, top_mm, bottom_mm;

  [[nodiscard]] double shorter_side_mm() const {
    return std::min(right_mm - left_mm, bottom_mm - top_mm);
  }
  [[nodiscard]] Vec2 draw_point(RandomStream& random) const {
    const double x_mm = random.uniform(left_mm, right_mm);
    return {x_mm, random.uniform(top_mm, bottom_mm)};
  }
};

void check(const PlaneGeometry& plane, const ExplorationOptions& options) {
  const bool plane_ok = plane.width_mm() > 0.0 && plane.height_mm() > 0.0;
  const bool speeds_ok = options.slowest_mm_s > 0.0 && options.fastest_mm_s >= options.slowest_mm_s;
  if (!plane_ok) throw std::invalid_argument("ExplorationPath: the plane has no area");
  if (!speeds_ok || !(options.margin_mm >= 0.0) || !(options.duration_s > 0.0)) {
    throw std::invalid_argument("ExplorationPath: speed, margin or duration is out of range");
  }
}

PathArea path_area(const PlaneGeometry& plane, double margin_mm) {
  const double x_mm = std::min(margin_mm, plane.width_mm() / 5.0);
  const double y_mm = std::min(margin_mm, plane.height_mm() / 5.0);
  return {x_mm, plane.width_mm() - x_mm, y_mm, plane.height_mm() - y_mm};
}

/// Draws until the point is far enough away. At least a fifth of the area is, so a few draws
/// suffice.
Vec2 next_point(Vec2 start_mm, const PathArea& area, RandomStream& random) {
  Vec2 point_mm = area.draw_point(random);
  while (norm(point_mm - start_mm) < area.shorter_side_mm() / 2.0) {
    point_mm = area.draw_point(random);
  }
  return point_mm;
}

/// \param u  share of the ramp's duration, in [0, 1]
/// \return the share of the final speed
double ramp_speed(double u) noexcept {
  return u * u * (3.0 - 2.0 * u);
}
/// \return the distance covered, as a share of a ramp's duration at the final speed
double ramp_distance(double u) noexcept {
  return u * u * u * (1.0 - u / 2.0);
}

/// The plane and duration of a simulated hand that is opened by its driver's name.
constexpr PlaneGeometry kDriverPlane{0.2, 500, 500};
constexpr double kDriverExploreS = 8.0 * 3600.0;

std::vector<DeviceListing> list_simulated(const DeviceSettings&) {
  DeviceListing listing;
  listing.driver = "simulated";
  listing.model = "simulated hand";
  listing.present = true;
  return {listing};
}

std::unique_ptr<HapticDevice> open_simulated(const DeviceSettings& settings) {
  RandomStream random(1, "simulated device");
  HandOptions hand;
  hand.explore_s = kDriverExploreS;
  ExplorationOptions exploration;
  exploration.duration_s = kDriverExploreS;
  const std::string& model = settings.simulated_device;
  return std::make_unique<SimulatedHand>(hand, ExplorationPath(kDriverPlane, exploration, random),
                                         model.empty() ? DeviceModel{} : model_of_device(model));
}

}  // namespace

ExplorationPath::Ramps ExplorationPath::ramps_at(double elapsed_s, double remaining_s) noexcept {
  const double up = std::clamp(elapsed_s / kRampS, 0.0, 1.0);
  const double down = std::clamp(remaining_s / kRampS, 0.0, 1.0);
  // Speeding up covers ramp_distance(up). Slowing down covers half a ramp in total, of which
  // ramp_distance(down) remains.
  return {kRampS * (ramp_distance(up) + 0.5 - ramp_distance(down)),
          std::min(ramp_speed(up), ramp_speed(down))};
}

ExplorationPath::Stroke ExplorationPath::stroke_between(Vec2 start_mm, Vec2 end_mm, double start_s,
                                                        double speed_mm_s) noexcept {
  const double length_mm = norm(end_mm - start_mm);
  Stroke stroke;
  stroke.start_s = start_s;
  stroke.steady_s = std::max(length_mm / speed_mm_s, kRampS);
  stroke.speed_mm_s = length_mm / stroke.steady_s;
  stroke.start_mm = start_mm;
  stroke.direction = (1.0 / length_mm) * (end_mm - start_mm);
  return stroke;
}

ExplorationPath::ExplorationPath(const PlaneGeometry& plane, const ExplorationOptions& options,
                                 RandomStream& random) {
  check(plane, options);
  const PathArea area = path_area(plane, options.margin_mm);
  Vec2 start_mm = area.draw_point(random);
  for (double start_s = 0.0; start_s < options.duration_s; start_s = strokes_.back().end_s()) {
    const Vec2 end_mm = next_point(start_mm, area, random);
    const double speed_mm_s = random.uniform(options.slowest_mm_s, options.fastest_mm_s);
    strokes_.push_back(stroke_between(start_mm, end_mm, start_s, speed_mm_s));
    start_mm = end_mm;
  }
}

std::string simulated_device_name(const DeviceModel& held) {
  const bool is_ideal = held.name.empty() || held.name == "ideal";
  return is_ideal ? "simulated" : "simulated " + held.name;
}

SimulatedHand::SimulatedHand(const HandOptions& options, ExplorationPath path,
                             const DeviceModel& device)
    : options_(options),
      path_(std::move(path)),
      held_(options, device, kServoTickS),
      max_force_n_(device.max_force_n > 0.0 ? std::min(device.max_force_n, options.max_force_n)
                                            : options.max_force_n),
      device_(device) {
  last_tick_ = std::llround(options.explore_s * kServoRateHz);
  const Vec2 first_mm = path_.at(0.0, stroke_).position_mm;
  held_.place({first_mm.x, first_mm.y, options.start_height_mm});
}

HeldDevice SimulatedHand::make_free_device() const {
  // Motors and readings are disabled, because it receives no commands and is not read.
  DeviceModel model = device_;
  model.delay_ticks = 0;
  model.lowpass_hz = model.force_step_n = model.max_force_n = 0.0;
  model.position_step_mm = 0.0;
  model.velocity_readings = 0;
  model.planted_faults = {};
  HeldDevice free_held(options_, model, kServoTickS);
  free_held.place(held_.device.true_position_mm());
  return free_held;
}

void SimulatedHand::set_sense(TipSense& sense) {
  if (precomputed_ == nullptr) free_device_.emplace(make_free_device());
  sense_ = &sense;
}

void SimulatedHand::precompute() {
  auto free_ticks = std::make_shared<std::vector<FreeTick>>();
  free_ticks->reserve(static_cast<std::size_t>(last_tick_) + 1);
  HeldDevice free_held = make_free_device();
  std::size_t stroke = 0;
  // A stopped hand receives one final force of zero.
  for (std::int64_t tick = 0; tick <= last_tick_; ++tick) {
    const Intention intention = intention_at(tick, stroke);
    static_cast<void>(free_held.tick({}, intention.target, intention.push_n));
    const Vec3& tip_mm_s = free_held.device.true_velocity_mm_s();
    free_ticks->push_back({intention, {tip_mm_s.x, tip_mm_s.y}});
  }
  precomputed_ = std::move(free_ticks);
}

DeviceInfo SimulatedHand::info() const {
  return {"simulated", "", max_force_n_, true};
}

std::chrono::nanoseconds SimulatedHand::now() const noexcept {
  return tick_ * kServoTick;
}

DeviceDriver simulated_driver() {
  return {"simulated", "a simulated hand that strokes a blank plane", list_simulated,
          open_simulated};
}

}  // namespace touchtrial::device
