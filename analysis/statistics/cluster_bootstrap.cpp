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
    throw std::invalid_argument("a bootstrap needs fewer than 2^32 participants");
  }
}

/// Draws equally likely indices below a bound. Every 64 random bits give two, because a study of a
/// thousand participants needs ten million. Source: Lemire 2019, ACM Transactions on Modeling and
/// Computer Simulation 29(1).
class IndexDraws {
 public:
  IndexDraws(RandomStream& random, std::size_t bound)
      : random_(random),
        bound_(static_cast<std::uint32_t>(bound)),
        excess_((0U - bound_) % bound_) {}

  /// Calls `use_index` with each index.
  template <typename Take>
  void each(std::size_t count, const Take& use_index) {
    while (count > 0) {
      if (!has_second_) word_ = random_.bits();
      const std::uint64_t first = (word_ & 0xffffffffU) * bound_;
      const std::uint64_t second = (word_ >> 32U) * bound_;
      if (!has_second_ && is_unbiased(first)) {
        use_index(first >> 32U);
        --count;
      }
      has_second_ = count == 0;
      if (has_second_ || !is_unbiased(second)) continue;
      use_index(second >> 32U);
      --count;
    }
  }

 private:
  [[nodiscard]] bool is_unbiased(std::uint64_t product) const {
    return static_cast<std::uint32_t>(product) >= excess_;
  }

  RandomStream& random_;
  std::uint32_t bound_;
  std::uint32_t excess_;  // 2^32 mod bound
  std::uint64_t word_ = 0;
  bool has_second_ = false;  ///< the second half of the word is unused
};

/// The ((n + 1) share)-th smallest of n draws, interpolated if that is not a whole number. About
/// this share of the statistic's distribution lies below it.
/// \param draws  reordered on return
double percentile(std::vector<double>& draws, double share) {
  const auto n = static_cast<double>(draws.size());
  const double place = std::clamp((n + 1.0) * share, 1.0, n) - 1.0;
  const double rank = std::floor(place + 1e-9);  // so that 10,000 * 0.025 gives the 250th
  const auto position = draws.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(draws.begin(), position, draws.end());
  if (position + 1 == draws.end()) return *position;
  const double next = *std::min_element(position + 1, draws.end());
  return *position + std::max(0.0, place - rank) * (next - *position);
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
  IndexDraws indices(random, participants.size());
  std::vector<double> shares(static_cast<std::size_t>(draws));
  for (double& share : shares) {
    std::int64_t n = 0;
    std::int64_t correct = 0;
    indices.each(participants.size(), [&](std::size_t i) {
      n += participants[i].n;
      correct += participants[i].correct;
    });
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
  IndexDraws indices(random, values.size());
  std::vector<double> means(static_cast<std::size_t>(draws));
  for (double& mean : means) {
    double sum = 0.0;
    indices.each(values.size(), [&](std::size_t i) { sum += values[i]; });
    mean = sum / static_cast<double>(values.size());
  }
  return expanded_percentiles(std::move(means), values.size(), level);
}

std::optional<Interval> bootstrap_statistic(std::size_t participants,
                                            const ResampledStatistic& statistic,
                                            std::uint64_t index, int draws, double level) {
  require_arguments(participants, draws, level);
  if (participants < 2) return std::nullopt;
  RandomStream random(0, "bootstrap of a statistic", index);
  IndexDraws indices(random, participants);
  std::vector<std::size_t> people(participants);
  std::vector<double> values(static_cast<std::size_t>(draws));
  for (double& value : values) {
    auto next = people.begin();
    indices.each(participants, [&](std::size_t i) { *next++ = i; });
    value = statistic(people);
  }
  require_finite(values, "a bootstrap");
  return expanded_percentiles(std::move(values), participants, level);
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
  IndexDraws indices(random, participants.size());
  std::vector<double> logs(static_cast<std::size_t>(draws));
  for (double& one : logs) {
    Ratio sum;
    indices.each(participants.size(), [&](std::size_t i) {
      sum.above += participants[i].above;
      sum.below += participants[i].below;
    });
    if (sum.above == 0.0 && sum.below == 0.0) return std::nullopt;
    one = std::log(sum.above) - std::log(sum.below);
  }
  const Interval ends = expanded_percentiles(std::move(logs), participants.size(), level);
  if (!std::isfinite(ends.low) || !std::isfinite(ends.high)) return std::nullopt;
  return Interval{std::exp(ends.low), std::exp(ends.high)};
}

JackknifeEstimate jackknife(double full_sample, std::span<const double> leave_one_out,
                            const Interval& range, double level) {
  require_level(level);
  require_finite(leave_one_out, "a jackknife");
  require_finite(std::span(&full_sample, 1), "a jackknife");
  if (leave_one_out.size() < 2)
    throw std::invalid_argument("a jackknife needs at least two participants");
  const auto n = static_cast<double>(leave_one_out.size());
  const double mean = mean_of(leave_one_out);
  const double estimate = n * full_sample - (n - 1.0) * mean;
  const double error = std::sqrt(n - 1.0) * standard_deviation(leave_one_out, mean, n);
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 * (1.0 + level));
  const auto clamped = [&](double value) {
    return std::clamp(without_noise(value), range.low, range.high);
  };
  return {clamped(estimate), {clamped(estimate - t * error), clamped(estimate + t * error)}};
}

}  // namespace touchtrial::analysis
