/// \file Information transfer: the mutual information between stimulus and answer, in bits. Source:
/// docs/statistics.md, "Information transfer"; Tan, Reed, Durlach 2010, IEEE Transactions on
/// Haptics 3(2).
#pragma once

#include "analysis/statistics/confusion.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// Estimates over trials with a response; missing if there is none.
struct InformationTransfer {
  std::optional<double> raw;        ///< estimate from the counts, bits, >= 0, biased upward
  std::optional<double> corrected;  ///< raw minus Miller and Madow's bias; may be below 0
  std::optional<double> null_mean;  ///< mean of raw over random permutations of the answers
  int deals = 0;                    ///< permutations behind null_mean
};

/// The number of trials below which an estimate for K classes is unreliable: 5 K^2.
[[nodiscard]] constexpr int trials_for_information_transfer(int classes) noexcept {
  return 5 * classes * classes;
}

/// The uncorrected estimate from the counts: the sum of n_ij/n log2(n_ij n / (n_i. n_.j)).
/// \return bits, or nothing if no trial has a response
[[nodiscard]] std::optional<double> raw_information_transfer(const ConfusionMatrix& confusion);

/// \param by_participant  every participant's trials; answers are permuted within a participant
/// \param index  chooses the stream of random numbers, so that methods do not share one
/// \param permutations  behind the null mean, >= 1
/// \throws std::invalid_argument if a class is out of range or permutations < 1
[[nodiscard]] InformationTransfer information_transfer(
    int classes, std::span<const std::vector<Choice>> by_participant, std::uint64_t index = 0,
    int permutations = 500);

}  // namespace touchtrial::analysis
