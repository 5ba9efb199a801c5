#include "protocols/session/trial_measures.hpp"

#include "protocols/session/trace_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace touchtrial::session {
namespace {

/// Sums over the samples in contact.
struct ContactSums {
  std::int64_t samples = 0;
  std::int64_t saturated = 0;
  std::int64_t weak = 0;    ///< below the least median force
  std::int64_t strong = 0;  ///< above the largest
  double path_mm = 0.0;
  double force_squares = 0.0;
};

ContactSums sums_of(const store::Trace& trace, double max_force_n, const ValidityRule& rule) {
  const auto squared = [](double value) { return value * value; };
  const double saturation = squared(0.999 * max_force_n);
  ContactSums sums;
  const store::TraceSample* before = nullptr;  // the last sample, if it had contact
  for (const store::TraceSample& sample : trace.samples) {
    const Vec3& f = sample.force_n;
    if (!(f.z > 0.0)) {
      before = nullptr;
      continue;
    }
    const double force_square = f.x * f.x + f.y * f.y + f.z * f.z;
    ++sums.samples;
    sums.force_squares += force_square;
    sums.saturated += force_square >= saturation ? 1 : 0;
    sums.weak += force_square < squared(rule.least_median_n) ? 1 : 0;
    sums.strong += force_square > squared(rule.largest_median_n) ? 1 : 0;
    if (before != nullptr) sums.path_mm += norm(sample.position_mm - before->position_mm);
    before = &sample;
  }
  return sums;
}

double exploring_s(const store::Trace& trace) {
  const auto landing = std::ranges::find_if(trace.samples, [](const store::TraceSample& sample) {
    return sample.position_mm.z <= kLandingHeightMm;
  });
  return static_cast<double>(trace.samples.end() - landing) / trace.rate_hz;
}

/// What was felt, without a verdict.
store::TrialMeasures measures_of(const ContactSums& sums, double rate_hz) {
  if (sums.samples == 0) return {};
  const auto samples = static_cast<double>(sums.samples);
  return {samples / rate_hz, sums.path_mm, std::sqrt(sums.force_squares / samples),
          static_cast<double>(sums.saturated) / samples};
}

}  // namespace

TrialFindings findings_of(const store::Trace& trace, double max_force_n, const ValidityRule& rule) {
  const ContactSums sums = sums_of(trace, max_force_n, rule);
  store::TrialMeasures measures = measures_of(sums, trace.rate_hz);
  // A median lies within bounds if at most half of the samples lie beyond either: no sorting.
  const bool median_fits = 2 * sums.weak <= sums.samples && 2 * sums.strong <= sums.samples;
  measures.within_limits = measures.contact_s >= rule.least_contact_s &&
                           measures.path_mm >= rule.least_path_mm && median_fits &&
                           measures.saturated_share < rule.saturated_share;
  return {measures, exploring_s(trace) >= rule.least_exploring_s};
}

}  // namespace touchtrial::session
