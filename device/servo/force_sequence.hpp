/// \file Two forces in sequence in one run of the servo, with contact statistics of each.
#pragma once

#include "device/servo/servo.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace touchtrial::device {

/// Both force source and sample sink. The two forces share a run because a hand resting on a plane
/// would fall through it at the start of a second run: the chain's small-force gate opens only once
/// the hand is off the plane (docs/safety.md). Belongs to the servo thread during a run.
class ForceSequence final : public ForceSource, public SampleSink {
 public:
  struct Part {
    std::int64_t ticks = 0;
    std::int64_t contact_ticks = 0;  ///< with a force out of the plane
    double max_force_n = 0.0;        ///< sent to the device
  };

  /// \param first,second  must outlive this; during the change the servo calls both
  /// \param change_tick  the tick at which the change to the second begins, >= 0
  /// \param blend_ticks  duration of the change, >= 1: the second's share rises by 3 u^2 - 2 u^3
  ForceSequence(ForceSource& first, ForceSource& second, std::int64_t change_tick,
                std::int64_t blend_ticks) noexcept
      : first_(first), second_(second), change_tick_(change_tick), blend_ticks_(blend_ticks) {}

  /// After an overrun it uses the share of the first missed tick; the next tick catches up.
  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override {
    const std::int64_t elapsed = tick_ - change_tick_;
    if (elapsed < 0) return first_.force_n(sample);
    if (elapsed >= blend_ticks_) return second_.force_n(sample);
    const double u = static_cast<double>(elapsed) / static_cast<double>(blend_ticks_);
    const double share = u * u * (3.0 - 2.0 * u);
    return (1.0 - share) * first_.force_n(sample) + share * second_.force_n(sample);
  }

  void record(const ServoSample& sample) noexcept override {
    tick_ = sample.tick + 1;
    Part& part = parts_[is_second(sample.tick) ? 1 : 0];
    ++part.ticks;
    part.contact_ticks += sample.force_n.z > 0.0 ? 1 : 0;
    part.max_force_n = std::max(part.max_force_n, norm(sample.force_n));
  }

  /// May be called from any thread.
  /// \return whether a tick belongs to the second part, which begins when the change begins
  [[nodiscard]] bool is_second(std::int64_t tick) const noexcept { return tick >= change_tick_; }

  /// \name After the run
  ///@{
  [[nodiscard]] const Part& first() const noexcept { return parts_[0]; }
  [[nodiscard]] const Part& second() const noexcept { return parts_[1]; }
  ///@}

 private:
  ForceSource& first_;
  ForceSource& second_;
  std::int64_t change_tick_;
  std::int64_t blend_ticks_;
  std::int64_t tick_ = 0;  ///< the next one
  std::array<Part, 2> parts_{};
};

}  // namespace touchtrial::device
