#include "protocols/session/trial_trace.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchtrial::session {
namespace {

/// Counts and sums over the samples in contact.
struct ContactSums {
  std::int64_t samples = 0;
  std::int64_t saturated = 0;
  std::int64_t weak = 0;    ///< below the minimum of the median force
  std::int64_t strong = 0;  ///< above the maximum of the median force
  double path_mm = 0.0;
  double force_squares = 0.0;
};

ContactSums sums_of(const record::Trace& trace, double max_force_n,
                    const study::ValidityRule& rule) {
  const auto squared = [](double value) { return value * value; };
  const double saturation = squared(0.999 * max_force_n);
  ContactSums sums;
  const record::TraceSample* previous = nullptr;  // the previous sample, if it had contact
  for (const record::TraceSample& sample : trace.samples) {
    const Vec3& f = sample.force_n;
    if (!(f.z > 0.0)) {
      previous = nullptr;
      continue;
    }
    const double force_square = f.x * f.x + f.y * f.y + f.z * f.z;
    ++sums.samples;
    sums.force_squares += force_square;
    sums.saturated += force_square >= saturation ? 1 : 0;
    sums.weak += force_square < squared(rule.min_median_n) ? 1 : 0;
    sums.strong += force_square > squared(rule.max_median_n) ? 1 : 0;
    if (previous != nullptr) sums.path_mm += norm(sample.position_mm - previous->position_mm);
    previous = &sample;
  }
  return sums;
}

/// Judges the hand's motion and force at the plane. It uses only the force normal to the plane,
/// whose mean equals the hand's push.
record::HandWindows hand_windows(const record::Trace& trace, const study::ValidityRule& rule) {
  double samples = 0.0;
  double path_mm = 0.0;
  double normal_n = 0.0;
  const record::TraceSample* previous = nullptr;  // the previous sample, if it was at the plane
  for (const record::TraceSample& sample : trace.samples) {
    if (sample.position_mm.z > kLandingHeightMm) {
      previous = nullptr;
      continue;
    }
    samples += 1.0;
    normal_n += sample.force_n.z;
    if (previous != nullptr) {
      const Vec3 step = sample.position_mm - previous->position_mm;
      path_mm += std::sqrt(step.x * step.x + step.y * step.y);
    }
    previous = &sample;
  }
  if (samples == 0.0) return {.contact = false, .path = false, .force = false, .speed = false};
  const auto is_within = [](double value, double min, double max) {
    return value >= min && value <= max;
  };
  const double time_s = samples / trace.rate_hz;
  return {.contact = time_s >= rule.min_contact_s,
          .path = path_mm >= rule.min_path_mm,
          .force = is_within(normal_n / samples, rule.min_median_n, rule.max_median_n),
          .speed = is_within(path_mm / time_s, study::kMinStrokeMmS, study::kMaxStrokeMmS)};
}

/// Time from landing to the last sample; 0 if the stylus never landed.
double exploring_s(const record::Trace& trace) {
  const auto landing = std::ranges::find_if(trace.samples, [](const record::TraceSample& sample) {
    return sample.position_mm.z <= kLandingHeightMm;
  });
  return static_cast<double>(trace.samples.end() - landing) / trace.rate_hz;
}

/// Computes all measures except within_limits.
record::TrialMeasures measures_of(const ContactSums& sums, double rate_hz) {
  if (sums.samples == 0) return {};
  const auto samples = static_cast<double>(sums.samples);
  return {samples / rate_hz, sums.path_mm, std::sqrt(sums.force_squares / samples),
          static_cast<double>(sums.saturated) / samples};
}

/// Combines two explorations: the worse of each measure, and sums of counts.
record::ServoHealth combine(const record::ServoHealth& a, const record::ServoHealth& b) {
  return {.rate_hz = std::min(a.rate_hz, b.rate_hz),
          .lateness_p50_us = std::max(a.lateness_p50_us, b.lateness_p50_us),
          .lateness_p99_us = std::max(a.lateness_p99_us, b.lateness_p99_us),
          .lateness_p999_us = std::max(a.lateness_p999_us, b.lateness_p999_us),
          .lateness_worst_us = std::max(a.lateness_worst_us, b.lateness_worst_us),
          .lost = a.lost + b.lost,
          .held = a.held + b.held};
}

}  // namespace

