#include "analysis/report/page/wording.hpp"

#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Replaces a hyphen by a minus sign; removes it if the number rounds to 0.
std::string typeset(const std::string& number) {
  if (number.empty() || number[0] != '-') return number;
  const bool rounds_to_zero = number.find_first_of("123456789") == std::string::npos;
  return rounds_to_zero ? number.substr(1) : "−" + number.substr(1);
}

}  // namespace

std::string plain_figure(std::optional<double> figure, int decimals) {
  if (!figure || !std::isfinite(*figure)) return kNoFigure;
  return typeset(fmt::format("{:.{}f}", *figure, decimals));
}

std::string plain_range(const std::optional<Interval>& interval, int decimals) {
  if (!interval) return kNoFigure;
  return "[" + plain_figure(interval->low, decimals) + ", " +
         plain_figure(interval->high, decimals) + "]";
}

std::string signed_plain_figure(std::optional<double> figure, int decimals) {
  if (!figure || !std::isfinite(*figure)) return kNoFigure;
  const std::string text = fmt::format("{:+.{}f}", *figure, decimals);
  return text.find_first_of("123456789") == std::string::npos ? text.substr(1) : typeset(text);
}

std::string quartiles_figure(const Quartiles& quartiles, int decimals, double unit) {
  const auto figure = [&](std::optional<double> value) {
    return plain_figure(value ? std::optional(unit * *value) : value, decimals);
  };
  if (!quartiles.median) return kNoFigure;
  return fmt::format("{} ({}, {})", figure(quartiles.median), figure(quartiles.lower),
                     figure(quartiles.upper));
}

std::string share_figure(std::optional<double> share) {
  return share ? plain_figure(100.0 * *share, 1) + "%" : kNoFigure;
}

std::string share_range(const std::optional<Interval>& interval) {
  if (!interval) return kNoFigure;
  return plain_range(Interval{100.0 * interval->low, 100.0 * interval->high}, 1);
}

std::string points_figure(std::optional<double> difference) {
  if (!difference) return kNoFigure;
  return signed_plain_figure(100.0 * *difference, 1);
}

std::string p_figure(std::optional<double> p) {
  if (!p) return kNoFigure;
  return *p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", *p);
}

std::string p_phrase(double p) {
  return (p < 0.001 ? "p " : "p = ") + p_figure(p);
}

std::string t_phrase(const TStatistic& statistic) {
  return fmt::format("t({}) = {}", statistic.degrees_of_freedom, plain_figure(statistic.t, 2));
}

std::string effect_figure(const std::optional<TStatistic>& statistic) {
  if (!statistic) return kNoFigure;
  const std::string estimate = signed_plain_figure(statistic->d, 2);
  return statistic->interval ? estimate + " " + plain_range(statistic->interval, 2) : estimate;
}

std::string slug_of(const std::string& name) {
  std::string slug;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    const char lower = upper ? static_cast<char>(c - 'A' + 'a') : c;
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) {
      slug += lower;
    } else if (!slug.empty() && slug.back() != '-') {
      slug += '-';
    }
  }
  while (!slug.empty() && slug.back() == '-') slug.pop_back();
  return slug;
}

}  // namespace touchtrial::analysis
