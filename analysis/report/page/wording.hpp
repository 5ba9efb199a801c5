/// \file Numbers as text in tables and sentences: with typographic minus signs, a decimal point in
/// every locale, and "–" for a number that is missing or not finite.
#pragma once

#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

inline constexpr const char* kNoFigure = "–";
/// The usual significance level; only for wording.
inline constexpr double kUsualLevel = 0.05;

/// A share as a percentage: "77.0%" for 0.77.
[[nodiscard]] std::string share_figure(std::optional<double> share);
/// An interval of shares in per cent, or of their differences in percentage points: "[73.1, 80.9]"
/// for 0.731 to 0.809.
[[nodiscard]] std::string share_range(const std::optional<Interval>& interval);
/// A difference in percentage points: "+7.5" for 0.075.
[[nodiscard]] std::string points_figure(std::optional<double> difference);
/// Fixed decimals, and a sign only if the number is negative.
[[nodiscard]] std::string plain_figure(std::optional<double> figure, int decimals);
[[nodiscard]] std::string plain_range(const std::optional<Interval>& interval, int decimals);
/// Always a sign, except if the number rounds to zero.
[[nodiscard]] std::string signed_plain_figure(std::optional<double> figure, int decimals);
/// The median and quartiles: "12.1 (11.6, 12.9)".
/// \param unit  a factor
[[nodiscard]] std::string quartiles_figure(const Quartiles& quartiles, int decimals,
                                           double unit = 1.0);
/// A p value: "0.023", "< 0.001".
[[nodiscard]] std::string p_figure(std::optional<double> p);
/// A p value in a sentence: "p = 0.023", "p < 0.001".
[[nodiscard]] std::string p_phrase(double p);
/// "t(19) = 2.41"
[[nodiscard]] std::string t_phrase(const TStatistic& statistic);
/// "+0.54 [0.06, 1.00]": the effect in units of participants' standard deviation.
[[nodiscard]] std::string effect_figure(const std::optional<TStatistic>& statistic);
/// A name reduced to lower-case letters, digits and single hyphens, for ids and file names. May be
/// empty.
[[nodiscard]] std::string slug_of(const std::string& name);

}  // namespace touchtrial::analysis