TrialFindings findings_of(const record::Trace& trace, double max_force_n,
                          const study::ValidityRule& rule) {
  const ContactSums sums = sums_of(trace, max_force_n, rule);
  record::TrialMeasures measures = measures_of(sums, trace.rate_hz);
  // The median is within its limits if at most half of the samples are beyond each, so sorting is
  // not needed.
  const bool median_fits = 2 * sums.weak <= sums.samples && 2 * sums.strong <= sums.samples;
  measures.within_limits = measures.contact_s >= rule.min_contact_s &&
                           measures.path_mm >= rule.min_path_mm && median_fits &&
                           measures.saturated_share < rule.saturated_share;
  return {.measures = measures,
          .long_enough = exploring_s(trace) >= rule.min_exploring_s,
          .hand = hand_windows(trace, rule),
          .saturated = measures.saturated_share >= rule.saturated_share};
}

void TrialTrace::begin() {
  if (packing_.valid()) packing_.wait();
  packing_ = {};
  trace_.samples.clear();
  explorations_.clear();
  began_ns_.clear();
  ticks_ = overruns_ = limited_ticks_ = held_in_contact_ = 0;
  health_.reset();
}

record::Trace& TrialTrace::next_part() {
  if (packing_.valid()) packing_.wait();
  return explorations_.empty() ? trace_ : later_trace_;
}

void TrialTrace::add(const Exploration& exploration, std::chrono::nanoseconds began) {
  const record::Trace& part = explorations_.empty() ? trace_ : later_trace_;
  explorations_.push_back(static_cast<std::int64_t>(part.samples.size()));
  began_ns_.push_back(began.count());
  if (explorations_.size() > 1) {
    trace_.samples.insert(trace_.samples.end(), later_trace_.samples.begin(),
                          later_trace_.samples.end());
  }
  ticks_ += exploration.servo.ticks + exploration.servo.overruns;
  overruns_ += exploration.servo.overruns;
  limited_ticks_ += exploration.servo.limited_ticks;
  held_in_contact_ += exploration.held_in_contact;
  force_limit_n_ = exploration.servo.force_limit_n;
  if (exploration.health)
    health_ = health_ ? combine(*health_, *exploration.health) : *exploration.health;
}

void TrialTrace::pack(const Session& session, bool in_background) {
  const int trial = session.current()->place.trial;
  packing_ = std::async(in_background ? std::launch::async : std::launch::deferred,
                        [this, &session, trial] { return evaluate(session, trial); });
}

record::TraceBody TrialTrace::body(int trial) const {
  record::TraceBody body;
  body.trial = trial;
  body.rate_hz = trace_.rate_hz;
  body.overruns = overruns_;
  body.servo = health_;
  if (explorations_.size() > 1) body.explorations = explorations_;
  if (began_ns_ != std::vector<std::int64_t>{0}) body.began_ns = began_ns_;
  return body;
}

JudgedEvidence TrialTrace::evaluate(const Session& session, int trial) const {
  TrialFindings findings = findings_of(trace_, force_limit_n_, session.options().validity);
  if (held_in_contact_ > 0) findings.measures.within_limits = false;
  record::TraceBody body = this->body(trial);
  body.valid = findings.long_enough;
  body.hand = findings.hand;
  body.saturated = findings.saturated;
  if (health_) findings.measures.limited_ticks = limited_ticks_;
  return {session.pack_evidence(body, findings.measures, trace_), findings.is_valid()};
}

}  // namespace touchtrial::session
