#include "device/acceptance/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial::device {
namespace {

constexpr double kMaxRestMotionMm = 0.3;  ///< a handle is at rest if it moves less than this
constexpr double kRestS = 0.4;            ///< minimum time at rest
constexpr double kMaxRestWaitS = 10.0;
constexpr double kSmoothing = 0.05;  ///< weight of a new reading: about 20 ms
constexpr double kPushReachMm = 15.0;
constexpr double kStrokeReachMm = 40.0;
constexpr double kSupportRampS = 1.0;
constexpr double kHeldSwingMm = 0.6;
constexpr double kTurnAtMm = 22.0;    ///< maximum distance at which shaken strokes reverse
constexpr double kTurnAtMmS = 400.0;  ///< speed at which shaken strokes reverse
constexpr double kMaxPushS = 0.15;    ///< between reversals
constexpr double kMinPushS = 0.008;   ///< between reversals
constexpr double kCentringNPerMm = 0.02;
constexpr double kHighPassHz = 12.0;
constexpr double kSwingsWithinS = 0.45;  ///< for eight half swings: 9 Hz, faster than a hand
constexpr double kTwoPi = 6.283185307179586;

/// A triangle wave: from 0 up to 1, down to -1 and back to 0 in each period.
double triangle(double periods) noexcept {
  const double phase = periods - std::floor(periods);
  if (phase < 0.25) return 4.0 * phase;
  return phase < 0.75 ? 2.0 - 4.0 * phase : 4.0 * phase - 4.0;
}

Vec3 limit_force_norm(Vec3 force_n, double max_n) noexcept {
  const double norm_n = norm(force_n);
  return norm_n <= max_n ? force_n : (max_n / norm_n) * force_n;
}

}  // namespace

std::string_view name_of(DeviceAxis axis) noexcept {
  if (axis == DeviceAxis::x) return "x";
  return axis == DeviceAxis::y ? "y" : "z";
}

Vec3 direction_of(DeviceAxis axis) noexcept {
  return {axis == DeviceAxis::x ? 1.0 : 0.0, axis == DeviceAxis::y ? 1.0 : 0.0,
          axis == DeviceAxis::z ? 1.0 : 0.0};
}

Measurement::Measurement(double seconds, double max_n, double reach_mm)
    : seconds_(seconds), max_n_(max_n), reach_mm_(reach_mm) {
  // A run starts before the device is ready, and ends with a fade.
  samples_.reserve(static_cast<std::size_t>((seconds + 2.0) * kServoRateHz));
}

Vec3 Measurement::force_n(const DeviceSample& sample) noexcept {
  if (!sample.ready || done()) return {};
  if (ticks_ == 0) start_mm_ = sample.position_mm;
  if (norm(sample.position_mm - start_mm_) > reach_mm_) {
    has_run_away_ = true;
    finish();
    return {};
  }
  const double time_s = static_cast<double>(ticks_++) * kServoTickS;
  const Vec3 force = next_n(sample, time_s);
  return done() ? Vec3{} : limit_force_norm(force, max_n_);
}

void Measurement::record(const ServoSample& sample) noexcept {
  if (samples_.size() < samples_.capacity()) samples_.push_back(sample);
}

bool SwingDetector::update(double position_mm, double time_s) noexcept {
  const double share = 1.0 - std::exp(-kTwoPi * kHighPassHz * kServoTickS);
  if (!has_position_) {
    has_position_ = true;
    slow_mm_[0] = position_mm;
  }
  slow_mm_[0] += share * (position_mm - slow_mm_[0]);
  const double high_passed_mm = position_mm - slow_mm_[0];
  // A steady motion becomes a constant after the first filter and zero after the second.
  slow_mm_[1] += share * (high_passed_mm - slow_mm_[1]);
  const double fast_mm = high_passed_mm - slow_mm_[1];
  if (std::abs(fast_mm) >= min_mm_ && fast_mm * peak_mm_ <= 0.0) {
    const std::size_t newest = half_swings_++ % peaks_mm_.size();
    times_s_[newest] = time_s;
    peak_mm_ = peaks_mm_[newest] = fast_mm;
    if (half_swings_ >= peaks_mm_.size()) {
      const std::size_t oldest = half_swings_ % peaks_mm_.size();
      const std::size_t previous = (newest + peaks_mm_.size() - 1) % peaks_mm_.size();
      return time_s - times_s_[oldest] < kSwingsWithinS &&
             std::abs(peaks_mm_[previous]) > 0.5 * std::abs(peaks_mm_[oldest]);
    }
  } else if (std::abs(fast_mm) > std::abs(peak_mm_) && half_swings_ > 0) {
    peak_mm_ = peaks_mm_[(half_swings_ - 1) % peaks_mm_.size()] = fast_mm;
  }
  return false;
}

