#include "engine/perception/felt_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::engine {

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
  const double before = counts_[label]++;
  add_to_scatter(label, features, before / (before + 1.0));
  double* mean = means_.data() + static_cast<std::size_t>(label) * features_;
  for (std::size_t i = 0; i < features_; ++i) mean[i] += (features[i] - mean[i]) / (before + 1.0);
}

void FeltStatistics::forget(int label, std::span<const double> features) {
  check(label, features);
  if (counts_[label] == 0) throw std::invalid_argument("FeltStatistics: nothing to forget");
  const double left = --counts_[label];
  double* mean = means_.data() + static_cast<std::size_t>(label) * features_;
  if (left == 0.0) {
    std::fill_n(mean, features_, 0.0);
    return;
  }
  // The mean without the example lies on the other side: the same outer product, scaled.
  add_to_scatter(label, features, -(left + 1.0) / left);
  for (std::size_t i = 0; i < features_; ++i) mean[i] -= (features[i] - mean[i]) / left;
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
  const bool finite = std::ranges::all_of(features, [](double f) { return std::isfinite(f); });
  if (label < 0 || label >= labels() || features.size() != features_ || !finite) {
    throw std::invalid_argument("FeltStatistics: an example's label or features are impossible");
  }
}

void FeltStatistics::add_to_scatter(int label, std::span<const double> features, double weight) {
  const std::span<const double> at = mean(label);
  for (std::size_t i = 0; i < features_; ++i) {
    const double scaled = weight * (features[i] - at[i]);
    for (std::size_t j = 0; j < features_; ++j) {
      scatter_[i * features_ + j] += scaled * (features[j] - at[j]);
    }
  }
}

}  // namespace touchtrial::engine
