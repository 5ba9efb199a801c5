/// \file What a trial's samples amount to, and the study's rule for a valid trial.
#pragma once

#include "protocols/store/payload.hpp"
#include "protocols/store/trace.hpp"

namespace touchtrial {

/// The validity rule, fixed before outcomes are seen.
struct ValidityRule {
  double least_contact_s = 5.0;
  double least_path_mm = 300.0;  ///< in contact
  double least_median_n = 0.2;   ///< of the force's norm in contact
  double largest_median_n = 2.0;
  double saturated_share = 0.01;  ///< of the samples in contact, less than this
};

struct TrialFindings {
  TrialMeasures measures;
  bool valid = false;  ///< by the rule, overruns apart
};

/// A sample has contact if its normal force is above zero; it is saturated if its force's norm is
/// within 0.1 % of the limit. \param max_force_n  limit of the force's norm, > 0
[[nodiscard]] TrialFindings findings_of(const Trace& trace, double max_force_n,
                                        const ValidityRule& rule = {});

}  // namespace touchtrial
