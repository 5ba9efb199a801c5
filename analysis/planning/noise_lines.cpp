#include "analysis/planning/noise_lines.hpp"

#include "core/random.hpp"
#include "engine/perception/felt_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>

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

double dot_product(const double* a, const double* b, int count) noexcept {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

/// Uses the middle of a cell of width 2^-53, so the uniform number is never 0 or 1.
double normal_of(std::uint64_t bits) {
  constexpr int kUnusedBits = 11;
  const double uniform = (static_cast<double>(bits >> kUnusedBits) + 0.5) * 0x1.0p-53;
  // The upper tail by symmetry: doubles are coarser near 1 than near 0.
  const boost::math::normal standard;
  return uniform < 0.5 ? boost::math::quantile(standard, uniform)
                       : boost::math::quantile(boost::math::complement(standard, 1.0 - uniform));
}

constexpr int kCells = 2048;
/// A length beyond sqrt(d) + kFarTail has a probability of about 1e-16.
constexpr double kFarTail = 8.5;

/// The winner at t = -infinity: the prototype with the smallest slope.
std::size_t first_winner(std::span<const double> supports, std::span<const double> slope) noexcept {
  std::size_t best = 0;
  for (std::size_t k = 1; k < supports.size(); ++k) {
    const bool sooner = slope[k] < slope[best];
    if (sooner || (slope[k] == slope[best] && supports[k] > supports[best])) best = k;
  }
  return best;
}

struct Crossing {
  std::size_t winner = 0;
  double t = std::numeric_limits<double>::infinity();
};

/// The next prototype that overtakes the winner, and the crossing point.
Crossing next_winner(std::span<const double> supports, std::span<const double> slope,
                     std::size_t winner) noexcept {
  Crossing next{winner};
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const double gain = slope[k] - slope[winner];
    if (!(gain > 0.0)) continue;
    const double t = (supports[winner] - supports[k]) / gain;
    if (t < next.t || (t == next.t && slope[k] > slope[next.winner])) next = {k, t};
  }
  return next;
}

/// Splits a probability among the pictures of all prototypes that tie with the winner along the
/// whole line.
void split_probability(std::span<const double> supports, std::span<const double> slope,
                       std::span<const int> picture, std::size_t winner, double probability,
                       std::span<double> answers) noexcept {
  const auto is_first_of_picture = [&](std::size_t k) {
    if (supports[k] != supports[winner] || slope[k] != slope[winner]) return false;
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const bool equal = supports[earlier] == supports[winner] && slope[earlier] == slope[winner];
      if (equal && picture[earlier] == picture[k]) return false;
    }
    return true;
  };
  int ties = 0;
  for (std::size_t k = 0; k < supports.size(); ++k) ties += is_first_of_picture(k) ? 1 : 0;
  for (std::size_t k = 0; k < supports.size(); ++k) {
    if (is_first_of_picture(k)) answers[picture[k]] += probability / ties;
  }
}

/// Whether another prototype ties with the winner along the whole line, as stimuli do that feel the
/// same.
bool has_tie(std::span<const double> supports, std::span<const double> slope,
             std::size_t winner) noexcept {
  for (std::size_t k = 0; k < supports.size(); ++k) {
    if (k != winner && slope[k] == slope[winner] && supports[k] == supports[winner]) return true;
  }
  return false;
}

}  // namespace

int noise_dimensions(int prototypes) noexcept {
  return std::clamp(prototypes - 1, 1, engine::kFeltFeatures);
}

