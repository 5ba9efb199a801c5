#include "app/monitor/plot.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

Extent extent_of(const std::vector<PlotLine>& lines, Extent at_least) {
  for (const PlotLine& line : lines) {
    for (const Extent& value : line.values) {
      if (value.is_empty()) continue;
      at_least.add(value.least);
      at_least.add(value.greatest);
    }
  }
  return at_least;
}

/// The smallest of 1, 2 and 5 times a power of ten that is no smaller than this.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= step * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

}  // namespace

PlotScale scale_for(const std::vector<PlotLine>& lines, Extent at_least, int ticks) {
  const Extent all = extent_of(lines, at_least);
  const double step = round_step(std::max(all.greatest - all.least, 1e-6) / ticks);
  return {step * std::floor(all.least / step + 1e-9), step * std::ceil(all.greatest / step - 1e-9),
          step, false};
}

PlotScale decades_for(const std::vector<PlotLine>& lines, Extent at_least) {
  const Extent all = extent_of(lines, at_least);
  const double least = std::max(all.least, at_least.least);
  return {std::pow(10.0, std::floor(std::log10(least) + 1e-9)),
          std::pow(10.0, std::ceil(std::log10(all.greatest) - 1e-9)), 10.0, true};
}

}  // namespace touchtrial::app