bool ReboundDetector::update(double height_mm) noexcept {
  if (height_mm >= 0.0) {
    highest_mm_ = std::max(highest_mm_, height_mm);
    return false;
  }
  const double rebound_mm = has_landed_ ? highest_mm_ : 0.0;
  has_landed_ = true;
  highest_mm_ = 0.0;
  if (rebound_mm < kMinMm) return false;
  rebounds_mm_[rebounds_++ % rebounds_mm_.size()] = rebound_mm;
  return rebounds_ >= rebounds_mm_.size() &&
         rebound_mm > kDecayedRatio * rebounds_mm_[rebounds_ % rebounds_mm_.size()];
}

PassiveRun::PassiveRun(double seconds)
    : Measurement(seconds, 0.0, std::numeric_limits<double>::infinity()) {}

Vec3 PassiveRun::next_n(const DeviceSample& sample, double time_s) noexcept {
  if (!has_reading_) first_sequence_ = newest_sequence_ = sample.sequence;
  gap_ = has_reading_ && sample.sequence == newest_sequence_ ? gap_ + 1 : 0;
  has_reading_ = true;
  newest_sequence_ = sample.sequence;
  longest_gap_ = std::max(longest_gap_, gap_);
  if (time_s >= seconds()) finish();
  return {};
}

AxisPush::AxisPush(DeviceAxis axis, double max_n)
    : Measurement(2.0 * (kMaxRestWaitS + kStepS * kMaxN / kStepN + 1.0), std::min(max_n, kMaxN),
                  kPushReachMm),
      direction_(direction_of(axis)),
      max_step_n_(std::min(max_n, kMaxN)) {}

Vec3 AxisPush::next_n(const DeviceSample& sample, double time_s) noexcept {
  if (!has_position_) {
    has_position_ = true;
    smoothed_mm_ = rest_mm_ = sample.position_mm;
  }
  smoothed_mm_ = smoothed_mm_ + kSmoothing * (sample.position_mm - smoothed_mm_);
  if (!is_pushing_) {
    wait_for_rest(time_s);
    return {};
  }
  const double step = std::floor((time_s - phase_start_s_) / kStepS) + 1.0;
  const double force_n = std::min(step * kStepN, max_step_n_);
  if (norm(smoothed_mm_ - rest_mm_) >= kMovedMm) {
    end_push(true, force_n);
    wait_start_s_ = phase_start_s_ = time_s;
    return {};
  }
  if (step * kStepN > max_step_n_ + 0.5 * kStepN) {
    end_push(false, max_step_n_);
    wait_start_s_ = phase_start_s_ = time_s;
    return {};
  }
  return static_cast<double>(sign_) * force_n * direction_;
}

void AxisPush::wait_for_rest(double time_s) noexcept {
  if (norm(smoothed_mm_ - rest_mm_) > kMaxRestMotionMm) {
    rest_mm_ = smoothed_mm_;
    phase_start_s_ = time_s;
  }
  if (time_s - phase_start_s_ >= kRestS) {
    figures_.reached_rest = true;
    is_pushing_ = true;
    rest_mm_ = smoothed_mm_;
    phase_start_s_ = time_s;
  } else if (time_s - wait_start_s_ > kMaxRestWaitS) {
    figures_.reached_rest = false;
    finish();
  }
}

void AxisPush::end_push(bool moved, double force_n) noexcept {
  const Push push{force_n, moved, smoothed_mm_ - rest_mm_};
  is_pushing_ = false;
  const bool is_against =
      moved && static_cast<double>(sign_) * dot(push.moved_mm, direction_) <= 0.0;
  if (sign_ > 0) {
    figures_.plus = push;
  } else {
    figures_.minus = push;
  }
  if (sign_ < 0 || is_against) {
    finish();
    return;
  }
  sign_ = -1;
  rest_mm_ = smoothed_mm_;
}

SlowStrokes::SlowStrokes(DeviceAxis axis, Vec3 support_n, const HoldGains& gains, double max_n,
                         double hold_s)
    : Measurement(hold_s + kPeriods * kPeriodS, max_n, kStrokeReachMm),
      axis_(axis),
      support_n_(support_n),
      gains_(gains),
      hold_s_(hold_s),
      detectors_{SwingDetector(kHeldSwingMm), SwingDetector(kHeldSwingMm),
                 SwingDetector(kHeldSwingMm)} {}

