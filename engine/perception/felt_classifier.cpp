#include "engine/perception/felt_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace touchtrial::engine {
namespace {

/// Finest difference in a feature that is believed, so that equal examples do not make a class
/// infinitely narrow.
constexpr double kResolution = 1e-3;

/// Square, row-major.
struct Matrix {
  explicit Matrix(std::size_t n) : size(n), values(n * n, 0.0) {}
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return values[row * size + column];
  }
  std::size_t size;
  std::vector<double> values;
};

void check_noise(double noise) {
  if (!std::isfinite(noise) || noise < 0.0) {
    throw std::invalid_argument("FeltClassifier: noise must be a finite number >= 0");
  }
}

void check(std::span<const FeltExample> examples) {
  if (examples.empty()) throw std::invalid_argument("FeltClassifier: there is no example");
  for (const FeltExample& example : examples) {
    const bool finite =
        std::ranges::all_of(example.features, [](double f) { return std::isfinite(f); });
    if (example.label < 0 || !finite ||
        example.features.size() != examples.front().features.size()) {
      throw std::invalid_argument("FeltClassifier: an example's label or features are impossible");
    }
  }
}

std::vector<std::vector<double>> means_by_label(std::span<const FeltExample> examples) {
  int last = 0;
  for (const FeltExample& example : examples) last = std::max(last, example.label);
  // Every label needs an example, so more labels than examples cannot be.
  const auto labels = static_cast<std::size_t>(last) + 1;
  if (labels > examples.size()) throw std::invalid_argument("FeltClassifier: a label is missing");
  std::vector<std::vector<double>> sums(labels,
                                        std::vector<double>(examples.front().features.size(), 0.0));
  std::vector<int> counts(labels, 0);
  for (const FeltExample& example : examples) {
    std::vector<double>& sum = sums[example.label];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += example.features[i];
    ++counts[example.label];
  }
  for (std::size_t label = 0; label < labels; ++label) {
    if (counts[label] == 0) throw std::invalid_argument("FeltClassifier: a label is missing");
    for (double& value : sums[label]) value /= counts[label];
  }
  return sums;
}

Matrix scatter_within(std::span<const FeltExample> examples,
                      const std::vector<std::vector<double>>& means) {
  const std::size_t n = examples.front().features.size();
  Matrix scatter(n);
  for (const FeltExample& example : examples) {
    const std::vector<double>& mean = means[example.label];
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        scatter.at(i, j) += (example.features[i] - mean[i]) * (example.features[j] - mean[j]);
      }
    }
  }
  return scatter;
}

/// \param freedom  degrees of freedom of the scatter within labels
Matrix covariance_of(Matrix scatter, double freedom, double noise) {
  const std::size_t n = scatter.size;
  const double off_diagonal = freedom / (freedom + static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      scatter.at(i, j) *= (i == j ? 1.0 : off_diagonal) / std::max(freedom, 1.0);
    }
    scatter.at(i, i) += noise * noise + kResolution * kResolution;
  }
  return scatter;
}

std::vector<std::vector<double>> means_of(const FeltStatistics& statistics) {
  std::vector<std::vector<double>> means;
  for (int label = 0; label < statistics.labels(); ++label) {
    const std::span<const double> mean = statistics.mean(label);
    means.emplace_back();
    if (statistics.count(label) > 0) means.back().assign(mean.begin(), mean.end());
  }
  return means;
}

/// The lower triangle L with L L^T = matrix; the matrix is positive definite.
Matrix cholesky(Matrix matrix) {
  for (std::size_t j = 0; j < matrix.size; ++j) {
    for (std::size_t i = j; i < matrix.size; ++i) {
      double rest = matrix.at(i, j);
      for (std::size_t k = 0; k < j; ++k) rest -= matrix.at(i, k) * matrix.at(j, k);
      matrix.at(i, j) = i == j ? std::sqrt(rest) : rest / matrix.at(j, j);
    }
  }
  return matrix;
}

}  // namespace

FeltClassifier::FeltClassifier(std::span<const FeltExample> examples, double noise) {
  check(examples);
  check_noise(noise);
  dimensions_ = examples.front().features.size();
  std::vector<std::vector<double>> means = means_by_label(examples);
  const auto freedom = static_cast<double>(examples.size() - means.size());
  Matrix covariance = covariance_of(scatter_within(examples, means), freedom, noise);
  settle(std::move(covariance.values), std::move(means));
}

FeltClassifier::FeltClassifier(const FeltStatistics& statistics, double noise)
    : dimensions_(statistics.features()) {
  check_noise(noise);
  std::vector<std::vector<double>> means = means_of(statistics);
  if (std::ranges::all_of(means, [](const auto& mean) { return mean.empty(); })) {
    throw std::invalid_argument("FeltClassifier: there is no example");
  }
  Matrix scatter(statistics.features());
  scatter.values.assign(statistics.scatter().begin(), statistics.scatter().end());
  const double freedom = statistics.degrees_of_freedom();
  Matrix covariance = covariance_of(std::move(scatter), freedom, noise);
  settle(std::move(covariance.values), std::move(means));
}

void FeltClassifier::settle(std::vector<double> covariance,
                            std::vector<std::vector<double>> means) {
  Matrix within(dimensions_);
  within.values = std::move(covariance);
  Matrix factor = cholesky(std::move(within));
  log_peak_ = -0.5 * static_cast<double>(dimensions_) * std::log(2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < dimensions_; ++i) log_peak_ -= std::log(factor.at(i, i));
  factor_ = std::move(factor.values);
  means_ = std::move(means);
  for (std::vector<double>& mean : means_) {
    if (!mean.empty()) mean = whitened(mean);
  }
}

std::vector<double> FeltClassifier::whitened(std::span<const double> features) const {
  std::vector<double> white(features.begin(), features.end());
  for (std::size_t i = 0; i < dimensions_; ++i) {
    const double* row = factor_.data() + i * dimensions_;
    for (std::size_t k = 0; k < i; ++k) white[i] -= row[k] * white[k];
    white[i] /= row[i];
  }
  return white;
}

std::vector<double> FeltClassifier::log_likelihoods(std::span<const double> features) const {
  if (features.size() != dimensions_) {
    throw std::invalid_argument("FeltClassifier: the number of features is not the examples'");
  }
  const std::vector<double> white = whitened(features);
  std::vector<double> logs;
  for (const std::vector<double>& mean : means_) {
    if (mean.empty()) {
      logs.push_back(-std::numeric_limits<double>::infinity());
      continue;
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < dimensions_; ++i) {
      squares += (white[i] - mean[i]) * (white[i] - mean[i]);
    }
    logs.push_back(log_peak_ - 0.5 * squares);
  }
  return logs;
}

}  // namespace touchtrial::engine
