/// \file Two forces, one after the other in one run of the servo, and what the hand met of each.
#pragma once

#include "device/servo/servo.hpp"

#include <cstdint>

namespace touchtrial::device {

/// Force source and sample sink in one. One run rather than two, because a hand that already rests
/// on a plane would fall through it at the start of the second: the chain's small-force gate lets a
/// force in only once the hand is off the plane (docs/safety.md). All there is to know is known
/// before the run, so nothing is handed over while it lasts. Belongs to the servo thread meanwhile.
class ForceSequence final : public ForceSource, public SampleSink {
 public:
  struct Part {
    std::int64_t ticks = 0;
    std::int64_t contact_ticks = 0;  ///< with a force out of the plane
    double greatest_force_n = 0.0;   ///< that was sent
  };

  /// \param first,second  must outlive this; the second is asked from the change on, the first
  ///   until the change's end
  /// \param change_tick  at which the change to the second begins, >= 0
  /// \param blend_ticks  that it takes, >= 1: the second's share rises by 3 u^2 - 2 u^3
  ForceSequence(ForceSource& first, ForceSource& second, std::int64_t change_tick,
                std::int64_t blend_ticks) noexcept
      : first_(first), second_(second), change_tick_(change_tick), blend_ticks_(blend_ticks) {}

  /// After an overrun the share is that of the first tick left out, and catches up with the next.
  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override;
  void record(const ServoSample& sample) noexcept override;

  /// Whether a tick counts as the second's: from the beginning of the change on. Any thread.
  [[nodiscard]] bool is_second(std::int64_t tick) const noexcept { return tick >= change_tick_; }

  /// After the run.
  [[nodiscard]] const Part& first() const noexcept { return parts_[0]; }
  [[nodiscard]] const Part& second() const noexcept { return parts_[1]; }

 private:
  ForceSource& first_;
  ForceSource& second_;
  std::int64_t change_tick_;
  std::int64_t blend_ticks_;
  std::int64_t tick_ = 0;  ///< that is asked for next
  Part parts_[2];
};

}  // namespace touchtrial::device