LinearSupports::LinearSupports(const simulation::FeltKnowledge& knowledge, engine::FeltNoise noise,
                               const std::optional<simulation::FeltFloor>& floor)
    : floor_(floor) {
  const std::vector<engine::FeltExample> examples =
      simulation::perceived_examples(knowledge, floor);
  const engine::FeltClassifier classifier(examples, noise);
  middle_ = mean_of(examples);
  constant_ = classifier.log_likelihoods(middle_);
  dimensions_ = noise_dimensions(static_cast<int>(constant_.size()));
  gradient_.resize(constant_.size() * engine::kFeltFeatures);
  for (int feature = 0; feature < engine::kFeltFeatures; ++feature) {
    engine::FeltFeatures shifted = middle_;
    shifted[feature] += 1.0;
    const std::vector<double> logs = classifier.log_likelihoods(shifted);
    for (std::size_t k = 0; k < logs.size(); ++k) {
      gradient_[k * engine::kFeltFeatures + feature] =
          (logs[k] - constant_[k]) - (logs[0] - constant_[0]);
    }
  }
  const double first = constant_.front();
  for (double& value : constant_) value -= first;
  factorise_noise(noise);
}

/// Computes the Cholesky factor of the noise's covariance. Independent noise contributes the
/// products of the gradients; noise common to all features contributes the products of their sums.
/// A prototype that depends linearly on the previous ones (equal stimuli, or more stimuli than
/// features) gets no column.
void LinearSupports::factorise_noise(engine::FeltNoise noise) {
  const auto rows = static_cast<int>(constant_.size());
  std::vector<double> sums;
  for (int k = 0; k < rows; ++k) {
    const double* row = &gradient_[static_cast<std::size_t>(k) * engine::kFeltFeatures];
    sums.push_back(std::accumulate(row, row + engine::kFeltFeatures, 0.0));
  }
  const auto covariance_of = [&](int a, int b) {
    const double* first = &gradient_[static_cast<std::size_t>(a) * engine::kFeltFeatures];
    const double* second = &gradient_[static_cast<std::size_t>(b) * engine::kFeltFeatures];
    return noise.independent * noise.independent *
               dot_product(first, second, engine::kFeltFeatures) +
           noise.common * noise.common * (sums[a] * sums[b]);
  };
  factor_.assign(static_cast<std::size_t>(rows) * dimensions_, 0.0);
  int column = 0;
  for (int pivot = 1; pivot < rows && column < dimensions_; ++pivot) {
    const double* pivot_row = &factor_[static_cast<std::size_t>(pivot) * dimensions_];
    const double variance = covariance_of(pivot, pivot);
    const double residual = variance - dot_product(pivot_row, pivot_row, column);
    constexpr double kMinResidualShare = 1e-12;
    if (!(residual > kMinResidualShare * variance)) continue;
    const double root = std::sqrt(residual);
    for (int k = pivot; k < rows; ++k) {
      double* row = &factor_[static_cast<std::size_t>(k) * dimensions_];
      row[column] = (covariance_of(pivot, k) - dot_product(pivot_row, row, column)) / root;
    }
    ++column;
  }
}

void LinearSupports::compute_supports(engine::FeltFeatures felt,
                                      std::span<double> supports) const noexcept {
  if (floor_) floor_->apply_to(felt);
  engine::FeltFeatures difference{};
  for (int i = 0; i < engine::kFeltFeatures; ++i) difference[i] = felt[i] - middle_[i];
  for (std::size_t k = 0; k < supports.size(); ++k) {
    supports[k] = constant_[k] + dot_product(&gradient_[k * engine::kFeltFeatures],
                                             difference.data(), engine::kFeltFeatures);
  }
}

void LinearSupports::compute_noise(std::span<const double> normals,
                                   std::span<double> supports) const noexcept {
  for (std::size_t k = 0; k < supports.size(); ++k) {
    supports[k] = dot_product(&factor_[k * static_cast<std::size_t>(dimensions_)], normals.data(),
                              dimensions_);
  }
}

NoisePoints::NoisePoints(int dimensions, std::size_t count, std::uint64_t seed, std::uint64_t index)
    : dimensions_(static_cast<std::size_t>(dimensions)) {
  RandomStream random(seed, "answer model: shift of the noise points", index);
  std::vector<std::uint64_t> shift(dimensions_);
  for (std::uint64_t& bits : shift) bits = random.bits();
  boost::random::sobol sequence(dimensions_);
  normals_.reserve(dimensions_ * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::uint64_t bits : shift) normals_.push_back(normal_of(sequence() ^ bits));
  }
}

