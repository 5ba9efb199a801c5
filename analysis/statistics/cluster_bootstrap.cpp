#include "analysis/statistics/cluster_bootstrap.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {
namespace {

void require_arguments(std::size_t participants, int draws, double level) {
  if (draws < 1) throw std::invalid_argument("a bootstrap needs at least one draw");
  require_level(level);
  if (participants > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("a bootstrap takes fewer than 2^32 participants");
  }
}

/// Draws indices below a bound, all equally likely, two from every 64 random bits: a study of a
/// thousand participants needs ten million. Source: Lemire 2019, ACM Transactions on Modeling and
/// Computer Simulation 29(1).
class IndexDraws {
 public:
  IndexDraws(RandomStream& random, std::size_t bound)
      : random_(random),
        bound_(static_cast<std::uint32_t>(bound)),
        excess_((0U - bound_) % bound_) {}

  [[nodiscard]] std::size_t next() {
    while (true) {
      const std::uint64_t product = std::uint64_t{half()} * bound_;
      if (static_cast<std::uint32_t>(product) >= excess_) return product >> 32U;
    }
  }

 private:
  std::uint32_t half() {
    second_ = !second_;
    if (!second_) return static_cast<std::uint32_t>(word_ >> 32U);
    word_ = random_.bits();
    return static_cast<std::uint32_t>(word_);
  }

  RandomStream& random_;
  std::uint32_t bound_;
  std::uint32_t excess_;  // 2^32 mod bound
  std::uint64_t word_ = 0;
  bool second_ = false;
};

/// The ((n + 1) share)-th of the n draws by size, interpolated where that is not a whole number:
/// about this share of the statistic's distribution lies below it.
/// \param draws  on return in another order
double percentile(std::vector<double>& draws, double share) {
  const auto n = static_cast<double>(draws.size());
  const double place = std::clamp((n + 1.0) * share, 1.0, n) - 1.0;
  const double below =
      std::floor(place + 1e-9);  // 10,000 * 0.025 is the 250th in spite of rounding
  const auto at = draws.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(draws.begin(), at, draws.end());
  if (at + 1 == draws.end()) return *at;
  const double next = *std::min_element(at + 1, draws.end());
  return *at + std::max(0.0, place - below) * (next - *at);
}

/// The share of a statistic's distribution that the interval omits at each end.
double expanded_tail(std::size_t participants, double level) {
  const auto n = static_cast<double>(participants);
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 * (1.0 + level));
  return boost::math::cdf(boost::math::normal(), -t * std::sqrt(n / (n - 1.0)));
}

}  // namespace

Interval expanded_percentiles(std::vector<double> draws, std::size_t participants, double level) {
  require_arguments(participants, static_cast<int>(draws.size()), level);
  if (participants < 2) throw std::invalid_argument("a bootstrap needs at least two participants");
  const double tail = expanded_tail(participants, level);
  return {without_noise(percentile(draws, tail)), without_noise(percentile(draws, 1.0 - tail))};
}

std::optional<Interval> cluster_bootstrap(std::span<const Proportion> participants,
                                          std::uint64_t index, int draws, double level) {
  require_arguments(participants.size(), draws, level);
  for (const Proportion& one : participants) {
    if (one.n < 1) throw std::invalid_argument("a bootstrap needs participants with n >= 1");
    require_possible(one);
  }
  if (participants.size() < 2) return std::nullopt;
  RandomStream random(0, "cluster bootstrap", index);
  IndexDraws drawn(random, participants.size());
  std::vector<double> shares(static_cast<std::size_t>(draws));
  for (double& share : shares) {
    std::int64_t n = 0;
    std::int64_t correct = 0;
    for (std::size_t i = 0; i < participants.size(); ++i) {
      const Proportion& one = participants[drawn.next()];
      n += one.n;
      correct += one.correct;
    }
    share = static_cast<double>(correct) / static_cast<double>(n);
  }
  return expanded_percentiles(std::move(shares), participants.size(), level);
}

std::optional<Interval> bootstrap_mean(std::span<const double> values, std::uint64_t index,
                                       int draws, double level) {
  require_arguments(values.size(), draws, level);
  require_finite(values, "a bootstrap");
  if (values.size() < 2) return std::nullopt;
  RandomStream random(0, "bootstrap of a mean", index);
  IndexDraws drawn(random, values.size());
  std::vector<double> means(static_cast<std::size_t>(draws));
  for (double& mean : means) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[drawn.next()];
    mean = sum / static_cast<double>(values.size());
  }
  return expanded_percentiles(std::move(means), values.size(), level);
}

std::optional<Interval> bootstrap_ratio(std::span<const Ratio> participants, std::uint64_t index,
                                        int draws, double level) {
  require_arguments(participants.size(), draws, level);
  for (const Ratio& one : participants) {
    if (!(one.above >= 0.0 && one.below >= 0.0 && std::isfinite(one.above + one.below))) {
      throw std::invalid_argument("a bootstrap of a ratio needs finite parts >= 0");
    }
  }
  if (participants.size() < 2) return std::nullopt;
  RandomStream random(0, "bootstrap of a ratio", index);
  IndexDraws drawn(random, participants.size());
  std::vector<double> logs(static_cast<std::size_t>(draws));
  for (double& one : logs) {
    Ratio sum;
    for (std::size_t i = 0; i < participants.size(); ++i) {
      const Ratio& own = participants[drawn.next()];
      sum.above += own.above;
      sum.below += own.below;
    }
    if (sum.above == 0.0 && sum.below == 0.0) return std::nullopt;
    one = std::log(sum.above) - std::log(sum.below);
  }
  const Interval ends = expanded_percentiles(std::move(logs), participants.size(), level);
  if (!std::isfinite(ends.low) || !std::isfinite(ends.high)) return std::nullopt;
  return Interval{std::exp(ends.low), std::exp(ends.high)};
}

JackknifeEstimate jackknife(double all, std::span<const double> without, const Interval& range,
                            double level) {
  require_level(level);
  require_finite(without, "a jackknife");
  require_finite(std::span(&all, 1), "a jackknife");
  if (without.size() < 2) throw std::invalid_argument("a jackknife needs two participants or more");
  const auto n = static_cast<double>(without.size());
  const double mean = mean_of(without);
  const double estimate = n * all - (n - 1.0) * mean;
  const double error = std::sqrt(n - 1.0) * standard_deviation(without, mean, n);
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 * (1.0 + level));
  const auto inside = [&](double value) {
    return std::clamp(without_noise(value), range.low, range.high);
  };
  return {inside(estimate), {inside(estimate - t * error), inside(estimate + t * error)}};
}

}  // namespace touchtrial::analysis
