#include "protocols/procedures/psychometric_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <boost/math/special_functions/erf.hpp>

namespace touchtrial::procedures {
namespace {

constexpr double kDecibel = std::numbers::ln10 / 20.0;

/// Phi(z), with all digits of small values.
double normal_share(double z) noexcept {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// log Phi(z). Far below 0, where Phi underflows, it uses the asymptotic series (Abramowitz, Stegun
/// 1964, 26.2.12), whose error is below 1e-9 there.
double log_normal_share(double z) noexcept {
  constexpr double kSeriesBelow = -30.0;
  if (z > kSeriesBelow) return std::log(normal_share(z));
  const double r = 1.0 / (z * z);
  return -0.5 * z * z - std::log(-z) - 0.5 * std::log(2.0 * std::numbers::pi) +
         std::log1p(-r * (1.0 - 3.0 * r * (1.0 - 5.0 * r)));
}

/// log(1 / (1 + exp(-z))).
double log_logistic_share(double z) noexcept {
  return z >= 0.0 ? -std::log1p(std::exp(-z)) : z - std::log1p(std::exp(z));
}

/// log(1 - exp(-exp(y))).
double log_weibull_share(double y) noexcept {
  constexpr double kLinearBelow = -40.0;
  return y < kLinearBelow ? y : std::log(-std::expm1(-std::exp(y)));
}

/// F and 1 - F.
AnswerShares f_shares(Shape shape, double z) noexcept {
  switch (shape) {
    case Shape::logistic:
      return {1.0 / (1.0 + std::exp(-z)), 1.0 / (1.0 + std::exp(z))};
    case Shape::weibull: {
      const double hazard = std::exp(kDecibel * z);
      return {-std::expm1(-hazard), std::exp(-hazard)};
    }
    case Shape::normal:
      break;
  }
  return {normal_share(z), normal_share(-z)};
}

AnswerShares log_f_shares(Shape shape, double z) noexcept {
  switch (shape) {
    case Shape::logistic:
      return {log_logistic_share(z), log_logistic_share(-z)};
    case Shape::weibull:
      return {log_weibull_share(kDecibel * z), -std::exp(kDecibel * z)};
    case Shape::normal:
      break;
  }
  return {log_normal_share(z), log_normal_share(-z)};
}

/// The z with F(z) = share.
double inverse_of(Shape shape, double share) {
  switch (shape) {
    case Shape::logistic:
      return std::log(share / (1.0 - share));
    case Shape::weibull:
      return std::log(-std::log1p(-share)) / kDecibel;
    case Shape::normal:
      break;
  }
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * share);
}

double times_log(std::int64_t count, double log_share) noexcept {
  return count == 0 ? 0.0 : static_cast<double>(count) * log_share;
}

/// The log-likelihood of the observed proportion at each level.
double saturated_log_likelihood(std::span<const LevelCounts> counts) {
  double sum = 0.0;
  for (const LevelCounts& point : counts) {
    const auto n = static_cast<double>(point.n);
    const std::int64_t wrong = point.n - point.correct;
    sum += times_log(point.correct, std::log(static_cast<double>(point.correct) / n)) +
           times_log(wrong, std::log(static_cast<double>(wrong) / n));
  }
  return sum;
}

}  // namespace

void require_possible(const Observer& observer) {
  if (!std::isfinite(observer.threshold)) {
    throw std::invalid_argument("an observer's threshold must be finite");
  }
  if (!(observer.slope > 0.0 && std::isfinite(observer.slope))) {
    throw std::invalid_argument("an observer's slope must be above 0");
  }
  if (!(observer.guess >= 0.0 && observer.lapse >= 0.0 && observer.guess + observer.lapse < 1.0)) {
    throw std::invalid_argument("guess and lapse must be at least 0 and their sum below 1");
  }
}

AnswerShares shares_at(const Observer& observer, double level) noexcept {
  const AnswerShares f = f_shares(observer.shape, observer.slope * (level - observer.threshold));
  const double scale = 1.0 - observer.guess - observer.lapse;
  return {observer.guess + scale * f.correct, observer.lapse + scale * f.wrong};
}

AnswerShares log_shares_at(const Observer& observer, double level) noexcept {
  const AnswerShares shares = shares_at(observer, level);
  AnswerShares logs{std::log(shares.correct), std::log(shares.wrong)};
  if (observer.guess > 0.0 && observer.lapse > 0.0) return logs;
  const AnswerShares f =
      log_f_shares(observer.shape, observer.slope * (level - observer.threshold));
  const double log_scale = std::log(1.0 - observer.guess - observer.lapse);
  if (observer.guess == 0.0) logs.correct = log_scale + f.correct;
  if (observer.lapse == 0.0) logs.wrong = log_scale + f.wrong;
  return logs;
}

double share_at_threshold(Shape shape) noexcept {
  return f_shares(shape, 0.0).correct;
}

double level_at(const Observer& observer, double proportion) {
  require_possible(observer);
  if (!(proportion > observer.guess && proportion < 1.0 - observer.lapse)) {
    throw std::invalid_argument("level_at: the proportion must be between guess and 1 - lapse");
  }
  const double share = (proportion - observer.guess) / (1.0 - observer.guess - observer.lapse);
  return observer.threshold + inverse_of(observer.shape, share) / observer.slope;
}

double width_at_slope_one(Shape shape) {
  return inverse_of(shape, 0.95) - inverse_of(shape, 0.05);
}

double log_likelihood(const Observer& observer, std::span<const LevelCounts> counts) {
  double sum = 0.0;
  for (const LevelCounts& point : counts) {
    const AnswerShares logs = log_shares_at(observer, point.level);
    sum += times_log(point.correct, logs.correct) + times_log(point.n - point.correct, logs.wrong);
  }
  return sum;
}

double deviance(const Observer& observer, std::span<const LevelCounts> counts) {
  const double distance = saturated_log_likelihood(counts) - log_likelihood(observer, counts);
  return std::max(0.0, 2.0 * distance);
}

double weber_fraction(double level_db) noexcept {
  return std::exp(kDecibel * level_db);
}

}  // namespace touchtrial::procedures
