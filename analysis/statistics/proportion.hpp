/// \file Proportions and their confidence intervals. Source: docs/statistics.md, "Proportions";
/// Brown, Cai, DasGupta 2001, Statistical Science 16(2).
#pragma once

#include <optional>

namespace touchtrial::analysis {

inline constexpr double kConfidenceLevel = 0.95;

/// A closed range of numbers, usually of probabilities.
struct Interval {
  double low = 0.0;
  double high = 1.0;

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// `correct` of `n` trials; 0 <= correct <= n.
struct Proportion {
  int n = 0;
  int correct = 0;

  /// correct / n, or nothing if n is 0.
  [[nodiscard]] std::optional<double> share() const noexcept;

  void add(bool is_correct) noexcept {
    ++n;
    correct += is_correct ? 1 : 0;
  }
  Proportion& operator+=(const Proportion& other) noexcept {
    n += other.n;
    correct += other.correct;
    return *this;
  }

  friend bool operator==(const Proportion&, const Proportion&) = default;
};

/// Wilson's score interval. For independent trials, its mean coverage is close to the level.
/// \param level  in (0, 1)
/// \return within [0, 1]; [0, 1] if n is 0
/// \throws std::invalid_argument if not 0 <= correct <= n, or the level is not in (0, 1)
[[nodiscard]] Interval wilson_interval(Proportion proportion, double level = kConfidenceLevel);

/// Clopper and Pearson's exact interval. For independent trials, its coverage is at least the
/// level. Arguments, result and errors: see wilson_interval.
[[nodiscard]] Interval clopper_pearson_interval(Proportion proportion,
                                                double level = kConfidenceLevel);

/// Jeffreys' interval: quantiles of Beta(correct + 1/2, n - correct + 1/2). The low end is 0 at 0
/// correct, the high end 1 at n correct. Arguments, result and errors: see wilson_interval.
[[nodiscard]] Interval jeffreys_interval(Proportion proportion, double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
