#include "protocols/procedures/posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace touchtrial::procedures {
namespace {

constexpr std::size_t kMaxNumbers = 20'000'000;
constexpr double kTie = 1e-9;

/// p log p, with the limit 0 at 0.
double p_log_p(double p) noexcept {
  return p > 0.0 ? p * std::log(p) : 0.0;
}

/// Uses eight partial sums, so that the compiler can vectorise without changing the order.
double dot(std::span<const double> a, std::span<const double> b) noexcept {
  constexpr std::size_t kLanes = 8;
  std::array<double, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= a.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  }
  for (; i < a.size(); ++i) sums[0] += a[i] * b[i];
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

void require_ascending(std::span<const double> values, const char* what) {
  const bool is_finite =
      std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  const bool is_ascending =
      std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  if (values.empty() || !is_finite || !is_ascending) {
    throw std::invalid_argument(std::string(what) + " must be an ascending list of numbers");
  }
}

/// \return weights that add up to 1
std::vector<double> normalised_prior(std::vector<double> prior, std::size_t size) {
  if (prior.empty()) prior.assign(size, 1.0);
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  const bool is_valid =
      std::all_of(prior.begin(), prior.end(), [](double w) { return w >= 0.0; }) && sum > 0.0 &&
      std::isfinite(sum);
  if (prior.size() != size || !is_valid) {
    throw std::invalid_argument("a prior needs a weight of at least 0 for each value");
  }
  for (double& weight : prior) weight /= sum;
  return prior;
}

/// All combinations of the grid's values: the threshold varies slowest, the lapse rate fastest.
std::vector<Observer> observers_of(const ParameterGrid& grid) {
  std::vector<Observer> observers;
  observers.reserve(grid.thresholds.size() * grid.slopes.size() * grid.lapses.size());
  for (const double threshold : grid.thresholds) {
    for (const double slope : grid.slopes) {
      for (const double lapse : grid.lapses) {
        observers.push_back({grid.shape, threshold, slope, grid.guess, lapse});
        require_possible(observers.back());
      }
    }
  }
  return observers;
}

std::vector<double> prior_weights(const ParameterGrid& grid) {
  const std::vector<double> t = normalised_prior(grid.threshold_prior, grid.thresholds.size());
  const std::vector<double> s = normalised_prior(grid.slope_prior, grid.slopes.size());
  const std::vector<double> l = normalised_prior(grid.lapse_prior, grid.lapses.size());
  std::vector<double> weights;
  weights.reserve(t.size() * s.size() * l.size());
  for (const double a : t) {
    for (const double b : s) {
      for (const double c : l) weights.push_back(a * b * c);
    }
  }
  return weights;
}

}  // namespace

double mean_of(const Marginal& marginal) noexcept {
  return dot(marginal.values, marginal.weights);
}

double sd_of(const Marginal& marginal) noexcept {
  const double mean = mean_of(marginal);
  double sum = 0.0;
  for (std::size_t i = 0; i < marginal.values.size(); ++i) {
    const double deviation = marginal.values[i] - mean;
    sum += marginal.weights[i] * deviation * deviation;
  }
  return std::sqrt(sum);
}

std::size_t first_min(std::span<const double> entropies) noexcept {
  const double min = *std::min_element(entropies.begin(), entropies.end());
  const auto found = std::find_if(entropies.begin(), entropies.end(),
                                  [&](double entropy) { return entropy <= min + kTie; });
  return static_cast<std::size_t>(found - entropies.begin());
}

Posterior::Posterior(std::span<const double> levels, ParameterGrid grid)
    : grid_(std::move(grid)), level_count_(levels.size()) {
  require_ascending(levels, "levels");
  require_ascending(grid_.thresholds, "thresholds");
  require_ascending(grid_.slopes, "slopes");
  require_ascending(grid_.lapses, "lapses");
  const double numbers =
      2.0 * static_cast<double>(levels.size()) * static_cast<double>(grid_.thresholds.size()) *
      static_cast<double>(grid_.slopes.size()) * static_cast<double>(grid_.lapses.size());
  if (numbers > static_cast<double>(kMaxNumbers)) {
    throw std::invalid_argument("the grid has too many points: use fewer levels or values");
  }
  const std::vector<Observer> observers = observers_of(grid_);
  weights_ = prior_weights(grid_);
  correct_.reserve(level_count_ * observers.size());
  answer_entropy_.reserve(level_count_ * observers.size());
  for (const double level : levels) {
    AnswerShares f;
    for (std::size_t i = 0; i < observers.size(); ++i) {
      const Observer& observer = observers[i];
      // Neighbouring observers differ only in the lapse rate.
      if (i % grid_.lapses.size() == 0) {
        f = shares_at({observer.shape, observer.threshold, observer.slope, 0.0, 0.0}, level);
      }
      const double scale = 1.0 - observer.guess - observer.lapse;
      const double correct = observer.guess + scale * f.correct;
      correct_.push_back(correct);
      answer_entropy_.push_back(-p_log_p(correct) - p_log_p(observer.lapse + scale * f.wrong));
    }
  }
}

