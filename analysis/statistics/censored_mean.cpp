#include "analysis/statistics/censored_mean.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/fraction.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace touchtrial::analysis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLogRootTwoPi = 0.91893853320467274178;  // log sqrt(2 pi)

/// Terms of the continued fraction z + 1 / (z + 2 / (z + 3 / ...)), the reciprocal of Mills' ratio.
class MillsFraction {
 public:
  using result_type = std::pair<double, double>;

  explicit MillsFraction(double z) : z_(z) {}
  result_type operator()() { return {index_++, z_}; }

 private:
  double z_;
  double index_ = 0.0;
};

/// The logarithm of the standard normal probability above z.
double log_above(double z) {
  constexpr double kTail = 10.0;
  if (z < kTail) return std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  if (z == kInfinity) return -kInfinity;
  MillsFraction terms(z);
  const double fraction =
      boost::math::tools::continued_fraction_b(terms, std::numeric_limits<double>::epsilon());
  return -0.5 * z * z - kLogRootTwoPi - std::log(fraction);
}

/// The logarithm of the standard normal probability between two ends.
double log_between(double low, double high) {
  if (low + high < 0.0) return log_between(-high, -low);
  if (high == kInfinity) return log_above(low);
  const double width = high - low;
  const double middle = 0.5 * (low + high);
  if (width * std::max(1.0, middle) < 1e-4) {
    // Subtracting two tails would cancel most digits; the density is almost uniform here.
    const double curvature = (middle * middle - 1.0) * width * width / 24.0;
    return -0.5 * middle * middle - kLogRootTwoPi + std::log(width) + std::log1p(curvature);
  }
  if (low <= 0.0) {
    return std::log(0.5 *
                    (std::erfc(low / std::numbers::sqrt2) - std::erfc(high / std::numbers::sqrt2)));
  }
  const double above_low = log_above(low);
  return above_low + std::log(-std::expm1(log_above(high) - above_low));
}

struct TiedBounds {
  Bounds bounds;
  int people = 0;
};

/// One participant's contribution to the log likelihood and its derivatives.
struct Contribution {
  double value = 0.0;
  double mean_slope = 0.0;       ///< derivative with respect to the mean
  double precision_slope = 0.0;  ///< derivative with respect to the precision
};

Contribution contribution_of(const Bounds& bounds, double mean, double precision) {
  const double low = precision * (bounds.low - mean);
  const double high = precision * (bounds.high - mean);
  Contribution result{.value = log_between(low, high)};
  const auto density = [&](double z) {
    return std::exp(-0.5 * z * z - kLogRootTwoPi - result.value);
  };
  if (std::isfinite(low)) {
    result.mean_slope += precision * density(low);
    result.precision_slope -= (bounds.low - mean) * density(low);
  }
  if (std::isfinite(high)) {
    result.mean_slope -= precision * density(high);
    result.precision_slope += (bounds.high - mean) * density(high);
  }
  return result;
}

/// The likelihood of a normal distribution as a function of its mean and its precision, here
/// defined as 1 / SD. It is concave in 1 / SD and mean / SD (Olsen 1978), so each mean has one most
/// likely precision, and the profile likelihood has one maximum.
class NormalLikelihood {
 public:
  /// \pre at least two known values differ
  explicit NormalLikelihood(std::span<const Bounds> people);

  [[nodiscard]] double known_count() const noexcept { return known_count_; }
  [[nodiscard]] double most_likely_mean() const;
  [[nodiscard]] double profile(double mean) const { return sum_at(mean, precision_at(mean)).value; }
  [[nodiscard]] double sd_at(double mean) const {
    return std::sqrt(known_count_ / (known_count_ - 1.0)) / precision_at(mean);
  }
  /// The mean at which `function`, which is >= 0 at `start` and decreases along the step, reaches
  /// 0.
  template <typename Function>
  [[nodiscard]] double zero_along(const Function& function, double start, double step) const;

 private:
  [[nodiscard]] Contribution sum_at(double mean, double precision) const;
  [[nodiscard]] double precision_at(double mean) const;

  double known_count_ = 0.0;
  double center_ = 0.0;   ///< mean of the known values
  double squares_ = 0.0;  ///< sum of their squared distances from center_
  std::vector<TiedBounds> censored_;
};

