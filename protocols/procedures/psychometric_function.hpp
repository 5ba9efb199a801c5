/// \file Psychometric functions: the probability that an observer is right at a level. Formulas and
/// sources: docs/thresholds.md, "Psychometric functions". Pure functions, thread-safe.
#pragma once

#include <cstdint>
#include <span>

namespace touchtrial::procedures {

/// F, which rises from 0 to 1 with the level. z = slope (level - threshold).
enum class Shape {
  logistic,  ///< 1 / (1 + exp(-z)); F(threshold) = 1/2
  weibull,   ///< 1 - exp(-10^(z / 20)), levels in dB (Watson 2017); F(threshold) = 1 - 1/e
  normal,    ///< Phi(z), so the slope is 1 / SD; F(threshold) = 1/2
};

/// An observer is right with probability guess + (1 - guess - lapse) F(level).
struct Observer {
  Shape shape = Shape::weibull;
  double threshold = 0.0;  ///< in units of the level; finite
  double slope = 1.0;      ///< > 0; weibull: beta per 20 dB, otherwise per unit of the level
  double guess = 0.5;      ///< in [0, 1): probability of a right answer when nothing is felt
  double lapse = 0.0;      ///< in [0, 1 - guess): probability of a wrong answer at any level
};

/// \throws std::invalid_argument if a parameter is outside its range
void require_possible(const Observer& observer);

/// A pair of values for right and wrong answers at one level. Both are computed without subtracting
/// from 1, so neither loses precision when it is small.
struct AnswerShares {
  double correct = 0.0;
  double wrong = 0.0;
};

/// The probabilities of both answers.
/// \param level  any number, also infinite
[[nodiscard]] AnswerShares shares_at(const Observer& observer, double level) noexcept;

/// The natural logarithms of shares_at, finite even where a probability underflows.
[[nodiscard]] AnswerShares log_shares_at(const Observer& observer, double level) noexcept;

/// The value of F at the threshold: 1/2, or 1 - 1/e for weibull.
[[nodiscard]] double share_at_threshold(Shape shape) noexcept;

/// The level at which the observer is right with this probability, which is the threshold at this
/// criterion.
/// \param proportion  between guess and 1 - lapse, exclusive
/// \throws std::invalid_argument if `proportion` is out of range or the observer is impossible
[[nodiscard]] double level_at(const Observer& observer, double proportion);

/// The distance between the levels with F = 0.05 and F = 0.95 for slope 1. The width of an
/// observer's function is this distance divided by the slope.
[[nodiscard]] double width_at_slope_one(Shape shape);

/// The answers of all trials at one level.
struct LevelCounts {
  double level = 0.0;
  std::int64_t correct = 0;  ///< 0 .. n
  std::int64_t n = 0;
};

/// The log-likelihood of independent answers, without binomial coefficients; 0 log 0 = 0.
/// \return at most 0; -infinity if the answers are impossible
[[nodiscard]] double log_likelihood(const Observer& observer, std::span<const LevelCounts> counts);

/// Twice the difference between the log-likelihood of the observed proportions and that of the
/// observer; at least 0.
[[nodiscard]] double deviance(const Observer& observer, std::span<const LevelCounts> counts);

/// The Weber fraction dA / A of a level of discrimination, which is 20 log10(dA / A).
[[nodiscard]] double weber_fraction(double level_db) noexcept;

}  // namespace touchtrial::procedures
