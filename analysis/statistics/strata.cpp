#include "analysis/statistics/strata.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/roots.hpp>

namespace touchtrial::analysis {
namespace {

/// Means of strata with their precision.
class StratumMeans {
 public:
  void add(double mean, double variance) {
    means_.push_back(mean);
    variances_.push_back(variance);
  }

  struct Weighted {
    double weights = 0.0;
    double mean = 0.0;
    double squares = 0.0;  ///< weighted squared distances from the mean
  };

  /// \param between  variance of the strata's own means
  [[nodiscard]] Weighted weighted(double between) const {
    Weighted of;
    for (std::size_t i = 0; i < means_.size(); ++i) {
      const double weight = 1.0 / (variances_[i] + between);
      of.weights += weight;
      of.mean += weight * means_[i];
    }
    of.mean /= of.weights;
    for (std::size_t i = 0; i < means_.size(); ++i) {
      of.squares += std::pow(means_[i] - of.mean, 2) / (variances_[i] + between);
    }
    return of;
  }

  [[nodiscard]] double degrees() const { return static_cast<double>(means_.size()) - 1.0; }

  /// Paule and Mandel's variance between strata, at which the weighted squares equal their
  /// expectation.
  [[nodiscard]] double between() const {
    if (weighted(0.0).squares <= degrees()) return 0.0;
    double most = std::pow(std::ranges::max(means_) - std::ranges::min(means_), 2);
    while (weighted(most).squares > degrees()) most *= 2.0;
    std::uintmax_t steps = 200;
    const auto [a, b] = boost::math::tools::toms748_solve(
        [this](double variance) { return weighted(variance).squares - degrees(); }, 0.0, most,
        boost::math::tools::eps_tolerance<double>(50), steps);
    return 0.5 * (a + b);
  }

 private:
  std::vector<double> means_;
  std::vector<double> variances_;
};

Interval t_interval(double mean, double error, double degrees, double level, Interval range) {
  const boost::math::students_t_distribution<> t(degrees);
  const double reach = boost::math::quantile(t, 0.5 + level / 2.0) * error;
  return {std::clamp(without_noise(mean - reach), range.low, range.high),
          std::clamp(without_noise(mean + reach), range.low, range.high)};
}

RandomStrata random_strata(const StratumMeans& means, double level, Interval range) {
  const double between = means.between();
  const auto weighted = means.weighted(between);
  const double error = std::sqrt(weighted.squares / (means.degrees() * weighted.weights));
  return {weighted.mean, t_interval(weighted.mean, error, means.degrees(), level, range),
          std::sqrt(between)};
}

}  // namespace

std::optional<StratifiedMean> stratified_mean(std::span<const std::vector<double>> strata,
                                              Interval range, double level) {
  require_level(level);
  StratifiedMean result;
  double values = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const std::vector<double>& own : strata) {
    require_finite(own, "a mean over strata");
    if (own.empty()) continue;
    ++result.strata;
    const double mean = mean_of(own);
    for (const double value : own) squares += (value - mean) * (value - mean);
    values += static_cast<double>(own.size());
    sum += mean * static_cast<double>(own.size());
  }
  if (result.strata < 2) return std::nullopt;
  result.mean = without_noise(sum / values);
  const double degrees = values - result.strata;
  if (degrees < 1.0) return result;
  const double variance = without_noise(squares / degrees);
  if (variance == 0.0) return result;
  result.interval = t_interval(result.mean, std::sqrt(variance / values), degrees, level, range);
  if (result.strata < kMinRandomStrata) return result;
  StratumMeans means;
  for (const std::vector<double>& own : strata) {
    if (!own.empty()) means.add(mean_of(own), variance / static_cast<double>(own.size()));
  }
  result.random = random_strata(means, level, range);
  return result;
}

}  // namespace touchtrial::analysis
