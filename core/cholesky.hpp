/// \file The Cholesky factor L of a symmetric matrix (L L^T = matrix), and solvers that use it.
/// Matrices are n x n, row-major.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace touchtrial {

/// Replaces the lower triangle of a matrix by its factor; the upper triangle is unchanged.
/// \param min_share  lower limit of each pivot, as a share of the original diagonal element
/// \return whether the matrix is positive definite; if not, the factor is meaningless
inline bool factorise(std::span<double> matrix, std::size_t n, double min_share = 0.0) {
  bool is_definite = true;
  for (std::size_t j = 0; j < n; ++j) {
    const double diagonal = matrix[j * n + j];
    for (std::size_t i = j; i < n; ++i) {
      double element = matrix[i * n + j];
      for (std::size_t k = 0; k < j; ++k) element -= matrix[i * n + k] * matrix[j * n + k];
      if (i == j) is_definite = is_definite && element > min_share * diagonal;
      matrix[i * n + j] = i == j ? std::sqrt(element) : element / matrix[j * n + j];
    }
  }
  return is_definite;
}

/// Replaces b by the solution x of L x = b.
inline void solve_lower(std::span<const double> factor, std::span<double> b) noexcept {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= factor[i * n + k] * b[k];
    b[i] /= factor[i * n + i];
  }
}

/// Replaces b by the solution x of L^T x = b.
inline void solve_upper(std::span<const double> factor, std::span<double> b) noexcept {
  const std::size_t n = b.size();
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= factor[k * n + i] * b[k];
    b[i] /= factor[i * n + i];
  }
}

}  // namespace touchtrial