Vec3 SlowStrokes::next_n(const DeviceSample& sample, double time_s) noexcept {
  if (time_s >= seconds()) {
    finish();
    return {};
  }
  const Vec3 position_mm = sample.position_mm;
  const bool swings_x = detectors_[0].update(position_mm.x, time_s);
  const bool swings_y = detectors_[1].update(position_mm.y, time_s);
  const bool swings_z = detectors_[2].update(position_mm.z, time_s);
  if (swings_x || swings_y || swings_z) {
    has_swung_ = true;
    finish();
    return {};
  }
  const double stroke = time_s < hold_s_ ? 0.0 : triangle((time_s - hold_s_) / kPeriodS);
  const Vec3 target_mm = start_mm() + (kAmplitudeMm * stroke) * direction_of(axis_);
  return std::min(1.0, time_s / kSupportRampS) * support_n_ +
         gains_.spring_n_per_mm * (target_mm - sample.position_mm) -
         gains_.damper_n_s_per_mm * sample.velocity_mm_s;
}

ShakenStrokes::ShakenStrokes(DeviceAxis axis, Vec3 support_n, double push_n, const HoldGains& gains,
                             double max_n)
    : Measurement(shake_start_s() + kShakeS, max_n, kStrokeReachMm),
      axis_(axis),
      support_n_(support_n),
      push_n_(push_n),
      gains_(gains) {}

Vec3 ShakenStrokes::next_n(const DeviceSample& sample, double time_s) noexcept {
  if (time_s >= seconds()) {
    finish();
    return {};
  }
  const Vec3 hold_n = std::min(1.0, time_s / kSupportRampS) * support_n_ +
                      gains_.spring_n_per_mm * (start_mm() - sample.position_mm) -
                      gains_.damper_n_s_per_mm * sample.velocity_mm_s;
  if (time_s < shake_start_s()) return hold_n;
  const Vec3 axis = direction_of(axis_);
  const double along_mm = dot(sample.position_mm - start_mm(), axis);
  const double along_mm_s = dot(sample.velocity_mm_s, axis);
  const double progress = (time_s - shake_start_s()) / kShakeS;
  const double stroke_mm = kMaxStrokeMm + progress * (kMinStrokeMm - kMaxStrokeMm);
  const double push_time_s = time_s - turn_s_;
  const auto sign = static_cast<double>(sign_);
  const bool is_beyond_range = sign * along_mm > kTurnAtMm;
  const bool is_stroke_over = sign * (along_mm - turn_mm_) > stroke_mm ||
                              sign * along_mm_s > kTurnAtMmS || push_time_s > kMaxPushS;
  if (is_beyond_range || (is_stroke_over && push_time_s > kMinPushS)) {
    sign_ = -sign_;
    turn_s_ = time_s;
    turn_mm_ = along_mm;
  }
  const double push_n = static_cast<double>(sign_) * push_n_ - kCentringNPerMm * along_mm;
  const Vec3 across_n = hold_n - (dot(hold_n, axis)) * axis;
  return across_n + (dot(support_n_, axis) + push_n) * axis;
}

WallTrial::WallTrial(double stiffness_n_per_mm, double min_mm, double max_n)
    : Measurement(kTrialS, max_n, std::numeric_limits<double>::infinity()),
      stiffness_(stiffness_n_per_mm),
      detector_(min_mm) {}

Vec3 WallTrial::next_n(const DeviceSample& sample, double time_s) noexcept {
  if (time_s >= seconds()) finish();
  const double height_mm = sample.position_mm.y - (start_mm().y - kDepthMm);
  const bool is_swinging = detector_.update(height_mm, time_s);
  const bool is_rebounding = rebounds_.update(height_mm);
  if ((contact_s_ > 0.0 && is_swinging) || is_rebounding) {
    has_oscillated_ = true;
    finish();
    return {};
  }
  if (height_mm >= 0.0) return {};
  contact_s_ += kServoTickS;
  return {0.0, -stiffness_ * height_mm, 0.0};
}

SteadyPush::SteadyPush(double seconds, Vec3 force_n, double reach_mm)
    : Measurement(seconds, norm(force_n), reach_mm), force_n_(force_n) {}

Vec3 SteadyPush::next_n(const DeviceSample& /*sample*/, double time_s) noexcept {
  if (time_s >= seconds()) finish();
  return force_n_;
}

}  // namespace touchtrial::device
