/// \file Linear filters of real planes, diagonal in the Fourier basis, for callers that process
/// rows before and after filtering. Source: docs/decisions/README.md, decision 5.
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// The layout of a filter's factors: column by column, in blocks of columns. A block has as many
/// columns as a cache line has coefficients.
template <typename Real>
struct ColumnBlocks {
  static constexpr int kLanes = 64 / sizeof(std::complex<Real>);

  int height, width;  ///< of the plane, samples

  [[nodiscard]] std::size_t count() const noexcept {
    return static_cast<std::size_t>((width / 2 + kLanes) / kLanes);
  }
  /// Factors of one block.
  [[nodiscard]] std::size_t block_size() const noexcept {
    return static_cast<std::size_t>(height) * kLanes;
  }
  /// Calls visit(i, y, x) for each factor i of a block, with its frequencies y along columns and x
  /// along rows. In the last block, x may exceed width / 2 and then means x - width.
  template <typename Visit>
  void for_each(std::size_t block, const Visit& visit) const {
    std::size_t i = block * block_size();
    for (int lane = 0; lane < kLanes; ++lane) {
      const int x = static_cast<int>(block) * kLanes + lane;
      for (int y = 0; y < height; ++y, ++i) visit(i, y, x);
    }
  }
};

/// Arranges the factors of a filter in the layout of ColumnBlocks.
/// \param spectrum  real factors, the same for opposite frequencies, height x (width / 2 + 1) in
///   the layout of RealFft's spectrum
/// \param width  of the plane, even, >= 16
template <typename Real>
[[nodiscard]] std::vector<Real> arranged_factors(const Plane<double>& spectrum, int width);

/// A plane filtered in place on a torus. Between steps it stores the transforms of its rows, so one
/// pass filters all columns block by block, and one pass reads, processes and rewrites the rows,
/// both while data are in the cache. Two rows are transformed together, as the real and imaginary
/// parts of one complex row. Real is float or double.
///
/// Threads: different column blocks may be processed concurrently, and so may different row pairs,
/// but not rows and columns together. All blocks have the same size and plan, so results do not
/// depend on the assignment of threads.
template <typename Real>
class PlaneFilter {
 public:
  /// \param height,width  samples, even, >= 16
  /// \throws std::bad_alloc if there is no memory for the plane
  /// \throws std::invalid_argument if a side is odd or too small, or FFTW has no transform of it
  PlaneFilter(int height, int width);
  ~PlaneFilter();
  PlaneFilter(const PlaneFilter&) = delete;
  PlaneFilter& operator=(const PlaneFilter&) = delete;

  [[nodiscard]] const ColumnBlocks<Real>& blocks() const noexcept;

  /// Buffers for two rows, of one thread at a time.
  class Workspace {
   public:
    explicit Workspace(int width);
    ~Workspace();
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;

   private:
    friend class PlaneFilter;
    struct Buffers;
    std::unique_ptr<Buffers> buffers_;
  };

  /// Writes two rows.
  /// \param y  index of the upper row; even
  /// \param upper,lower  width samples each
  /// \throws std::bad_alloc if FFTW is out of memory, as do all transforming functions
  void write_rows(int y, const Real* upper, const Real* lower, Workspace& workspace);
  /// Reads two rows, multiplied by `scale`. After filter_columns() with factors of 1, a scale of 1
  /// returns the rows as written.
  void read_rows(int y, Real scale, Real* upper, Real* lower, Workspace& workspace) const;

  /// Filters the columns of one block.
  /// \param factors  of all blocks, from arranged_factors()
  /// \throws std::bad_alloc if there is no memory for a block
  void filter_columns(std::size_t block, std::span<const Real> factors);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::engine
