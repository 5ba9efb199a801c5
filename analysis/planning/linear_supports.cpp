#include "analysis/planning/linear_supports.hpp"

#include "engine/perception/felt_classifier.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

engine::FeltFeatures mean_of(const std::vector<engine::FeltExample>& examples) {
  engine::FeltFeatures mean{};
  for (const engine::FeltExample& example : examples) {
    for (int i = 0; i < engine::kFeltFeatures; ++i) mean[i] += example.features[i];
  }
  for (double& value : mean) value /= static_cast<double>(examples.size());
  return mean;
}

double product(const double* a, const double* b, int count) noexcept {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

int noise_dimensions(int prototypes) noexcept {
  return std::clamp(prototypes - 1, 1, engine::kFeltFeatures);
}

LinearSupports::LinearSupports(const session::FeltKnowledge& knowledge, double weber)
    : middle_(mean_of(knowledge.examples)) {
  const engine::FeltClassifier classifier(knowledge.examples, weber);
  constant_ = classifier.log_likelihoods(middle_);
  dimensions_ = noise_dimensions(prototypes());
  gradient_.resize(constant_.size() * engine::kFeltFeatures);
  for (int feature = 0; feature < engine::kFeltFeatures; ++feature) {
    engine::FeltFeatures moved = middle_;
    moved[feature] += 1.0;
    const std::vector<double> logs = classifier.log_likelihoods(moved);
    for (std::size_t k = 0; k < logs.size(); ++k) {
      gradient_[k * engine::kFeltFeatures + feature] =
          (logs[k] - constant_[k]) - (logs[0] - constant_[0]);
    }
  }
  const double first = constant_.front();
  for (double& value : constant_) value -= first;
  factorise_noise(weber);
}

/// Cholesky's factor of the covariance of the supports' noise, which is weber^2 times the
/// gradients' products. What depends on those before (equal stimuli, or more than there are
/// features) has no column of its own.
void LinearSupports::factorise_noise(double weber) {
  const int rows = prototypes();
  factor_.assign(static_cast<std::size_t>(rows) * dimensions_, 0.0);
  int column = 0;
  for (int pivot = 1; pivot < rows && column < dimensions_; ++pivot) {
    const double* own = &gradient_[static_cast<std::size_t>(pivot) * engine::kFeltFeatures];
    const double* own_row = &factor_[static_cast<std::size_t>(pivot) * dimensions_];
    const double variance = weber * weber * product(own, own, engine::kFeltFeatures);
    const double left = variance - product(own_row, own_row, column);
    constexpr double kNothing = 1e-12;
    if (!(left > kNothing * variance)) continue;
    const double root = std::sqrt(left);
    for (int k = pivot; k < rows; ++k) {
      const double* other = &gradient_[static_cast<std::size_t>(k) * engine::kFeltFeatures];
      double* row = &factor_[static_cast<std::size_t>(k) * dimensions_];
      const double covariance = weber * weber * product(own, other, engine::kFeltFeatures);
      row[column] = (covariance - product(own_row, row, column)) / root;
    }
    ++column;
  }
}

void LinearSupports::at(const engine::FeltFeatures& felt,
                        std::span<double> supports) const noexcept {
  engine::FeltFeatures apart{};
  for (int i = 0; i < engine::kFeltFeatures; ++i) apart[i] = felt[i] - middle_[i];
  for (std::size_t k = 0; k < supports.size(); ++k) {
    supports[k] = constant_[k] + product(&gradient_[k * engine::kFeltFeatures], apart.data(),
                                         engine::kFeltFeatures);
  }
}

void LinearSupports::noise(std::span<const double> normals,
                           std::span<double> supports) const noexcept {
  for (std::size_t k = 0; k < supports.size(); ++k) {
    supports[k] =
        product(&factor_[k * static_cast<std::size_t>(dimensions_)], normals.data(), dimensions_);
  }
}

}  // namespace touchtrial::planning
