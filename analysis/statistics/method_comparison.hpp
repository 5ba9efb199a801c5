/// \file Two methods felt by the same participants. Source: docs/statistics.md, "Two methods".
#pragma once

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/participant_mean.hpp"
#include "analysis/statistics/proportion.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace touchtrial::analysis {

/// One participant's proportion correct with each method.
struct PairedAccuracy {
  double first = 0.0;
  double second = 0.0;
};

/// How much better the first method is than the second.
struct MethodComparison {
  int participants = 0;
  std::optional<double> difference;     ///< mean over participants of first minus second
  Interval interval{-1.0, 1.0};         ///< t interval of that mean, within [-1, 1]
  std::optional<double> p;              ///< sign_flip_p
  std::optional<double> db;             ///< decibels of the two means
  std::optional<Interval> bootstrap{};  ///< bootstrap_mean of the differences

  /// What may be shown: `interval`, or nothing with fewer than two participants.
  [[nodiscard]] std::optional<Interval> known_interval() const noexcept {
    return participants < 2 ? std::nullopt : std::optional(interval);
  }
};

/// 10 log10(a / b).
/// \return nothing unless both are > 0
[[nodiscard]] std::optional<double> decibels(double a, double b);

/// \param index,draws  of the bootstrap
/// \throws std::invalid_argument if a proportion is not finite, or draws < 1
[[nodiscard]] MethodComparison compare_methods(std::span<const PairedAccuracy> participants,
                                               std::uint64_t index = 0,
                                               int draws = kBootstrapDraws);

}  // namespace touchtrial::analysis
