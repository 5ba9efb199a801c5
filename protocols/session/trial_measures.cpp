#include "protocols/session/trial_measures.hpp"

#include <cmath>
#include <cstdint>

namespace touchtrial {
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

ContactSums sums_of(const Trace& trace, double max_force_n, const ValidityRule& rule) {
  const auto squared = [](double value) { return value * value; };
  const double saturation = squared(0.999 * max_force_n);
  ContactSums sums;
  const TraceSample* before = nullptr;  // the last sample, if it had contact
  for (const TraceSample& sample : trace.samples) {
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

}  // namespace

TrialFindings findings_of(const Trace& trace, double max_force_n, const ValidityRule& rule) {
  const ContactSums sums = sums_of(trace, max_force_n, rule);
  TrialFindings findings;
  if (sums.samples == 0) return findings;
  const auto samples = static_cast<double>(sums.samples);
  findings.measures = {samples / trace.rate_hz, sums.path_mm,
                       std::sqrt(sums.force_squares / samples),
                       static_cast<double>(sums.saturated) / samples};
  // A median lies within bounds if at most half of the samples lie beyond either: no sorting.
  const bool median_fits = 2 * sums.weak <= sums.samples && 2 * sums.strong <= sums.samples;
  findings.valid = findings.measures.contact_s >= rule.least_contact_s &&
                   findings.measures.path_mm >= rule.least_path_mm && median_fits &&
                   findings.measures.saturated_share < rule.saturated_share;
  return findings;
}

}  // namespace touchtrial
