/// \file How often each pair of grey levels is found side by side.
#pragma once

#include "core/plane.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchtrial::engine {

inline constexpr int kGreyLevels = 256;

/// Counts of one pair of levels, for each of kGlcmOffsets.
using GlcmCell = std::array<std::uint32_t, 4>;

/// Ordered pairs (level of a pixel, level of its neighbour), all directions of a pair side by side:
/// neighbouring pixels of a texture then touch the same cache lines.
class GlcmCounts {
 public:
  /// \param image  any size below 2^32 pixels
  explicit GlcmCounts(const GreyImage& image);

  [[nodiscard]] const GlcmCell& at(int level, int neighbour) const noexcept {
    return cells_[static_cast<std::size_t>(level * kGreyLevels + neighbour)];
  }

 private:
  void count_first_row(const GreyImage& image);
  void count_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t width);

  std::vector<GlcmCell> cells_;
};

}  // namespace touchtrial::engine
