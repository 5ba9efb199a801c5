#include "analysis/planning/power_curve.hpp"

#include "analysis/planning/optimiser.hpp"
#include "analysis/report/figures/style.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

constexpr double kTargetPower = 0.8;
constexpr double kMaxIntercept = 20.0;
constexpr double kMaxSlope = 20.0;
/// Keeps logarithms finite.
constexpr double kMinShare = 1e-12;
constexpr int kStepsOfCurve = 120;

const boost::math::normal kNormal;

/// The log likelihood of the points, with its derivatives.
double likelihood(std::span<const PowerPoint> points, std::span<const double> coefficients,
                  std::span<double> slopes) {
  std::ranges::fill(slopes, 0.0);
  double sum = 0.0;
  for (const PowerPoint& point : points) {
    const double root_n = std::sqrt(static_cast<double>(point.participants));
    const double z = coefficients[0] + coefficients[1] * root_n;
    const double share = std::clamp(cdf(kNormal, z), kMinShare, 1.0 - kMinShare);
    const double hits = point.successes.correct;
    const double misses = point.successes.n - hits;
    sum += hits * std::log(share) + misses * std::log1p(-share);
    if (slopes.empty()) continue;
    const double slope = pdf(kNormal, z) * (hits / share - misses / (1.0 - share));
    slopes[0] += slope;
    slopes[1] += slope * root_n;
  }
  return sum;
}

analysis::Layer points_layer(const PowerSeries& series, std::size_t index) {
  analysis::Layer layer{.kind = analysis::LayerKind::interval,
                        .name = series.name.empty() ? "simulated studies" : series.name,
                        .colour = analysis::series_colour(index),
                        .size = 0.8,
                        .glyph = analysis::series_glyph(index),
                        .in_key = !series.name.empty()};
  for (const PowerPoint& point : series.points) {
    if (point.successes.n == 0) continue;
    layer.rows.push_back(analysis::bar(point.participants, *point.successes.share(),
                                       analysis::wilson_interval(point.successes), 100.0));
  }
  return layer;
}

analysis::Layer curve_layer(const PowerSeries& series, const PowerFit& fit, std::size_t index) {
  analysis::Layer layer{.kind = analysis::LayerKind::line,
                        .name = series.name.empty() ? "fit" : "fit, " + series.name,
                        .colour = analysis::series_colour(index)};
  const double first = series.points.front().participants;
  const double last = series.points.back().participants;
  for (int step = 0; step <= kStepsOfCurve; ++step) {
    const double size = first + (last - first) * step / kStepsOfCurve;
    layer.rows.push_back({.x = size, .y = 100.0 * fit.power(size)});
  }
  return layer;
}

/// A line from the axis to the curve at the chosen size, with the size as text.
void add_chosen_size(analysis::Panel& panel, int size, std::size_t index) {
  const std::string colour = analysis::series_colour(index);
  panel.layers.push_back({.kind = analysis::LayerKind::line,
                          .name = "size with 80 % power",
                          .rows = {{.x = static_cast<double>(size), .y = 0.0},
                                   {.x = static_cast<double>(size), .y = 100.0 * kTargetPower}},
                          .colour = colour,
                          .dashed = true});
  // Stacks the labels of several series.
  panel.layers.push_back(analysis::direct_label(size, 4.0 + 7.0 * static_cast<double>(index),
                                                fmt::format("{} ", size), colour,
                                                analysis::Anchor::end));
}

std::string size_sentence(const PowerSeries& series, const std::optional<int>& size) {
  const std::string name = series.name.empty() ? "" : series.name + ": ";
  return size ? fmt::format(" {}80 % with {} participants.", name, *size)
              : fmt::format(" {}no size within this range has 80 %.", name);
}

}  // namespace

double PowerFit::power(double participants) const {
  return cdf(kNormal, intercept + slope * std::sqrt(participants));
}

std::optional<PowerFit> fit_power(std::span<const PowerPoint> points) {
  int studies = 0;
  int reached = 0;
  for (const PowerPoint& point : points) {
    studies += point.successes.n;
    reached += point.successes.correct;
  }
  if (points.size() < 2 || reached == 0 || reached == studies) return {};
  const auto function = [points](std::span<const double> coefficients, std::span<double> slopes) {
    return likelihood(points, coefficients, slopes);
  };
  const Optimum best =
      maximise(function, {-1.6, 0.5}, {{-kMaxIntercept, 0.0}, {kMaxIntercept, kMaxSlope}},
               {.tolerance = 1e-10, .scales = {1.0, 0.3}});
  return PowerFit{best.point[0], best.point[1]};
}

std::optional<int> size_with_power(const PowerFit& fit, std::span<const PowerPoint> points,
                                   double target) {
  if (points.empty() || fit.power(points.front().participants) > target) return {};
  for (int size = points.front().participants; size <= points.back().participants; ++size) {
    if (fit.power(size) >= target) return size;
  }
  return {};
}

analysis::Figure power_figure(const PowerCurve& curve) {
  analysis::Figure figure = analysis::empty_figure("power-curve", "", true);
  analysis::Panel panel;
  int max_size = 0;
  for (const PowerSeries& series : curve.series) {
    max_size = std::max(max_size, series.points.back().participants);
  }
  panel.x = {.label = "participants", .low = 0.0, .high = 1.05 * max_size};
  panel.y = analysis::percent_axis("power, %");
  panel.layers.push_back(analysis::dashed_rule(100.0 * kTargetPower, "80 %"));
  std::string sizes;
  for (std::size_t i = 0; i < curve.series.size(); ++i) {
    const PowerSeries& series = curve.series[i];
    const std::optional<PowerFit> fit = fit_power(series.points);
    std::optional<int> size;
    if (fit) {
      size = size_with_power(*fit, series.points, kTargetPower);
      panel.layers.push_back(curve_layer(series, *fit, i));
      if (size) add_chosen_size(panel, *size, i);
    }
    panel.layers.push_back(points_layer(series, i));
    sizes += size_sentence(series, size);
  }
  figure.caption = analysis::stamped(
      true, fmt::format("share of studies of {} with a {}, by number of participants, with "
                        "Wilson's 95 % intervals of the simulation. Lines: the fitted "
                        "\u03a6(a + b\u221an).{}",
                        curve.study, curve.goal, sizes));
  figure.alt = "Power over the number of participants." + sizes;
  figure.panels = {std::move(panel)};
  return figure;
}

}  // namespace touchtrial::planning
