/// \file Sensitivity in the task "same or different". Source: docs/thresholds.md, "d'"; Macmillan,
/// Creelman 2005, chapter 9. For "which interval" tasks, see d_prime.hpp.
#pragma once

#include <optional>

namespace touchtrial::analysis {

/// Shares of the answer "different", each in (0, 1). The caller must first replace shares of 0 and
/// 1, for instance by half an answer.
struct SameDifferent {
  double hits = 0.0;          ///< of trials with two different stimuli
  double false_alarms = 0.0;  ///< of trials with the same stimulus twice
};

/// d' and the decision criterion, in units of one stimulus's standard deviation.
struct SameDifferentFit {
  double d_prime = 0.0;
  double criterion = 0.0;
};

/// The differencing observer answers "different" if the two impressions differ by more than the
/// criterion: false alarms 2 Phi(-k / sqrt 2), hits Phi((d' - k) / sqrt 2) + Phi((-d' - k) / sqrt
/// 2). It suits roved or many stimuli.
/// \return nothing if there are fewer hits than false alarms; 0 if equal
/// \throws std::invalid_argument if a share is not in (0, 1)
[[nodiscard]] std::optional<SameDifferentFit> differencing_d_prime(const SameDifferent& shares);

/// The independent-observation observer, optimal for two fixed stimuli. Its unbiased share correct
/// is Phi((z(hits) - z(false alarms)) / 2), and d' = 2 z((1 + sqrt(2 share - 1)) / 2). The
/// criterion is -(z(hits) + z(false alarms)) / 2. Result and errors: see differencing_d_prime.
[[nodiscard]] std::optional<SameDifferentFit> independent_d_prime(const SameDifferent& shares);

}  // namespace touchtrial::analysis