constexpr std::uintmax_t kMaxRootSteps = 200;

NormalLikelihood::NormalLikelihood(std::span<const Bounds> people) {
  std::vector<double> values;
  for (const Bounds& one : people) {
    if (one.exact()) {
      values.push_back(one.low);
    } else if (one != Bounds{}) {
      const auto tied = std::ranges::find(censored_, one, &TiedBounds::bounds);
      if (tied == censored_.end()) {
        censored_.push_back({one, 1});
      } else {
        ++tied->people;
      }
    }
  }
  known_count_ = static_cast<double>(values.size());
  center_ = mean_of(values);
  for (const double value : values) squares_ += (value - center_) * (value - center_);
}

Contribution NormalLikelihood::sum_at(double mean, double precision) const {
  const double distance = center_ - mean;
  const double squares = squares_ + known_count_ * distance * distance;
  Contribution sum{
      .value = known_count_ * std::log(precision) - 0.5 * precision * precision * squares,
      .mean_slope = precision * precision * known_count_ * distance,
      .precision_slope = known_count_ / precision - precision * squares};
  for (const auto& [bounds, people] : censored_) {
    const Contribution one = contribution_of(bounds, mean, precision);
    sum.value += people * one.value;
    sum.mean_slope += people * one.mean_slope;
    sum.precision_slope += people * one.precision_slope;
  }
  return sum;
}

double NormalLikelihood::precision_at(double mean) const {
  const double distance = center_ - mean;
  const double start_precision = 1.0 / std::sqrt(squares_ / known_count_ + distance * distance);
  std::uintmax_t steps = kMaxRootSteps;
  const auto slope = [&](double precision) { return sum_at(mean, precision).precision_slope; };
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      slope, start_precision, 2.0, false, boost::math::tools::eps_tolerance<double>(), steps);
  return 0.5 * (low + high);
}

template <typename Function>
double NormalLikelihood::zero_along(const Function& function, double start, double step) const {
  double previous = start;
  while (function(start + step) > 0.0) {
    previous = start + step;
    step *= 2.0;
  }
  const auto [low, high] = std::minmax({previous, start + step});
  const double scale = std::sqrt(squares_ / known_count_);
  const auto is_close = [scale](double a, double b) {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    return std::abs(a - b) <= kRounding * (std::abs(a) + std::abs(b) + scale);
  };
  std::uintmax_t steps = kMaxRootSteps;
  const auto root = boost::math::tools::toms748_solve(function, low, high, is_close, steps);
  return 0.5 * (root.first + root.second);
}

double NormalLikelihood::most_likely_mean() const {
  const auto slope = [&](double mean) { return sum_at(mean, precision_at(mean)).mean_slope; };
  const double step = std::sqrt(squares_ / known_count_);
  if (slope(center_) >= 0.0) return zero_along(slope, center_, step);
  return zero_along([&](double mean) { return -slope(mean); }, center_, -step);
}

void require_bounds(std::span<const Bounds> people) {
  for (const Bounds& one : people) {
    // Also refuses NaN.
    if (!(one.low <= one.high) || (one.exact() && !std::isfinite(one.low))) {
      throw std::invalid_argument("the low end of bounds must not be above the high end");
    }
  }
}

std::vector<double> known_values(std::span<const Bounds> people) {
  std::vector<double> values;
  for (const Bounds& one : people) {
    if (one.exact()) values.push_back(one.low);
  }
  return values;
}

/// The median of one end over people; exact if infinite ends tie in the middle.
double median_of(std::span<const Bounds> people, double Bounds::*end) {
  std::vector<double> ends;
  for (const Bounds& one : people) ends.push_back(one.*end);
  std::ranges::sort(ends);
  const std::size_t half = ends.size() / 2;
  if (ends.size() % 2 == 1 || ends[half - 1] == ends[half]) return ends[half];
  return 0.5 * (ends[half - 1] + ends[half]);
}

