/// \file Kernels of PlaneFilter, which use the best instruction set of the machine. Two rows a and b
/// are transformed together as Z = F(a + i b). Real is float or double.
#pragma once

#include <complex>
#include <cstddef>

namespace touchtrial::engine {

/// The storage of two rows' coefficients: blocks of one cache line of the upper row followed by one
/// cache line of the lower row.
template <typename Real>
struct PairedLines {
  std::complex<Real>* first;  ///< of the upper row
  std::size_t stride;         ///< between blocks
  std::size_t blocks;
};

template <typename Real>
struct PairedRowKernels {
  /// z = a + i b
  void (*join_rows)(const Real* a, const Real* b, std::size_t width, std::complex<Real>* z);
  /// a + i b = scale * z
  void (*split_rows)(const std::complex<Real>* z, std::size_t width, Real scale, Real* a, Real* b);
  /// Writes the lines of 2 F(a) and 2 F(b).
  /// \param z  F(a + i b), width + 1 coefficients, the last one equal to the first
  void (*split_spectra)(const std::complex<Real>* z, std::size_t width,
                        const PairedLines<Real>& lines);
  /// The inverse: z = A + i B, where lines hold A and B, the spectra of real rows.
  /// \param z  receives width + 1 coefficients; the last is meaningless
  void (*join_spectra)(const PairedLines<Real>& lines, std::size_t width, std::complex<Real>* z);
  /// coefficients *= factors
  void (*multiply)(const Real* factors, std::size_t count, std::complex<Real>* coefficients);
};

template <typename Real>
[[nodiscard]] PairedRowKernels<Real> paired_row_kernels();

}  // namespace touchtrial::engine
