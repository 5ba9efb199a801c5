/// \file A plane on TV-Gabor's torus for repeated filtering, with multi-threaded passes over its
/// rows. Source: docs/method.md, "TV-Gabor". Private to engine/tv_gabor.
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

/// Rows processed by one thread; begin and end are even.
struct RowBlock {
  std::size_t index;
  int begin, end;
};

/// A plane that is read and written in blocks of rows. Blocks depend only on the height, so results
/// do not depend on the number of threads. Not thread-safe.
template <typename Real>
class TorusPlane {
 public:
  /// \param height,width  samples, even, >= 16
  /// \param jobs  number of threads, as for in_parallel
  TorusPlane(int height, int width, int jobs)
      : filter_(height, width),
        jobs_(jobs),
        blocks_(static_cast<std::size_t>((height + kRowsPerBlock - 1) / kRowsPerBlock)),
        first_rows_(blocks_ * 2 * this->width()),
        last_rows_y_(blocks_ * this->width()) {}

  [[nodiscard]] int height() const noexcept { return filter_.blocks().height; }
  [[nodiscard]] std::size_t width() const noexcept {
    return static_cast<std::size_t>(filter_.blocks().width);
  }
  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }

  /// Calls work(block) for all blocks, on several threads.
  template <typename Work>
  void for_each_block(const Work& work) const {
    in_parallel(jobs_, blocks_, [&](std::size_t index) {
      work(RowBlock{index, begin_of(index), begin_of(index + 1)});
    });
  }
  /// Sums work(block) over all blocks, in order.
  template <typename Sum, typename Work>
  [[nodiscard]] Sum sum_of_blocks(const Work& work) const {
    std::vector<Sum> sums(blocks_);
    for_each_block([&](const RowBlock& block) { sums[block.index] = work(block); });
    Sum sum{};
    for (const Sum& part : sums) sum += part;
    return sum;
  }
  /// Calls work(block) for all column blocks, on several threads.
  template <typename Work>
  void for_each_column_block(const Work& work) const {
    in_parallel(jobs_, filter_.blocks().count(), work);
  }
  [[nodiscard]] const ColumnBlocks<Real>& column_blocks() const noexcept {
    return filter_.blocks();
  }

  /// \param factors  in the layout of arranged_factors()
  void filter(std::span<const Real> factors) {
    for_each_column_block([&](std::size_t block) { filter_.filter_columns(block, factors); });
  }

  /// Reads the rows of a block in order, each with the row below it.
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

    /// \param y  the block's first row, then each next row
    void go_to(int y) {
      if (y % 2 != 0) load(y + 1);
      y_ = y;
    }
    [[nodiscard]] const Real* row() const noexcept { return row_start(y_); }
    [[nodiscard]] const Real* row_below() const noexcept { return row_start(y_ + 1); }

   private:
    [[nodiscard]] const Real* row_start(int y) const noexcept {
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

  /// Writes -div of a field to the rows of a block. Meanwhile Rows may read later rows of this
  /// block and the first rows of other blocks. Call finish_divergence() after all blocks.
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
          y_above_(along_y_ + plane.width()) {}

    /// Buffers for the field's components in the current row, initially the block's first row.
    [[nodiscard]] Real* along_x() noexcept { return along_x_; }
    [[nodiscard]] Real* along_y() noexcept { return along_y_; }

    /// Writes the current row and advances to the next.
    void next() {
      const std::size_t width = plane_.width();
      const int pair = y_ - y_ % 2;
      Real* const upper =
          pair == block_.begin ? plane_.first_rows(block_.index) : rows_.data() + 3 * width;
      row_kernels<Real>().divergence(along_x_, along_y_, y_above_, width,
                                     y_ == pair ? upper : upper + width);
      std::swap(y_above_, along_y_);
      if (y_ != pair && pair != block_.begin) {
        plane_.filter_.write_rows(pair, upper, upper + width, workspace_);
      }
      if (++y_ == block_.end) std::copy_n(y_above_, width, plane_.last_y(block_.index));
    }

   private:
    TorusPlane& plane_;
    RowBlock block_;
    int y_;
    std::vector<Real> rows_;  // x, y, y of the row above, and two pending rows
    typename PlaneFilter<Real>::Workspace workspace_;
    Real *along_x_, *along_y_, *y_above_;
  };

  /// Writes the first rows of the blocks, whose upper neighbours are in other blocks.
  void finish_divergence() {
    for_each_block([&](const RowBlock& block) {
      typename PlaneFilter<Real>::Workspace workspace(filter_.blocks().width);
      Real* const upper = first_rows(block.index);
      const Real* const y_above = last_y((block.index + blocks_ - 1) % blocks_);
      for (std::size_t x = 0; x < width(); ++x) upper[x] += y_above[x];
      filter_.write_rows(block.begin, upper, upper + width(), workspace);
    });
  }

 private:
  /// Blocks are large enough that few rows are read twice at their borders, and small enough to use
  /// all cores.
  static constexpr int kRowsPerBlock = 64;

  [[nodiscard]] int begin_of(std::size_t index) const noexcept {
    const auto pairs = static_cast<std::size_t>(height() / 2);
    return 2 * static_cast<int>(index * pairs / blocks_);
  }
  [[nodiscard]] Real* first_rows(std::size_t block) noexcept {
    return first_rows_.data() + block * 2 * width();
  }
  [[nodiscard]] Real* last_y(std::size_t block) noexcept {
    return last_rows_y_.data() + block * width();
  }

  PlaneFilter<Real> filter_;
  int jobs_;
  std::size_t blocks_;
  std::vector<Real> first_rows_;   // two per block, pending until finish_divergence()
  std::vector<Real> last_rows_y_;  // y component of the last row of each block
};

}  // namespace touchtrial::engine