MissingReason missing_reason_of(std::size_t people, std::span<const double> values) {
  if (2 * values.size() < people) return MissingReason::most;
  if (values.size() < 2) return MissingReason::values;
  const auto [least, most] = std::ranges::minmax(values);
  return without_noise(most - least) == 0.0 ? MissingReason::spread : MissingReason::nothing;
}

bool all_contain(std::span<const Bounds> people, double value) {
  return std::ranges::all_of(people, [value](const Bounds& one) {
    return without_noise(std::max(one.low - value, 0.0)) == 0.0 &&
           without_noise(std::max(value - one.high, 0.0)) == 0.0;
  });
}

/// The largest likelihood ratio of means in the interval, as twice its logarithm.
double max_log_ratio(double known_count, double level) {
  const boost::math::students_t_distribution<> distribution(known_count - 1.0);
  const double t = boost::math::quantile(distribution, 0.5 + level / 2.0);
  return known_count * std::log1p(t * t / (known_count - 1.0));
}

void add_likelihood_estimate(CensoredMean& result, std::span<const Bounds> people, double level) {
  const NormalLikelihood likelihood(people);
  const double mean = likelihood.most_likely_mean();
  result.mean = without_noise(mean);
  result.sd = likelihood.sd_at(mean);
  const double min_profile =
      likelihood.profile(mean) - 0.5 * max_log_ratio(likelihood.known_count(), level);
  const auto margin = [&](double value) { return likelihood.profile(value) - min_profile; };
  result.interval = {without_noise(likelihood.zero_along(margin, mean, -*result.sd)),
                     without_noise(likelihood.zero_along(margin, mean, *result.sd))};
}

}  // namespace

Bounds difference_of(const Bounds& first, const Bounds& second) noexcept {
  if (first.exact() && second.exact()) return {first.low - second.low, first.low - second.low};
  return {first.low - second.high, first.high - second.low};
}

CensoredMean censored_mean(std::span<const Bounds> people, double level) {
  require_level(level);
  require_bounds(people);
  CensoredMean result;
  result.open = static_cast<int>(std::ranges::count(people, Bounds{}));
  result.participants = static_cast<int>(people.size()) - result.open;
  if (people.empty()) return result;
  const std::vector<double> values = known_values(people);
  result.exact = static_cast<int>(values.size());
  result.median_within = {median_of(people, &Bounds::low), median_of(people, &Bounds::high)};
  if (result.median_within.exact()) result.median = result.median_within.low;
  result.lack = missing_reason_of(people.size(), values);
  const bool all_known = values.size() == people.size();
  if (result.lack == MissingReason::nothing && !all_known) {
    add_likelihood_estimate(result, people, level);
  } else if (all_known ||
             (result.lack == MissingReason::spread && all_contain(people, values.front()))) {
    constexpr Interval kAnywhere{-kInfinity, kInfinity};
    const MeanEstimate estimate = participant_mean(values, kAnywhere, level);
    result.mean = estimate.mean;
    result.sd = estimate.sd;
    if (result.lack == MissingReason::nothing) result.interval = estimate.interval;
  }
  return result;
}

std::optional<double> censored_p(std::span<const Bounds> people, double null, Sides sides) {
  require_bounds(people);
  require_finite(std::span(&null, 1), "a test of a mean");
  const std::vector<double> values = known_values(people);
  if (missing_reason_of(people.size(), values) != MissingReason::nothing) return std::nullopt;
  if (values.size() == people.size()) return t_test_p(values, null, sides);
  const NormalLikelihood likelihood(people);
  const double mean = likelihood.most_likely_mean();
  const double ratio = 2.0 * (likelihood.profile(mean) - likelihood.profile(null));
  const double degrees = likelihood.known_count() - 1.0;
  const double t = std::sqrt(degrees * std::expm1(std::max(ratio, 0.0) / likelihood.known_count()));
  const boost::math::students_t_distribution<> distribution(degrees);
  if (sides == Sides::one) return cdf(complement(distribution, mean < null ? -t : t));
  return 2.0 * cdf(complement(distribution, t));
}

std::optional<TStatistic> known_t_statistic(std::span<const Bounds> people) {
  const std::vector<double> values = known_values(people);
  return values.size() == people.size() ? t_statistic(values) : std::nullopt;
}

}  // namespace touchtrial::analysis
