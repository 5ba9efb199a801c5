#include "analysis/planning/symmetric_matrix.hpp"

#include <cmath>

namespace touchtrial::planning {
namespace {

/// The lower triangle's Cholesky factor in place. \return false if there is none
bool factorise(std::vector<double>& matrix, std::size_t n) {
  constexpr double kLeastShare = 1e-10;
  for (std::size_t j = 0; j < n; ++j) {
    const double whole = matrix[j * n + j];
    for (std::size_t i = j; i < n; ++i) {
      double rest = matrix[i * n + j];
      for (std::size_t k = 0; k < j; ++k) rest -= matrix[i * n + k] * matrix[j * n + k];
      if (i == j && !(rest > kLeastShare * whole)) return false;
      matrix[i * n + j] = i == j ? std::sqrt(rest) : rest / matrix[j * n + j];
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<double>> inverse_of(std::vector<double> matrix, std::size_t n) {
  if (!factorise(matrix, n)) return std::nullopt;
  std::vector<double> inverse(n * n, 0.0);
  for (std::size_t column = 0; column < n; ++column) {
    std::vector<double> x(n, 0.0);
    x[column] = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= matrix[i * n + k] * x[k];
      x[i] /= matrix[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) x[i] -= matrix[k * n + i] * x[k];
      x[i] /= matrix[i * n + i];
    }
    for (std::size_t i = 0; i < n; ++i) inverse[i * n + column] = x[i];
  }
  return inverse;
}

}  // namespace touchtrial::planning
