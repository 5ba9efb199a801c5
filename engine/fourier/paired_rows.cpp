#include "engine/fourier/paired_rows.hpp"

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/fourier/paired_rows.cpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Coefficients in a line.
template <typename Real>
constexpr std::size_t kLine = 64 / (2 * sizeof(Real));

template <typename Real>
const Real* reals(const std::complex<Real>* numbers) {
  return reinterpret_cast<const Real*>(numbers);
}

template <typename Real>
Real* reals(std::complex<Real>* numbers) {
  return reinterpret_cast<Real*>(numbers);
}

/// Calls visit(descriptor, index) for full vectors, then for single samples.
template <typename Real, class Visit>
HWY_INLINE void for_each_vector(std::size_t count, const Visit& visit) {
  const hn::ScalableTag<Real> d;
  const hn::CappedTag<Real, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) visit(d, i);
  for (; i < count; ++i) visit(single, i);
}

template <typename Real>
void join_samples(const Real* a, const Real* b, std::size_t width, std::complex<Real>* z) {
  for_each_vector<Real>(width, [&](auto d, std::size_t i) HWY_ATTR {
    hn::StoreInterleaved2(hn::LoadU(d, a + i), hn::LoadU(d, b + i), d, reals(z + i));
  });
}

template <typename Real>
void split_samples(const std::complex<Real>* z, std::size_t width, Real scale, Real* a, Real* b) {
  for_each_vector<Real>(width, [&](auto d, std::size_t i) HWY_ATTR {
    hn::Vec<decltype(d)> real, imaginary;
    hn::LoadInterleaved2(d, reals(z + i), real, imaginary);
    const auto factor = hn::Set(d, scale);
    hn::StoreU(hn::Mul(factor, real), d, a + i);
    hn::StoreU(hn::Mul(factor, imaginary), d, b + i);
  });
}

/// Calls visit(descriptor, index, upper coefficients, lower coefficients) for the vectors of all
/// lines. The vector length divides the length of a line.
template <typename Real, class Visit>
HWY_INLINE void for_each_line(const PairedLines<Real>& lines, const Visit& visit) {
  const hn::CappedTag<Real, kLine<Real>> d;
  for (std::size_t block = 0; block < lines.blocks; ++block) {
    std::complex<Real>* const upper = lines.first + block * lines.stride;
    for (std::size_t i = 0; i < kLine<Real>; i += hn::Lanes(d)) {
      visit(d, block * kLine<Real> + i, reals(upper + i), reals(upper + kLine<Real> + i));
    }
  }
}

/// With z' the conjugate of the opposite coefficient, 2 F(a) = z + z' and 2 F(b) = -i (z - z').
template <typename Real>
void split_coefficients(const std::complex<Real>* z, std::size_t width,
                        const PairedLines<Real>& lines) {
  for_each_line(lines, [&](auto d, std::size_t i, Real* upper, Real* lower) HWY_ATTR {
    hn::Vec<decltype(d)> real, imaginary, opposite_real, opposite_imaginary;
    hn::LoadInterleaved2(d, reals(z + i), real, imaginary);
    hn::LoadInterleaved2(d, reals(z + width + 1 - hn::Lanes(d) - i), opposite_real,
                         opposite_imaginary);
    opposite_real = hn::Reverse(d, opposite_real);
    opposite_imaginary = hn::Reverse(d, opposite_imaginary);
    hn::StoreInterleaved2(hn::Add(real, opposite_real), hn::Sub(imaginary, opposite_imaginary), d,
                          upper);
    hn::StoreInterleaved2(hn::Add(imaginary, opposite_imaginary), hn::Sub(opposite_real, real), d,
                          lower);
  });
}

template <typename Real>
void join_coefficients(const PairedLines<Real>& lines, std::size_t width, std::complex<Real>* z) {
  for_each_line(lines, [&](auto d, std::size_t i, const Real* upper, const Real* lower) HWY_ATTR {
    // The lines of the next pair of rows follow in memory.
    hwy::Prefetch(upper + 4 * kLine<Real>);
    hwy::Prefetch(lower + 4 * kLine<Real>);
    hn::Vec<decltype(d)> a_real, a_imaginary, b_real, b_imaginary;
    hn::LoadInterleaved2(d, upper, a_real, a_imaginary);
    hn::LoadInterleaved2(d, lower, b_real, b_imaginary);
    hn::StoreInterleaved2(hn::Sub(a_real, b_imaginary), hn::Add(a_imaginary, b_real), d,
                          reals(z + i));
    hn::StoreInterleaved2(hn::Reverse(d, hn::Add(a_real, b_imaginary)),
                          hn::Reverse(d, hn::Sub(b_real, a_imaginary)), d,
                          reals(z + width + 1 - hn::Lanes(d) - i));
  });
}

template <typename Real>
void multiply(const Real* factors, std::size_t count, std::complex<Real>* coefficients) {
  for_each_vector<Real>(count, [&](auto d, std::size_t i) HWY_ATTR {
    hn::Vec<decltype(d)> real, imaginary;
    Real* const values = reals(coefficients + i);
    hn::LoadInterleaved2(d, values, real, imaginary);
    const auto factor = hn::LoadU(d, factors + i);
    hn::StoreInterleaved2(hn::Mul(factor, real), hn::Mul(factor, imaginary), d, values);
  });
}

// A target exports functions, not templates.
PairedRowKernels<float> kernels_f32() {
  return {join_samples<float>, split_samples<float>, split_coefficients<float>,
          join_coefficients<float>, multiply<float>};
}
PairedRowKernels<double> kernels_f64() {
  return {join_samples<double>, split_samples<double>, split_coefficients<double>,
          join_coefficients<double>, multiply<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {

HWY_EXPORT(kernels_f32);
HWY_EXPORT(kernels_f64);

template <>
PairedRowKernels<float> paired_row_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels_f32)();
}
template <>
PairedRowKernels<double> paired_row_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels_f64)();
}

}  // namespace touchtrial::engine
#endif
