#include "analysis/report/figures/redraw.hpp"

#include "analysis/exports/data_table.hpp"
#include "analysis/report/figures/gnuplot_script.hpp"
#include "analysis/report/figures/redraw_scripts.hpp"
#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

DataCell cell(double number) {
  return std::isfinite(number) ? DataCell(number) : DataCell();
}

std::string data_of(const Figure& figure) {
  DataTable table{{"panel", "layer", "kind", "name", "x", "y", "low", "high", "value", "text"}, {}};
  static const std::vector<std::string> kKinds{"points",   "line",   "path",  "band",
                                               "interval", "across", "box",   "rule",
                                               "tile",     "label",  "arrow", "picture"};
  std::int64_t number = 0;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    for (const Layer& layer : figure.panels[i].layers) {
      ++number;
      for (const Datum& row : layer.rows) {
        table.rows.push_back({static_cast<std::int64_t>(i + 1), number,
                              kKinds[static_cast<std::size_t>(layer.kind)], layer.name, cell(row.x),
                              cell(row.y), cell(row.low), cell(row.high), cell(row.value),
                              row.text});
      }
    }
  }
  return csv_text(table);
}

}  // namespace

std::map<std::string, std::string> redraw_files(const Figure& figure) {
  const Layout layout = layout_of(figure);
  std::map<std::string, std::string> files;
  files[figure.id + ".csv"] = data_of(figure);
  files[figure.id + ".gp"] =
      gnuplot_terminal(figure, layout, FigureFormat::svg) + gnuplot_script(figure, layout);
  if (figure.panels.empty()) return files;
  files[figure.id + ".py"] = matplotlib_script(figure, layout);
  files[figure.id + ".r"] = ggplot_script(figure, layout);
  int number = 0;
  for (const Panel& panel : figure.panels) {
    for (const Layer& layer : panel.layers) {
      ++number;
      if (layer.grey.empty()) continue;
      const Bytes png = engine::png_bytes(layer.grey);
      files[fmt::format("{}-{}.png", figure.id, number)] = std::string(png.begin(), png.end());
    }
  }
  return files;
}

}  // namespace touchtrial::analysis
