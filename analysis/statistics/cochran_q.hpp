/// \file Three methods or more, right or wrong on the same occasions.
/// Source: docs/statistics.md, "Three methods or more"; Cochran 1950.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

struct CochranQ {
  double q = 0.0;
  int degrees_of_freedom = 0;  ///< methods - 1
  double p = 1.0;              ///< of q under chi-square: for occasions that are independent
};

/// \param occasions  each holds, for every method, whether the answer was right; all as long
/// \return nothing if there are fewer than two methods, or no occasion on which methods differ
/// \throws std::invalid_argument if lengths differ
[[nodiscard]] std::optional<CochranQ> cochran_q(std::span<const std::vector<bool>> occasions);

/// The same statistic's p when methods are exchanged within whole participants: holds although a
/// participant's occasions are not independent. Monte Carlo, (b + 1) / (m + 1), fixed seed.
/// \param by_participant  each participant's occasions \param deals  m, >= 1
/// \param index  chooses the stream of random numbers
/// \return nothing where cochran_q of all occasions is nothing
/// \throws std::invalid_argument if lengths differ or deals < 1
[[nodiscard]] std::optional<double> cochran_q_permuted_p(
    std::span<const std::vector<std::vector<bool>>> by_participant, int deals = 9999,
    std::uint64_t index = 0);

}  // namespace touchtrial::analysis
