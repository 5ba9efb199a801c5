/// \file A plot of the last seconds, with axes and units.
#pragma once

#include "app/monitor/monitor_history.hpp"
#include "app/monitor/palette.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

struct PlotLine {
  std::string name;  ///< in the legend
  PackedColour colour = kBlack;
  std::vector<Extent> values;  ///< evenly spaced, from the oldest to the newest
};

struct PlotScale {
  double least = 0.0;
  double greatest = 1.0;
  double step = 1.0;  ///< between ticks; logarithmic: a decade
  bool logarithmic = false;
};

/// A scale with ticks at 1, 2 or 5 times a power of ten that holds all values, and what `at_least`
/// holds. \param ticks  wanted, >= 1
[[nodiscard]] PlotScale scale_for(const std::vector<PlotLine>& lines, Extent at_least, int ticks);

/// Whole decades that hold all values and what `at_least` holds. \pre at_least.least > 0
[[nodiscard]] PlotScale decades_for(const std::vector<PlotLine>& lines, Extent at_least);

struct Plot {
  std::string title;  ///< with the unit: "Position, mm"
  std::vector<PlotLine> lines;
  PlotScale scale;
  double span_s = 5.0;       ///< that the values cover
  bool time_labels = false;  ///< below the plot
};

/// Draws at ImGui's cursor into its current window, which must be as wide as `width`.
/// \param density  as GlfwWindow::density
void draw_plot(const Plot& plot, float width, float height, float density);

}  // namespace touchtrial::app
