/// \file The planes of a trial, one after the other. Private to protocols/session.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/session_desk.hpp"
#include "study/schedule.hpp"

#include <cstdint>
#include <functional>

namespace touchtrial::session {

/// The force of one plane until its clock has run out. The clock runs while the hand explores as
/// instructed (study::TimedContact). The force starts once the hand has been above the plane, so
/// that no plane begins inside the wall.
class IntervalForce final : public device::ForceSource {
 public:
  /// \param stiffness_n_per_mm  the wall's stiffness
  /// \param ticks  duration of the exploration, >= 1
  IntervalForce(const engine::RenderingModel& model, double stiffness_n_per_mm,
                const study::HandRange& range, std::int64_t ticks) noexcept
      : model_(model),
        stiffness_n_per_mm_(stiffness_n_per_mm),
        range_(range),
        remaining_ticks_(ticks) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override;
  [[nodiscard]] bool is_done() const noexcept override { return remaining_ticks_ <= 0; }

 private:
  engine::RenderingModel model_;
  engine::Bristle touch_;
  double stiffness_n_per_mm_;
  study::HandRange range_;
  std::int64_t remaining_ticks_;
  bool has_lifted_ = false;
};

/// The lateral forces of a simulated circular stroke, for any position of the device. It reproduces
/// the sound of the motors with the hand off (study::PlayedStroke), and ends after its time.
class PlayedForce final : public device::ForceSource {
 public:
  PlayedForce(const engine::RenderingModel& model, const PlaneGeometry& plane,
              double stiffness_n_per_mm, std::int64_t ticks, double rate_hz) noexcept
      : model_(model),
        plane_(plane),
        stiffness_n_per_mm_(stiffness_n_per_mm),
        remaining_ticks_(ticks),
        rate_hz_(rate_hz) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override;
  [[nodiscard]] bool is_done() const noexcept override { return remaining_ticks_ <= 0; }

 private:
  engine::RenderingModel model_;
  engine::Bristle touch_;
  PlaneGeometry plane_;
  double stiffness_n_per_mm_;
  std::int64_t remaining_ticks_;
  double rate_hz_;
  std::int64_t tick_ = 0;
};

/// How the presentation of a trial's planes ended.
enum class PlanesEnd {
  explored,      ///< all planes were explored as instructed
  time_is_up,    ///< time is up on a freely explored plane, and the study rejects late answers
  not_explored,  ///< the time limit was reached before a plane's clock ran out
  interrupted,   ///< by a fault or a comfort stop during an exploration
  paused,        ///< by the experimenter; the trial starts over afterwards
  aborted,       ///< ended between two explorations: the session was stopped, left or interrupted
};

/// Callbacks of each exploration.
struct PlaneListener {
  /// Called before a plane is rendered; returns the trace to fill, or null if the plane is late and
  /// the trial must start over.
  std::function<record::Trace*()> plane_on;
  /// Called after each exploration.
  std::function<void(const Exploration&)> explored;
};

/// Presents the planes of a trial.
/// \param servo  options of each exploration
[[nodiscard]] PlanesEnd run_planes(SessionDesk& desk, const study::Trial& trial,
                                   const device::ServoOptions& servo,
                                   const PlaneListener& listener);

}  // namespace touchtrial::session
