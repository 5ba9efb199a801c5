#include "analysis/statistics/spread.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/roots.hpp>

namespace touchtrial::analysis {
namespace {

/// The weighted sum of squares of participants' shares, for an assumed variance of their
/// probabilities.
class CochransQ {
 public:
  explicit CochransQ(std::span<const Proportion> participants) {
    for (const Proportion& one : participants) {
      require_possible(one);
      if (one.n < 1) throw std::invalid_argument("a spread needs participants with n >= 1");
      if (one.n < 2) continue;
      trials_.push_back(one.n);
      shares_.push_back(*one.share());
    }
    if (shares_.empty()) return;
    const double mean = mean_of(shares_);
    max_variance_ = mean * (1.0 - mean);
  }

  [[nodiscard]] std::size_t participants() const { return shares_.size(); }
  /// The variance if all probabilities were 0 or 1.
  [[nodiscard]] double max_variance() const { return max_variance_; }

  /// Squared distances from the weighted mean, divided by variances; decreases with `variance`.
  [[nodiscard]] double sum_of_squares(double variance) const {
    double weights = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      const double weight =
          1.0 / (max_variance_ / trials_[i] + variance * (1.0 - 1.0 / trials_[i]));
      weights += weight;
      sum += weight * shares_[i];
      squares += weight * shares_[i] * shares_[i];
    }
    return squares - sum * sum / weights;
  }

  /// The variance at which the sum of squares is `target`, clamped to [0, max_variance()].
  [[nodiscard]] double variance_at(double target) const {
    if (sum_of_squares(0.0) <= target) return 0.0;
    if (sum_of_squares(max_variance_) >= target) return max_variance_;
    std::uintmax_t steps = 200;
    const auto [a, b] = boost::math::tools::toms748_solve(
        [&](double variance) { return sum_of_squares(variance) - target; }, 0.0, max_variance_,
        boost::math::tools::eps_tolerance<double>(50), steps);
    return 0.5 * (a + b);
  }

 private:
  std::vector<double> trials_;
  std::vector<double> shares_;
  double max_variance_ = 0.0;
};

}  // namespace

std::optional<Spread> spread_of(std::span<const Proportion> participants, double level) {
  require_level(level);
  const CochransQ q(participants);
  if (q.participants() < 2 || q.max_variance() <= 0.0) return std::nullopt;
  const auto freedom = static_cast<double>(q.participants() - 1);
  const boost::math::chi_squared_distribution<> chi_squared(freedom);
  const auto spread = [&](double target) { return std::sqrt(q.variance_at(target)); };
  const double tail = 0.5 * (1.0 - level);
  return Spread{
      spread(freedom),
      {spread(quantile(complement(chi_squared, tail))), spread(quantile(chi_squared, tail))}};
}

}  // namespace touchtrial::analysis
