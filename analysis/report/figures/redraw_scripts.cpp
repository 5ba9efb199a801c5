#include "analysis/report/figures/redraw_scripts.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {

std::string quoted(const std::string& text) {
  std::string string = "\"";
  for (const char c : one_line(text)) {
    if (c == '"' || c == '\\') string += '\\';
    string += c;
  }
  return string + '"';
}

std::string numbers_of(const std::vector<std::string>& names, const char* open, const char* close) {
  std::string list;
  for (std::size_t i = 1; i <= names.size(); ++i) {
    list += (i == 1 ? "" : ", ") + std::to_string(i);
  }
  return open + list + close;
}

std::string list_of(const std::vector<std::string>& names, const char* open, const char* close) {
  return open + listed(names, ", ", quoted) + close;
}

Grid grid_of(const Figure& figure, const Layout& layout) {
  Grid grid;
  grid.columns = std::min(figure.panels_per_row, figure.panels.size());
  grid.rows = (figure.panels.size() + grid.columns - 1) / grid.columns;
  for (std::size_t i = 0; i < grid.columns; ++i) {
    grid.widths += fmt::format("{}{:.3g}", i == 0 ? "" : ", ", figure.panels[i].share);
  }
  for (std::size_t i = 0; i < grid.rows; ++i) {
    const PlacedPanel& first = layout.panels[i * grid.columns];
    grid.heights += fmt::format("{}{:.3g}", i == 0 ? "" : ", ", first.bottom_cm - first.top_cm);
  }
  return grid;
}

std::string stamps_of(const Figure& figure) {
  const char* separator = figure.simulated && !figure.stamp.empty() ? " " : "";
  return (figure.simulated ? "SIMULATED" : "") + (separator + figure.stamp);
}

}  // namespace touchtrial::analysis
