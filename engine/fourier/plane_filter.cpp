#include "engine/fourier/plane_filter.hpp"

#include "engine/fourier/fftw.hpp"
#include "engine/fourier/paired_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::engine {
namespace {

enum PlanIndex : std::size_t { rows_forward, rows_inverse, columns_forward, columns_inverse };

/// Requires an even side of at least 16, so that every coefficient in the last block has an
/// opposite.
int checked_side(int side) {
  if (side < 16 || side % 2 != 0) {
    throw std::invalid_argument("a filtered plane needs even sides of 16 or more");
  }
  return side;
}

/// Two rows joined into one complex row, before and after its transform.
template <typename Real>
struct JoinedRows {
  explicit JoinedRows(int width)
      : samples(static_cast<std::size_t>(width)), spectrum(samples.span().size() + 1) {}

  FftwBuffer<std::complex<Real>> samples;
  FftwBuffer<std::complex<Real>> spectrum;  // the last coefficient repeats the first
};

}  // namespace

template <typename Real>
struct PlaneFilter<Real>::Workspace::Buffers : JoinedRows<Real> {
  using JoinedRows<Real>::JoinedRows;
};

template <typename Real>
PlaneFilter<Real>::Workspace::Workspace(int width) : buffers_(std::make_unique<Buffers>(width)) {}

template <typename Real>
PlaneFilter<Real>::Workspace::~Workspace() = default;

template <typename Real>
struct PlaneFilter<Real>::State {
  State(int rows, int columns)
      : blocks{checked_side(rows), checked_side(columns)},
        // One extra line, so that a row of all blocks does not map to one cache set.
        stride(blocks.block_size() + kLanes),
        spectrum(blocks.count() * stride),
        plans(std::to_string(rows) + 'x' + std::to_string(columns) + "-filter",
              static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns),
              [this] { return make_plans(); }) {}

  /// Transformed columns are contiguous, so FFTW needs no internal buffer.
  [[nodiscard]] std::vector<typename Fftw<Real>::Plan> make_plans() const {
    const JoinedRows<Real> rows(blocks.width);
    auto* const samples = as_fftw(rows.samples.data());
    auto* const coefficients = as_fftw(rows.spectrum.data());
    const FftwBuffer<std::complex<Real>> column_spectra(blocks.block_size());
    auto* const block = as_fftw(spectrum.data());
    auto* const columns = as_fftw(column_spectra.data());
    constexpr unsigned flags = kPlannerFlags | FFTW_DESTROY_INPUT;
    const auto plan_row = [&](auto* input, auto* output, int sign) {
      return Fftw<Real>::plan_many(1, &blocks.width, 1, input, nullptr, 1, 0, output, nullptr, 1, 0,
                                   sign, flags);
    };
    const int height = blocks.height;
    return {plan_row(samples, coefficients, FFTW_FORWARD),
            plan_row(coefficients, samples, FFTW_BACKWARD),
            Fftw<Real>::plan_many(1, &height, kLanes, block, nullptr, kLanes, 1, columns, nullptr,
                                  1, height, FFTW_FORWARD, flags),
            Fftw<Real>::plan_many(1, &height, kLanes, columns, nullptr, 1, height, block, nullptr,
                                  kLanes, 1, FFTW_BACKWARD, flags)};
  }

  [[nodiscard]] PairedLines<Real> lines(int y) const {
    return {spectrum.data() + static_cast<std::size_t>(y) * kLanes, stride, blocks.count()};
  }

  static constexpr int kLanes = ColumnBlocks<Real>::kLanes;

  ColumnBlocks<Real> blocks;
  std::size_t stride;
  FftwBuffer<std::complex<Real>> spectrum;
  FftwPlans<Real> plans;
};

template <typename Real>
PlaneFilter<Real>::PlaneFilter(int height, int width)
    : state_(std::make_unique<State>(height, width)) {}

template <typename Real>
PlaneFilter<Real>::~PlaneFilter() = default;

template <typename Real>
const ColumnBlocks<Real>& PlaneFilter<Real>::blocks() const noexcept {
  return state_->blocks;
}

template <typename Real>
void PlaneFilter<Real>::write_rows(int y, const Real* upper, const Real* lower,
                                   Workspace& workspace) {
  const auto width = static_cast<std::size_t>(state_->blocks.width);
  std::complex<Real>* const samples = workspace.buffers_->samples.data();
  std::complex<Real>* const spectrum = workspace.buffers_->spectrum.data();
  paired_row_kernels<Real>().join_rows(upper, lower, width, samples);
  Fftw<Real>::transform(state_->plans[rows_forward], as_fftw(samples), as_fftw(spectrum));
  spectrum[width] = spectrum[0];
  paired_row_kernels<Real>().split_spectra(spectrum, width, state_->lines(y));
}

template <typename Real>
void PlaneFilter<Real>::read_rows(int y, Real scale, Real* upper, Real* lower,
                                  Workspace& workspace) const {
  const auto width = static_cast<std::size_t>(state_->blocks.width);
  std::complex<Real>* const samples = workspace.buffers_->samples.data();
  std::complex<Real>* const spectrum = workspace.buffers_->spectrum.data();
  paired_row_kernels<Real>().join_spectra(state_->lines(y), width, spectrum);
  Fftw<Real>::transform(state_->plans[rows_inverse], as_fftw(spectrum), as_fftw(samples));
  // A forward and an inverse transform multiply by the number of samples, and split_spectra by 2.
  const double gain = 2.0 * state_->blocks.height * state_->blocks.width;
  paired_row_kernels<Real>().split_rows(samples, width, static_cast<Real>(scale / gain), upper,
                                        lower);
}

template <typename Real>
void PlaneFilter<Real>::filter_columns(std::size_t block, std::span<const Real> factors) {
  std::complex<Real>* const columns = state_->spectrum.data() + block * state_->stride;
  const std::size_t count = state_->blocks.block_size();
  const FftwBuffer<std::complex<Real>> column_spectra(count);
  std::complex<Real>* const coefficients = column_spectra.data();
  Fftw<Real>::transform(state_->plans[columns_forward], as_fftw(columns), as_fftw(coefficients));
  paired_row_kernels<Real>().multiply(factors.data() + block * count, count, coefficients);
  Fftw<Real>::transform(state_->plans[columns_inverse], as_fftw(coefficients), as_fftw(columns));
}

template <typename Real>
std::vector<Real> arranged_factors(const Plane<double>& spectrum, int width) {
  const ColumnBlocks<Real> blocks{spectrum.height(), width};
  std::vector<Real> factors(blocks.count() * blocks.block_size());
  for (std::size_t block = 0; block < blocks.count(); ++block) {
    blocks.for_each(block, [&](std::size_t i, int y, int x) {
      const bool is_stored = x < spectrum.width();
      const int opposite_y = y == 0 ? 0 : blocks.height - y;
      factors[i] =
          static_cast<Real>(is_stored ? spectrum.at(y, x) : spectrum.at(opposite_y, width - x));
    });
  }
  return factors;
}

template class PlaneFilter<float>;
template class PlaneFilter<double>;
template std::vector<float> arranged_factors(const Plane<double>&, int);
template std::vector<double> arranged_factors(const Plane<double>&, int);

}  // namespace touchtrial::engine
