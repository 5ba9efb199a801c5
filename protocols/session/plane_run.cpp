#include "protocols/session/plane_run.hpp"

#include "study/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

namespace touchtrial::session {
namespace {

constexpr double kRadiusShare = 0.35;  ///< radius of a played stroke re the plane's shorter side

/// The force of one of several freely explored planes. It starts once the hand has been above the
/// plane.
class LiftedForce final : public device::ForceSource {
 public:
  explicit LiftedForce(const engine::RenderingModel& model) noexcept : force_(model) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    has_lifted_ = has_lifted_ || sample.position_mm.z > study::kLiftedMm;
    return has_lifted_ ? force_.force_n(sample) : Vec3{};
  }

 private:
  ModelForce force_;
  bool has_lifted_ = false;
};

/// Makes the force of one plane of a trial.
/// \param planes  number of planes of the trial
/// \param model  must outlive the force
std::unique_ptr<device::ForceSource> force_of(const study::ExplorationMode& exploring, int planes,
                                              const engine::RenderingModel& model,
                                              const SessionDesk& desk,
                                              const device::ServoOptions& servo) {
  const SessionParts& parts = desk.parts();
  const double stiffness_n_per_mm = parts.key.study.rendering.stiffness_n_per_mm;
  const auto ticks = [&](double seconds) {
    return std::max<std::int64_t>(1, std::llround(seconds * servo.rate_hz));
  };
  if (const auto* const timed = std::get_if<study::TimedContact>(&exploring)) {
    return std::make_unique<IntervalForce>(model, stiffness_n_per_mm, timed->range,
                                           ticks(timed->seconds));
  }
  if (const auto* const played = std::get_if<study::PlayedStroke>(&exploring)) {
    return std::make_unique<PlayedForce>(model, parts.source.plane(), stiffness_n_per_mm,
                                         ticks(played->seconds), servo.rate_hz);
  }
  if (planes > 1) return std::make_unique<LiftedForce>(model);
  return std::make_unique<ModelForce>(model);
}

}  // namespace

Vec3 IntervalForce::force_n(const device::DeviceSample& sample) noexcept {
  has_lifted_ = has_lifted_ || sample.position_mm.z > study::kLiftedMm;
  if (!has_lifted_) return {};
  const double wall_n = -stiffness_n_per_mm_ * sample.position_mm.z;
  const double speed_mm_s = std::hypot(sample.velocity_mm_s.x, sample.velocity_mm_s.y);
  const bool is_exploring = wall_n >= range_.lightest_n && wall_n <= range_.strongest_n &&
                            speed_mm_s >= range_.slowest_mm_s && speed_mm_s <= range_.fastest_mm_s;
  if (is_exploring && remaining_ticks_ > 0) --remaining_ticks_;
  return model_.force_n(sample.position_mm, sample.velocity_mm_s, touch_);
}

Vec3 PlayedForce::force_n(const device::DeviceSample& /*sample*/) noexcept {
  const double radius_mm = kRadiusShare * std::min(plane_.width_mm(), plane_.height_mm());
  const double angle = study::kPlayedMmS / radius_mm * static_cast<double>(tick_++) / rate_hz_;
  if (remaining_ticks_ > 0) --remaining_ticks_;
  const Vec3 position_mm{plane_.width_mm() / 2.0 + radius_mm * std::cos(angle),
                         plane_.height_mm() / 2.0 + radius_mm * std::sin(angle),
                         -study::kPlayedLoadN / stiffness_n_per_mm_};
  const Vec3 total_n = model_.force_n(position_mm, {}, touch_);
  return {total_n.x, total_n.y, 0.0};
}

PlanesEnd run_planes(SessionDesk& desk, const study::Trial& trial,
                     const device::ServoOptions& servo, const PlaneListener& listener) {
  const SessionParts& parts = desk.parts();
  const study::Study& study = parts.key.study;
  const study::TrialQuestion question = study.task->ask(study, trial.place);
  const bool is_free = std::holds_alternative<study::FreeExploration>(question.exploring);
  const int planes = static_cast<int>(trial.planes.size());
  int pauses = desk.pauses();  // before the first plane
  for (int i = 0; i < planes; ++i) {
    if (planes > 1 &&
        !desk.show_step(IntervalStep{trial.place.trial, trial.role == study::Role::practice, i + 1,
                                     planes, trial.place.hand_off})) {
      return PlanesEnd::aborted;
    }
    if (i == 0) pauses = desk.pauses();
    if (desk.pauses() != pauses) return PlanesEnd::paused;
    const engine::RenderingModel model =
        parts.source.plane_of(trial.planes[static_cast<std::size_t>(i)], parts.key);
    const auto force = force_of(question.exploring, planes, model, desk, servo);
    if (i == 0 && parts.explorer.in_real_time()) parts.source.fetch();
    record::Trace* const trace = listener.plane_on();
    if (trace == nullptr) return PlanesEnd::paused;
    const Exploration exploration = desk.explore(*force, parts.source.plane(), servo, *trace);
    listener.explored(exploration);
    if (is_interrupted(exploration.servo)) return PlanesEnd::interrupted;
    if (desk.was_cut_short()) return PlanesEnd::paused;
    if (!is_free && !force->is_done()) return PlanesEnd::not_explored;
    const bool time_is_up = is_free && exploration.servo.end == device::ServoEnd::time_limit;
    const bool rejects_late = study.trials.on_timeout == study::OnTimeout::no_response;
    if (time_is_up && rejects_late && trial.role != study::Role::practice)
      return PlanesEnd::time_is_up;
  }
  return PlanesEnd::explored;
}

}  // namespace touchtrial::session
