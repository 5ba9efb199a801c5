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

class StratumMeans {
 public:
  void add(double mean, double variance) {
    means_.push_back(mean);
    variances_.push_back(variance);
  }

  struct WeightedSums {
    double weights = 0.0;
    double mean = 0.0;
    double squares = 0.0;  ///< weighted squared distances from the mean
  };

  /// \param between  variance of the true means of strata
  [[nodiscard]] WeightedSums weighted_sums(double between) const {
    WeightedSums result;
    for (std::size_t i = 0; i < means_.size(); ++i) {
      const double weight = 1.0 / (variances_[i] + between);
      result.weights += weight;
      result.mean += weight * means_[i];
    }
    result.mean /= result.weights;
    for (std::size_t i = 0; i < means_.size(); ++i) {
      result.squares += std::pow(means_[i] - result.mean, 2) / (variances_[i] + between);
    }
    return result;
  }

  [[nodiscard]] double degrees() const { return static_cast<double>(means_.size()) - 1.0; }

  /// Paule and Mandel's variance between strata, at which the weighted squares equal their
  /// expectation.
  [[nodiscard]] double between() const {
    if (weighted_sums(0.0).squares <= degrees()) return 0.0;
    double upper = std::pow(std::ranges::max(means_) - std::ranges::min(means_), 2);
    while (weighted_sums(upper).squares > degrees()) upper *= 2.0;
    std::uintmax_t steps = 200;
    const auto [a, b] = boost::math::tools::toms748_solve(
        [this](double variance) { return weighted_sums(variance).squares - degrees(); }, 0.0, upper,
        boost::math::tools::eps_tolerance<double>(50), steps);
    return 0.5 * (a + b);
  }

 private:
  std::vector<double> means_;
  std::vector<double> variances_;
};

Interval t_interval(double mean, double error, double degrees, double level, Interval range) {
  const boost::math::students_t_distribution<> t(degrees);
  const double half_width = boost::math::quantile(t, 0.5 + level / 2.0) * error;
  return {std::clamp(without_noise(mean - half_width), range.low, range.high),
          std::clamp(without_noise(mean + half_width), range.low, range.high)};
}

RandomStrata random_strata(const StratumMeans& means, double level, Interval range) {
  const double between = means.between();
  const auto sums = means.weighted_sums(between);
  const double error = std::sqrt(sums.squares / (means.degrees() * sums.weights));
  return {sums.mean, t_interval(sums.mean, error, means.degrees(), level, range),
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
  for (const std::vector<double>& stratum : strata) {
    require_finite(stratum, "a mean over strata");
    if (stratum.empty()) continue;
    ++result.strata;
    const double mean = mean_of(stratum);
    for (const double value : stratum) squares += (value - mean) * (value - mean);
    values += static_cast<double>(stratum.size());
    sum += mean * static_cast<double>(stratum.size());
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
  for (const std::vector<double>& stratum : strata) {
    if (!stratum.empty())
      means.add(mean_of(stratum), variance / static_cast<double>(stratum.size()));
  }
  result.random = random_strata(means, level, range);
  return result;
}

}  // namespace touchtrial::analysis
