/// \file What a trial's samples amount to, and the study's rule for a valid trial.
#pragma once

#include "protocols/store/payload.hpp"
#include "protocols/store/trace.hpp"

namespace touchtrial::session {

/// The validity rule, fixed before outcomes are seen. Forces, and the path and contact that they
/// bend, tell textures apart, so that whether they are within limits is known after unblinding
/// alone; that the exploration was long enough is stored in clear.
struct ValidityRule {
  double least_exploring_s = 5.0;  ///< from landing to the last sample
  double least_contact_s = 5.0;
  double least_path_mm = 300.0;  ///< in contact
  double least_median_n = 0.2;   ///< of the force's norm in contact
  double largest_median_n = 2.0;
  double saturated_share = 0.01;  ///< of the samples in contact, less than this
};

struct TrialFindings {
  store::TrialMeasures measures;
  /// Follows from the number of samples and the time of landing, which are in clear as well: adds
  /// nothing to them.
  bool long_enough = false;

  /// By the whole rule, overruns apart.
  [[nodiscard]] bool valid() const noexcept { return long_enough && measures.within_limits; }
};

/// A sample has contact if its normal force is above zero; it is saturated if its force's norm is
/// within 0.1 % of the limit. The stylus has landed from the first sample at kLandingHeightMm or
/// below. \param max_force_n  limit of the force's norm, > 0
[[nodiscard]] TrialFindings findings_of(const store::Trace& trace, double max_force_n,
                                        const ValidityRule& rule = {});

}  // namespace touchtrial::session
