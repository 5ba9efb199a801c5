/// \file Sensitivity of tasks without a fixed question: "same or different", and "which of three is
/// odd". Source: docs/procedures.md, "d'"; Macmillan, Creelman 2005, chapter 9; Ennis 1993;
/// Frijters, Kooistra, Vereijken 1980. Standard "which interval" tasks: d_prime.hpp.
#pragma once

#include <optional>

namespace touchtrial::analysis {

/// Shares of the answer "different", each in (0, 1). Counts of none or all must be replaced, for
/// instance by half an answer, before they come here.
struct SameDifferent {
  double hits = 0.0;          ///< of trials with two different stimuli
  double false_alarms = 0.0;  ///< of trials with the same stimulus twice
};

/// d' and the decision's criterion, in units of one stimulus' standard deviation.
struct SameDifferentFit {
  double d_prime = 0.0;
  double criterion = 0.0;
};

/// The differencing observer says "different" if both impressions are more than the criterion
/// apart: false alarms 2 Phi(-k / sqrt 2), hits Phi((d' - k) / sqrt 2) + Phi((-d' - k) / sqrt 2).
/// For roved or many stimuli.
/// \return nothing if there are fewer hits than false alarms; 0 if equal
/// \throws std::invalid_argument if a share is not in (0, 1)
[[nodiscard]] std::optional<SameDifferentFit> differencing_d_prime(const SameDifferent& shares);

/// The observer who judges each impression by itself, as is best with two fixed stimuli: the best
/// share correct is Phi((z(hits) - z(false alarms)) / 2), and d' = 2 z((1 + sqrt(2 share - 1)) /
/// 2). The criterion is -(z(hits) + z(false alarms)) / 2. Result and errors as above.
[[nodiscard]] std::optional<SameDifferentFit> independent_d_prime(const SameDifferent& shares);

/// How the odd one of three is found. The odd stimulus is the stronger or the weaker one, both
/// equally likely.
enum class OddOneRule {
  differencing,  ///< the impression that is farthest from the other two; for roved stimuli
  independent,   ///< the most likely one, of two fixed stimuli
};

/// The share correct of an unbiased observer in the triangle test. With X the odd impression, Y and
/// Z the others, centred between the stimuli, the independent observer is right if Y and Z are
/// below 0 and below X, or above both.
/// \return 1/3 .. 1, 1/3 at d' = 0; error below 1e-9
/// \throws std::invalid_argument if d is not finite
[[nodiscard]] double odd_one_share_of(double d_prime, OddOneRule rule);

/// Its inverse, for the odd one out.
/// \return nothing at 1; 0 at 1/3 or less
/// \throws std::invalid_argument if the share is not in [0, 1]
[[nodiscard]] std::optional<double> odd_one_d_prime(double share, OddOneRule rule);

}  // namespace touchtrial::analysis
