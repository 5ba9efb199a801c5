#include "protocols/session/hand_meter.hpp"

#include "protocols/session/exploration.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::session {
namespace {

constexpr double kStepS = 0.05;
/// The number of steps in the mean, 0.5 s in total. The mean is arithmetic until there are this
/// many steps; then it is exponential, with this time constant.
constexpr int kMeanSteps = 10;

HandLevel level_of(double value, double min, double max) noexcept {
  if (value < min) return HandLevel::low;
  return value > max ? HandLevel::high : HandLevel::right;
}

}  // namespace

HandMeter::HandMeter(const study::ValidityRule& rule, double rate_hz) noexcept
    : min_n_(std::max(study::kMinPressureN, rule.min_median_n)),
      max_n_(std::min(study::kMaxPressureN, rule.max_median_n)),
      rate_hz_(rate_hz),
      step_ticks_(std::max<std::int64_t>(1, std::llround(kStepS * rate_hz))) {
  // If the instructions and the study's rule contradict each other, the rule applies.
  if (min_n_ < max_n_) return;
  min_n_ = rule.min_median_n;
  max_n_ = rule.max_median_n;
}

void HandMeter::begin() noexcept {
  samples_ = 0;
  steps_ = 0;
  levels_.store(0, std::memory_order_relaxed);
}

void HandMeter::feel(const device::ServoSample& sample) noexcept {
  // The condition is negated, so that NaN counts as away from the plane.
  if (!(sample.position_mm.z <= kLandingHeightMm)) return begin();
  if (samples_ == 0) {
    first_sample_ = sample;
    force_n_ = 0.0;
  }
  ++samples_;
  force_n_ += sample.force_n.z;
  if (sample.tick - first_sample_.tick >= step_ticks_) end_step(sample);
}

void HandMeter::end_step(const device::ServoSample& last_sample) noexcept {
  const double time_s = static_cast<double>(last_sample.tick - first_sample_.tick) / rate_hz_;
  const double mm_s = std::hypot(last_sample.position_mm.x - first_sample_.position_mm.x,
                                 last_sample.position_mm.y - first_sample_.position_mm.y) /
                      time_s;
  steps_ = std::min(steps_ + 1, kMeanSteps);
  mean_n_ += (force_n_ / static_cast<double>(samples_) - mean_n_) / steps_;
  mean_mm_s_ += (mm_s - mean_mm_s_) / steps_;
  samples_ = 0;
  if (steps_ == kMeanSteps) publish_levels();
}

void HandMeter::publish_levels() noexcept {
  const auto force = static_cast<int>(level_of(mean_n_, min_n_, max_n_));
  const auto speed =
      static_cast<int>(level_of(mean_mm_s_, study::kMinStrokeMmS, study::kMaxStrokeMmS));
  levels_.store(static_cast<std::uint8_t>(1 + 3 * force + speed), std::memory_order_relaxed);
}

std::optional<HandLevels> HandMeter::levels() const noexcept {
  const int levels = levels_.load(std::memory_order_relaxed);
  if (levels == 0) return std::nullopt;
  return HandLevels{static_cast<HandLevel>((levels - 1) / 3),
                    static_cast<HandLevel>((levels - 1) % 3)};
}

}  // namespace touchtrial::session
