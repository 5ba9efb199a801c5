#include "protocols/session/interval_run.hpp"

#include "study/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchtrial::session {
namespace {

// The stroke that is played: as instructions ask for.
constexpr double kPlayedMmS = 100.0;
constexpr double kPlayedLoadN = 0.7;
constexpr double kShareOfPlane = 0.35;  ///< radius re the shorter side

}  // namespace

Vec3 IntervalForce::force_n(const device::DeviceSample& sample) noexcept {
  has_lifted_ = has_lifted_ || sample.position_mm.z > study::kLiftedMm;
  if (!has_lifted_) return {};
  const double wall_n = -stiffness_n_per_mm_ * sample.position_mm.z;
  const double speed_mm_s = std::hypot(sample.velocity_mm_s.x, sample.velocity_mm_s.y);
  const bool explores = wall_n >= windows_.lightest_n && wall_n <= windows_.strongest_n &&
                        speed_mm_s >= windows_.slowest_mm_s && speed_mm_s <= windows_.fastest_mm_s;
  if (explores && left_ > 0) --left_;
  return model_.force_n(sample.position_mm, sample.velocity_mm_s, touch_);
}

Vec3 PlayedForce::force_n(const device::DeviceSample& /*sample*/) noexcept {
  const double radius_mm = kShareOfPlane * std::min(plane_.width_mm(), plane_.height_mm());
  const double turn = kPlayedMmS / radius_mm * static_cast<double>(tick_++) / rate_hz_;
  if (left_ > 0) --left_;
  const Vec3 at_mm{plane_.width_mm() / 2.0 + radius_mm * std::cos(turn),
                   plane_.height_mm() / 2.0 + radius_mm * std::sin(turn),
                   -kPlayedLoadN / stiffness_n_per_mm_};
  const Vec3 whole_n = model_.force_n(at_mm, {}, touch_);
  return {whole_n.x, whole_n.y, 0.0};
}

IntervalsEnd run_intervals(SessionDesk& desk, const study::Presentation& shown, bool practice,
                           const IntervalListener& listener) {
  const SessionParts& parts = desk.parts();
  const study::Study& study = parts.key.study;
  const study::IntervalPlan plan = study.protocol->interval_plan(study).value();
  const device::ServoOptions servo = desk.servo_options();
  const auto ticks = std::max<std::int64_t>(1, std::llround(plan.seconds * servo.rate_hz));
  const double stiffness_n_per_mm = study.rendering.stiffness_n_per_mm;
  const int of = static_cast<int>(shown.intervals.size());
  int pauses = 0;  // before the first plane
  for (int i = 0; i < of; ++i) {
    if (!desk.attend(IntervalStep{shown.trial, practice, i + 1, of, shown.hand_off})) {
      return IntervalsEnd::broken_off;
    }
    if (i == 0) pauses = desk.pauses();
    if (desk.pauses() != pauses) return IntervalsEnd::paused;
    const engine::RenderingModel model =
        parts.source.plane_of(shown.intervals[static_cast<std::size_t>(i)]);
    IntervalForce felt(model, stiffness_n_per_mm, plan.windows, ticks);
    PlayedForce played(model, parts.source.plane(), stiffness_n_per_mm, ticks, servo.rate_hz);
    device::ForceSource& force = shown.hand_off ? static_cast<device::ForceSource&>(played) : felt;
    record::Trace* const trace = listener.plane_on();
    if (trace == nullptr) return IntervalsEnd::paused;
    const Exploration done = desk.explore(force, parts.source.plane(), servo, *trace);
    listener.explored(done);
    if (is_interrupted(done.servo)) return IntervalsEnd::interrupted;
    if (desk.was_cut_short()) return IntervalsEnd::paused;
    if (!force.is_done()) return IntervalsEnd::not_explored;
  }
  return IntervalsEnd::explored;
}

}  // namespace touchtrial::session
