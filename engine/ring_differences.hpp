/// \file How a pixel differs from the rings of eight samples round it, exactly: plainly, for the
/// texture in double. Source: docs/method.md, "Extraction".
#pragma once

#include "engine/kernels/extended_rows.hpp"

#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

/// 8 D_k = 8 I - (sum of the samples at (+-k, 0), (0, +-k) and (+-k, +-k)), a whole number of at
/// most 2040 in magnitude, for the present row of some rows.
class RingDifferences {
 public:
  /// \param rows  reach >= k; must not move while this is used  \param k  >= 1
  RingDifferences(const ExtendedRows& rows, int k) noexcept
      : above_(rows.row(-k)), centre_(rows.row(0)), below_(rows.row(k)), k_(k) {}

  /// \param column  0 .. width - 1
  [[nodiscard]] int at(std::size_t column) const noexcept {
    const auto x = static_cast<std::ptrdiff_t>(column);
    return 8 * centre_[x] - (above_[x - k_] + above_[x] + above_[x + k_] + centre_[x - k_] +
                             centre_[x + k_] + below_[x - k_] + below_[x] + below_[x + k_]);
  }

 private:
  const std::int16_t* above_;
  const std::int16_t* centre_;
  const std::int16_t* below_;
  std::ptrdiff_t k_;
};

}  // namespace touchtrial::engine
