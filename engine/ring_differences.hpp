/// \file How a pixel differs from the rings of eight samples round it, exactly.
/// Source: docs/method.md, "Extraction".
#pragma once

#include "core/plane.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial {

/// Walks down the image and gives, for each row, 8 D_k = 8 I - (sum of the samples at (+-k, 0),
/// (0, +-k) and (+-k, +-k)), a whole number of at most 2040, with symmetric extension. Holds
/// 2 * radius + 1 rows. Keeps a reference to the image; not thread-safe.
class RingDifferences {
 public:
  /// \param image  not empty  \param radius  the largest k, >= 1
  RingDifferences(const GreyImage& image, int radius);

  /// Moves to the next row; the first call moves to row 0. \pre there is one
  void next_row();

  /// 8 D_k at column x of the present row is at(x), for x in [0, width).
  class Ring {
   public:
    [[nodiscard]] int at(std::size_t column) const noexcept {
      const auto x = static_cast<std::ptrdiff_t>(column);
      return 8 * centre_[x] - (above_[x - k_] + above_[x] + above_[x + k_] + centre_[x - k_] +
                               centre_[x + k_] + below_[x - k_] + below_[x] + below_[x + k_]);
    }

   private:
    friend class RingDifferences;
    const std::uint8_t* above_ = nullptr;
    const std::uint8_t* centre_ = nullptr;
    const std::uint8_t* below_ = nullptr;
    std::ptrdiff_t k_ = 0;
  };

  /// \param k  1 .. radius. Valid until next_row.
  [[nodiscard]] Ring ring(int k) const noexcept;

 private:
  void load(int y);
  [[nodiscard]] std::size_t slot(int y) const noexcept;
  [[nodiscard]] const std::uint8_t* first_sample(int y) const noexcept;

  const GreyImage& image_;
  int radius_;
  int y_ = -1;
  std::vector<std::vector<std::uint8_t>>
      rows_;  // extended by radius at both ends; row y in slot(y)
};

}  // namespace touchtrial
