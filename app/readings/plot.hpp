/// \file Plots of the last seconds, with axes and units.
#pragma once

#include "app/readings/history.hpp"
#include "app/windows/look.hpp"

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
  double step = 1.0;  ///< between ticks; the factor between ticks if logarithmic
  bool logarithmic = false;
};

/// A scale that covers all values and `at_least`, with steps of 1, 2 or 5 times a power of ten.
/// \param ticks  the approximate number of steps, >= 1
[[nodiscard]] PlotScale scale_for(const std::vector<PlotLine>& lines, Extent at_least, int ticks);

/// Whole decades that cover all values and `at_least`.
/// \pre at_least.least > 0
[[nodiscard]] PlotScale decades_for(const std::vector<PlotLine>& lines, Extent at_least);

struct Plot {
  std::string title;  ///< with the unit: "Position, mm"
  std::vector<PlotLine> lines;
  PlotScale scale;
  double span_s = 5.0;       ///< duration that the values cover
  bool time_labels = false;  ///< below the plot
};

/// Draws at the cursor of ImGui's current window, which must be as wide as `width`.
/// \param density  as GlfwWindow::density
void draw_plot(const Plot& plot, float width, float height, float density);

}  // namespace touchtrial::app
