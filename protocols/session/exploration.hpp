/// \file One exploration: a participant's hand, a force model, the servo, and the trace. An
/// explorer runs it, in virtual or real time.
#pragma once

#include "device/device_settings.hpp"
#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/participant.hpp"
#include "record/session_bodies.hpp"
#include "record/trace.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::session {

/// The force of a rendering model, for the servo; one object for each exploration.
class ModelForce final : public device::ForceSource {
 public:
  /// \param model  must outlive this
  explicit ModelForce(const engine::RenderingModel& model) noexcept : model_(model) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    return model_.force_n(sample.position_mm, sample.velocity_mm_s, touch_);
  }

 private:
  const engine::RenderingModel& model_;
  engine::Bristle touch_;
};

/// The servo's options in a study's trials: the stricter of the study's and the lab's limits.
/// \param rate_hz  of the servo
/// \param lab  the lab's limits; empty in virtual time
[[nodiscard]] device::ServoOptions trial_servo_options(const study::Study& study, double rate_hz,
                                                       const device::LabLimits& lab);

/// The maximum number of samples of an exploration.
[[nodiscard]] std::size_t max_samples(const device::ServoOptions& options) noexcept;

/// Time from the first tick to this one.
[[nodiscard]] std::chrono::nanoseconds time_of_tick(std::int64_t tick, double rate_hz) noexcept;

/// Height above the plane, mm, at which the stylus counts as landed. Landing is defined by height,
/// because the first contact is stored unencrypted and the onset of force depends on the texture.
inline constexpr double kLandingHeightMm = 3.0;

/// Turns the servo's samples into an evenly sampled trace. If ticks are missing, because the
/// servo overran or a sample was lost in transit, it repeats (holds) the previous sample, so that a
/// sample's index gives its time, and counts these samples. `add` allocates no memory. Not
/// thread-safe.
class TraceBuilder {
 public:
  /// \param trace  cleared, with capacity for `max_samples`; must outlive this
  TraceBuilder(record::Trace& trace, double rate_hz, std::size_t max_samples);

  /// Adds a sample. Ignores samples that are not later than the previous one, or beyond the
  /// capacity.
  void add(const device::ServoSample& sample) noexcept {
    const auto tick = static_cast<std::size_t>(std::max<std::int64_t>(sample.tick, 0));
    if (tick >= capacity_ || tick < next_) return;
    if (next_ < tick) hold_until(tick, {sample.position_mm, sample.force_n});
    if (!landing_tick_ && sample.position_mm.z <= kLandingHeightMm) landing_tick_ = sample.tick;
    trace_.samples.push_back(
        {copy_by_component(sample.position_mm), copy_by_component(sample.force_n)});
    next_ = tick + 1;
  }

  /// The number of held samples.
  [[nodiscard]] std::int64_t held() const noexcept { return held_; }
  /// The number of held samples with a force out of the plane.
  [[nodiscard]] std::int64_t held_in_contact() const noexcept { return held_in_contact_; }
  /// When the stylus landed, since plane-on.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> landed_at() const noexcept;

 private:
  void hold_until(std::size_t tick, const record::TraceSample& first) noexcept;

  record::Trace& trace_;
  std::size_t capacity_;
  std::size_t next_ = 0;  ///< tick of the next sample; equals the number of samples
  std::int64_t held_ = 0;
  std::int64_t held_in_contact_ = 0;
  std::optional<std::int64_t> landing_tick_;
};

/// The result of an exploration, without its trace.
struct Exploration {
  device::ServoReport servo;
  std::optional<std::chrono::nanoseconds> landed_at;  ///< since plane-on
  std::chrono::nanoseconds duration{};                ///< on the servo's clock
  /// The servo's start, from which ticks count; only in real time.
  std::optional<std::chrono::steady_clock::time_point> servo_start;
  std::int64_t held_in_contact = 0;                  ///< held samples of the trace with contact
  std::optional<record::ServoHealth> health;         ///< in real time
  std::optional<record::InterruptionDetail> detail;  ///< if it was interrupted in real time
};

/// Whether a fault or a comfort stop ended the exploration.
[[nodiscard]] bool is_interrupted(const device::ServoReport& report) noexcept;

/// The reason for an interruption that may be stored unencrypted: "comfort stop", "emergency stop"
/// or "device lost" for a person's action, otherwise "device fault". It does not distinguish faults
/// caused by forces or motion, because these depend on the texture.
[[nodiscard]] std::string public_reason(const device::ServoReport& report);

/// Runs explorations. Participants get only the plane's extent and the samples.
class Explorer {
 public:
  virtual ~Explorer() = default;

  /// Whether explorations run in real time. All fields must then be in memory beforehand, because a
  /// wait for the disk could be felt.
  [[nodiscard]] virtual bool in_real_time() const noexcept { return false; }
  /// Presents a plane to a participant until the hand stops, time is up, or a fault occurs. The
  /// last force written is zero.
  /// \param trace  receives every sample; its memory is reused
  [[nodiscard]] virtual Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                            Participant& participant,
                                            const device::ServoOptions& options,
                                            record::Trace& trace) = 0;
};

/// Runs explorations of simulated hands in virtual time, as fast as possible, on the calling
/// thread.
class VirtualExplorer final : public Explorer {
 public:
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    record::Trace& trace) override;
};

}  // namespace touchtrial::session
