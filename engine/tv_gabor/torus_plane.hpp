/// \file A plane on TV-Gabor's torus that is filtered again and again, and passes over its rows on
/// several threads. Source: docs/method.md, "TV-Gabor".
/// Private to engine/tv_gabor.
#pragma once

#include "core/parallel.hpp"
#include "engine/fourier/plane_filter.hpp"
#include "engine/tv_gabor/row_kernels.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial::engine {

/// Rows that one thread works on; begin and end are even.
struct RowBlock {
  std::size_t index;
  int begin, end;
};

/// A plane that passes read and write by blocks of rows. The blocks depend on the height alone, so
/// results do not depend on the number of threads. One thread at a time may use an object.
template <typename Real>
class TorusPlane {
 public:
  /// \param height,width  samples, even, >= 16
  /// \param jobs  number of threads, as for in_parallel
  TorusPlane(int height, int width, int jobs)
      : filter_(height, width),
        jobs_(jobs),
        blocks_(static_cast<std::size_t>((height + kRowsOfBlock - 1) / kRowsOfBlock)),
        first_rows_(blocks_ * 2 * this->width()),
        last_y_(blocks_ * this->width()) {}

  [[nodiscard]] int height() const noexcept { return filter_.blocks().height; }
  [[nodiscard]] std::size_t width() const noexcept {
    return static_cast<std::size_t>(filter_.blocks().width);
  }
  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }

  /// Calls work(block) for all blocks, on several threads.
  template <typename Work>
  void in_blocks(const Work& work) const {
    in_parallel(jobs_, blocks_, [&](std::size_t index) {
      work(RowBlock{index, begin_of(index), begin_of(index + 1)});
    });
  }
  /// Adds work(block) of all blocks, in their order.
  template <typename Sum, typename Work>
  [[nodiscard]] Sum sum_of_blocks(const Work& work) const {
    std::vector<Sum> sums(blocks_);
    in_blocks([&](const RowBlock& block) { sums[block.index] = work(block); });
    Sum sum{};
    for (const Sum& part : sums) sum += part;
    return sum;
  }
  /// Calls work(block) for all blocks of coefficients' factors, on several threads.
  template <typename Work>
  void in_column_blocks(const Work& work) const {
    in_parallel(jobs_, filter_.blocks().count(), work);
  }
  [[nodiscard]] const ColumnBlocks<Real>& column_blocks() const noexcept {
    return filter_.blocks();
  }

  /// \param factors  as arranged_factors gives them
  void filter(std::span<const Real> factors) {
    in_column_blocks([&](std::size_t block) { filter_.filter_columns(block, factors); });
  }

  /// The plane's rows in a block, one after the other, with the one below it.
  class Rows {
   public:
    /// \param scale  of all samples
    Rows(const TorusPlane& plane, const RowBlock& block, Real scale = Real{1})
        : plane_(plane),
          scale_(scale),
          rows_(4 * plane.width()),
          workspace_(plane.filter_.blocks().width) {
      load(block.begin);
    }

    /// \param y  of the row after the last one; at first, of the first
    void go_to(int y) {
      if (y % 2 != 0) load(y + 1);
      y_ = y;
    }
    [[nodiscard]] const Real* row() const noexcept { return place_of(y_); }
    [[nodiscard]] const Real* below() const noexcept { return place_of(y_ + 1); }

   private:
    [[nodiscard]] const Real* place_of(int y) const noexcept {
      return rows_.data() + static_cast<std::size_t>(y % 4) * plane_.width();
    }
    void load(int y) {
      Real* const upper = rows_.data() + static_cast<std::size_t>(y % 4) * plane_.width();
      plane_.filter_.read_rows(y == plane_.height() ? 0 : y, scale_, upper, upper + plane_.width(),
                               workspace_);
    }

    const TorusPlane& plane_;
    Real scale_;
    std::vector<Real> rows_;  // four, of two loads
    typename PlaneFilter<Real>::Workspace workspace_;
    int y_ = 0;
  };

  /// Writes -div of a field as the rows of a block, while Rows may still read the rows of this
  /// block from the next one on, and the first rows of others. Call finish_divergence() after all
  /// blocks.
  class DivergenceRows {
   public:
    DivergenceRows(TorusPlane& plane, const RowBlock& block)
        : plane_(plane),
          block_(block),
          y_(block.begin),
          rows_(5 * plane.width()),
          workspace_(plane.filter_.blocks().width),
          along_x_(rows_.data()),
          along_y_(along_x_ + plane.width()),
          above_(along_y_ + plane.width()) {}

    /// For the field's components in the present row, first the block's first one.
    [[nodiscard]] Real* along_x() noexcept { return along_x_; }
    [[nodiscard]] Real* along_y() noexcept { return along_y_; }

    /// Writes the row, and advances to the next.
    void next() {
      const std::size_t width = plane_.width();
      const int pair = y_ - y_ % 2;
      Real* const upper =
          pair == block_.begin ? plane_.first_rows_of(block_.index) : rows_.data() + 3 * width;
      row_kernels<Real>().divergence(along_x_, along_y_, above_, width,
                                     y_ == pair ? upper : upper + width);
      std::swap(above_, along_y_);
      if (y_ != pair && pair != block_.begin) {
        plane_.filter_.write_rows(pair, upper, upper + width, workspace_);
      }
      if (++y_ == block_.end) std::copy_n(above_, width, plane_.last_y_of(block_.index));
    }

   private:
    TorusPlane& plane_;
    RowBlock block_;
    int y_;
    std::vector<Real> rows_;  // along x, along y, along y above, and two that are not written yet
    typename PlaneFilter<Real>::Workspace workspace_;
    Real *along_x_, *along_y_, *above_;
  };

  /// The blocks' first rows, whose upper neighbours other blocks had.
  void finish_divergence() {
    in_blocks([&](const RowBlock& block) {
      typename PlaneFilter<Real>::Workspace workspace(filter_.blocks().width);
      Real* const upper = first_rows_of(block.index);
      const Real* const above = last_y_of((block.index + blocks_ - 1) % blocks_);
      for (std::size_t x = 0; x < width(); ++x) upper[x] += above[x];
      filter_.write_rows(block.begin, upper, upper + width(), workspace);
    });
  }

 private:
  /// Enough that few rows at the seams are read twice, and few enough for all cores of a picture.
  static constexpr int kRowsOfBlock = 64;

  [[nodiscard]] int begin_of(std::size_t index) const noexcept {
    const auto pairs = static_cast<std::size_t>(height() / 2);
    return 2 * static_cast<int>(index * pairs / blocks_);
  }
  [[nodiscard]] Real* first_rows_of(std::size_t block) noexcept {
    return first_rows_.data() + block * 2 * width();
  }
  [[nodiscard]] Real* last_y_of(std::size_t block) noexcept {
    return last_y_.data() + block * width();
  }

  PlaneFilter<Real> filter_;
  int jobs_;
  std::size_t blocks_;
  std::vector<Real> first_rows_;  // two of each block, that wait for finish_divergence
  std::vector<Real> last_y_;      // of each block: the field's last row along y
};

}  // namespace touchtrial::engine