std::vector<double> normal_groups(int groups) {
  const boost::math::normal standard;
  std::vector<double> means;
  double lower_density = 0.0;  // density at the group's lower end
  double squares = 0.0;
  for (int i = 1; i <= groups; ++i) {
    const double upper_density =
        i < groups ? boost::math::pdf(
                         standard, boost::math::quantile(standard, static_cast<double>(i) / groups))
                   : 0.0;
    means.push_back(groups * (lower_density - upper_density));
    squares += means.back() * means.back();
    lower_density = upper_density;
  }
  const double scale = squares > 0.0 ? std::sqrt(groups / squares) : 0.0;
  for (double& mean : means) mean *= scale;
  return means;
}

RadialDistribution::RadialDistribution(int dimensions) {
  if (dimensions < 1) throw std::invalid_argument("RadialDistribution: dimensions start at 1");
  max_length_ = std::sqrt(static_cast<double>(dimensions)) + kFarTail;
  step_ = max_length_ / kCells;
  const boost::math::chi_squared squared(dimensions);
  for (int i = 0; i <= kCells; ++i) {
    const double r = i * step_;
    tail_.push_back(boost::math::cdf(boost::math::complement(squared, r * r)));
    // The density of r is 2 r times the density of r^2, which is infinite at 0 for d = 1.
    const double near = r > 0.0 ? r : 1e-9 * step_;
    density_.push_back(2.0 * near * boost::math::pdf(squared, near * near) * step_);
  }
}

RadialDistribution::Value RadialDistribution::at(double t) const noexcept {
  const double r = std::abs(t);
  if (!(r < max_length_)) return {t > 0.0 ? 1.0 : 0.0, 0.0};
  const int cell = static_cast<int>(r / step_);
  const double x = r / step_ - cell;
  const double left_tail = tail_[cell];
  const double right_tail = tail_[cell + 1];
  const double left_slope = -density_[cell];
  const double right_slope = -density_[cell + 1];
  // Cubic Hermite, and its derivative.
  const double c2 = 3.0 * (right_tail - left_tail) - 2.0 * left_slope - right_slope;
  const double c3 = 2.0 * (left_tail - right_tail) + left_slope + right_slope;
  const double tail = left_tail + x * (left_slope + x * (c2 + x * c3));
  const double density = -(left_slope + x * (2.0 * c2 + 3.0 * x * c3)) / step_;
  return {t > 0.0 ? 1.0 - 0.5 * tail : 0.5 * tail, 0.5 * density};
}

void add_winners(std::span<const double> supports, std::span<const double> slope,
                 std::span<const int> picture, const RadialDistribution& noise, double weight,
                 std::span<double> answers, std::span<double> slopes) noexcept {
  std::size_t winner = first_winner(supports, slope);
  double below = 0.0;
  for (;;) {
    const Crossing next = next_winner(supports, slope, winner);
    const RadialDistribution::Value value = noise.at(next.t);
    const double probability = weight * (value.below - below);
    if (has_tie(supports, slope, winner)) {
      split_probability(supports, slope, picture, winner, probability, answers);
    } else {
      answers[picture[winner]] += probability;
    }
    if (next.winner == winner) return;
    if (!slopes.empty() && value.density > 0.0) {
      const double rate = weight * value.density / (slope[next.winner] - slope[winner]);
      const auto old_picture = static_cast<std::size_t>(picture[winner]);
      const auto new_picture = static_cast<std::size_t>(picture[next.winner]);
      const std::size_t pictures = answers.size();
      slopes[old_picture * pictures + old_picture] += rate;
      slopes[old_picture * pictures + new_picture] -= rate;
      slopes[new_picture * pictures + old_picture] -= rate;
      slopes[new_picture * pictures + new_picture] += rate;
    }
    below = value.below;
    winner = next.winner;
  }
}

}  // namespace touchtrial::planning