std::span<const double> Posterior::row(const std::vector<double>& table,
                                       std::size_t level) const noexcept {
  return std::span(table).subspan(level * weights_.size(), weights_.size());
}

void Posterior::observe(std::size_t level, bool correct) noexcept {
  const std::span<const double> right = row(correct_, level);
  const auto likelihood = [&](std::size_t i) { return correct ? right[i] : 1.0 - right[i]; };
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] * likelihood(i);
  if (!(sum > 0.0)) return;
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] *= likelihood(i) / sum;
}

// The expected entropy of all parameters is their current entropy minus their mutual information
// with the answer, which is the answer's entropy minus its expected entropy given the parameters.
double Posterior::joint_entropy_at(std::size_t level, double entropy_now) const noexcept {
  const double correct = dot(weights_, row(correct_, level));
  const double answer_entropy = -p_log_p(correct) - p_log_p(1.0 - correct);
  return entropy_now - (answer_entropy - dot(weights_, row(answer_entropy_, level)));
}

// With q_i the probability of "value i and this answer" and P their sum, the answer's part of the
// expected entropy is P log P - sum of q_i log q_i.
double Posterior::marginal_entropy_at(std::size_t level,
                                      std::size_t nuisance_points) const noexcept {
  const std::span<const double> right = row(correct_, level);
  double all_correct = 0.0;
  double all_wrong = 0.0;
  double sum = 0.0;
  for (std::size_t first = 0; first < weights_.size(); first += nuisance_points) {
    const std::span<const double> weights = std::span(weights_).subspan(first, nuisance_points);
    double total = 0.0;
    for (const double weight : weights) total += weight;
    const double correct = dot(weights, right.subspan(first, nuisance_points));
    const double wrong = std::max(0.0, total - correct);
    all_correct += correct;
    all_wrong += wrong;
    sum += p_log_p(correct) + p_log_p(wrong);
  }
  return p_log_p(all_correct) + p_log_p(all_wrong) - sum;
}

std::vector<double> Posterior::expected_entropies(Nuisance nuisance) const {
  std::vector<double> entropies(level_count_);
  if (nuisance == Nuisance::none) {
    double entropy_now = 0.0;
    for (const double weight : weights_) entropy_now -= p_log_p(weight);
    for (std::size_t i = 0; i < level_count_; ++i) entropies[i] = joint_entropy_at(i, entropy_now);
    return entropies;
  }
  const std::size_t lapses = grid_.lapses.size();
  const std::size_t nuisance_points =
      nuisance == Nuisance::lapse ? lapses : grid_.slopes.size() * lapses;
  for (std::size_t i = 0; i < level_count_; ++i)
    entropies[i] = marginal_entropy_at(i, nuisance_points);
  return entropies;
}

std::size_t Posterior::best_level(Nuisance nuisance) const {
  return first_min(expected_entropies(nuisance));
}

Marginal Posterior::threshold() const {
  Marginal marginal{grid_.thresholds, std::vector<double>(grid_.thresholds.size())};
  const std::size_t stride = weights_.size() / marginal.values.size();
  for (std::size_t i = 0; i < weights_.size(); ++i) marginal.weights[i / stride] += weights_[i];
  return marginal;
}

Marginal Posterior::slope() const {
  Marginal marginal{grid_.slopes, std::vector<double>(grid_.slopes.size())};
  const std::size_t stride = grid_.lapses.size();
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    marginal.weights[i / stride % marginal.values.size()] += weights_[i];
  }
  return marginal;
}

Marginal Posterior::lapse() const {
  Marginal marginal{grid_.lapses, std::vector<double>(grid_.lapses.size())};
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    marginal.weights[i % marginal.values.size()] += weights_[i];
  }
  return marginal;
}

Observer Posterior::mode() const {
  const auto index = static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) -
                                              weights_.begin());
  const std::size_t lapses = grid_.lapses.size();
  const std::size_t slopes = grid_.slopes.size();
  return {grid_.shape, grid_.thresholds[index / lapses / slopes],
          grid_.slopes[index / lapses % slopes], grid_.guess, grid_.lapses[index % lapses]};
}

}  // namespace touchtrial::procedures
