#include "engine/perception/felt_classifier.hpp"

#include "core/cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace touchtrial::engine {
namespace {

/// The resolution of a feature, so that equal examples do not make a class infinitely narrow.
constexpr double kResolution = 1e-3;

/// A square matrix, row-major.
struct Matrix {
  explicit Matrix(std::size_t n) : size(n), values(n * n, 0.0) {}
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return values[row * size + column];
  }
  std::size_t size;
  std::vector<double> values;
};

void check_noise(FeltNoise noise) {
  for (const double deviation : {noise.independent, noise.common}) {
    if (!std::isfinite(deviation) || deviation < 0.0) {
      throw std::invalid_argument("FeltClassifier: noise must be a finite number >= 0");
    }
  }
}

bool all_finite(std::span<const double> features) {
  return std::ranges::all_of(features, [](double f) { return std::isfinite(f); });
}

void check(std::span<const FeltExample> examples) {
  if (examples.empty()) throw std::invalid_argument("FeltClassifier: there is no example");
  for (const FeltExample& example : examples) {
    if (example.label < 0 || !all_finite(example.features) ||
        example.features.size() != examples.front().features.size()) {
      throw std::invalid_argument("FeltClassifier: an example's label or features are invalid");
    }
  }
}

std::vector<std::vector<double>> means_by_label(std::span<const FeltExample> examples) {
  int max_label = 0;
  for (const FeltExample& example : examples) max_label = std::max(max_label, example.label);
  // Every label needs an example: with more labels than examples, one has none.
  const auto labels = static_cast<std::size_t>(max_label) + 1;
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

Matrix scatter_within_labels(std::span<const FeltExample> examples,
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

/// The covariance that FeltClassifier uses.
/// \param freedom  degrees of freedom of the scatter within labels
Matrix covariance_of(Matrix scatter, double freedom, FeltNoise noise) {
  const std::size_t n = scatter.size;
  const double off_diagonal = freedom / (freedom + static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      scatter.at(i, j) *= (i == j ? 1.0 : off_diagonal) / std::max(freedom, 1.0);
      scatter.at(i, j) += noise.common * noise.common;
    }
    scatter.at(i, i) += noise.independent * noise.independent + kResolution * kResolution;
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

}  // namespace

FeltStatistics::FeltStatistics(int labels, std::size_t features) : features_(features) {
  if (labels < 1 || features < 1) {
    throw std::invalid_argument("FeltStatistics: there must be a label and a feature");
  }
  counts_.resize(static_cast<std::size_t>(labels), 0);
  means_.resize(counts_.size() * features, 0.0);
  scatter_.resize(features * features, 0.0);
}

void FeltStatistics::learn(int label, std::span<const double> features) {
  check(label, features);
  const double previous_count = counts_[label]++;
  add_to_scatter(label, features, previous_count / (previous_count + 1.0));
  double* mean = means_.data() + static_cast<std::size_t>(label) * features_;
  for (std::size_t i = 0; i < features_; ++i)
    mean[i] += (features[i] - mean[i]) / (previous_count + 1.0);
}

void FeltStatistics::forget(int label, std::span<const double> features) {
  check(label, features);
  if (counts_[label] == 0) throw std::invalid_argument("FeltStatistics: nothing to forget");
  const double remaining_count = --counts_[label];
  double* mean = means_.data() + static_cast<std::size_t>(label) * features_;
  if (remaining_count == 0.0) {
    std::fill_n(mean, features_, 0.0);
    return;
  }
  // The deviation from the mean without the example has the same direction and another scale.
  add_to_scatter(label, features, -(remaining_count + 1.0) / remaining_count);
  for (std::size_t i = 0; i < features_; ++i) mean[i] -= (features[i] - mean[i]) / remaining_count;
}

int FeltStatistics::degrees_of_freedom() const noexcept {
  int freedom = 0;
  for (const int count : counts_) freedom += std::max(count - 1, 0);
  return freedom;
}

std::span<const double> FeltStatistics::mean(int label) const noexcept {
  return std::span(means_).subspan(static_cast<std::size_t>(label) * features_, features_);
}

void FeltStatistics::check(int label, std::span<const double> features) const {
  if (label < 0 || label >= labels() || features.size() != features_ || !all_finite(features)) {
    throw std::invalid_argument("FeltStatistics: an example's label or features are invalid");
  }
}

void FeltStatistics::add_to_scatter(int label, std::span<const double> features, double weight) {
  const std::span<const double> centre = mean(label);
  for (std::size_t i = 0; i < features_; ++i) {
    const double weighted = weight * (features[i] - centre[i]);
    for (std::size_t j = 0; j < features_; ++j) {
      scatter_[i * features_ + j] += weighted * (features[j] - centre[j]);
    }
  }
}

FeltClassifier::FeltClassifier(std::span<const FeltExample> examples, FeltNoise noise) {
  check(examples);
  check_noise(noise);
  dimensions_ = examples.front().features.size();
  std::vector<std::vector<double>> means = means_by_label(examples);
  const auto freedom = static_cast<double>(examples.size() - means.size());
  Matrix covariance = covariance_of(scatter_within_labels(examples, means), freedom, noise);
  initialise(std::move(covariance.values), std::move(means));
}

FeltClassifier::FeltClassifier(const FeltStatistics& statistics, FeltNoise noise)
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
  initialise(std::move(covariance.values), std::move(means));
}

void FeltClassifier::initialise(std::vector<double> covariance,
                                std::vector<std::vector<double>> means) {
  Matrix within(dimensions_);
  within.values = std::move(covariance);
  static_cast<void>(factorise(within.values, dimensions_));
  log_peak_ = -0.5 * static_cast<double>(dimensions_) * std::log(2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < dimensions_; ++i) log_peak_ -= std::log(within.at(i, i));
  factor_ = std::move(within.values);
  means_ = std::move(means);
  for (std::vector<double>& mean : means_) {
    if (!mean.empty()) mean = whiten(mean);
  }
}

std::vector<double> FeltClassifier::whiten(std::span<const double> features) const {
  std::vector<double> whitened(features.begin(), features.end());
  solve_lower(factor_, whitened);
  return whitened;
}

std::vector<double> FeltClassifier::log_likelihoods(std::span<const double> features) const {
  if (features.size() != dimensions_) {
    throw std::invalid_argument("FeltClassifier: the number of features differs from the examples");
  }
  const std::vector<double> whitened = whiten(features);
  std::vector<double> logs;
  for (const std::vector<double>& mean : means_) {
    if (mean.empty()) {
      logs.push_back(-std::numeric_limits<double>::infinity());
      continue;
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < dimensions_; ++i) {
      squares += (whitened[i] - mean[i]) * (whitened[i] - mean[i]);
    }
    logs.push_back(log_peak_ - 0.5 * squares);
  }
  return logs;
}

}  // namespace touchtrial::engine
