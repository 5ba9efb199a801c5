#include "analysis/report/figures/redraw_scripts.hpp"
#include "analysis/report/figures/style.hpp"

#include <array>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::array kShapes{16, 15, 17, 18, 25, 1, 4};  // in the order of Glyph

/// The terms of one layer, each after a plus.
std::string r_layer(const Layer& layer, int number) {
  const std::string data = fmt::format("layer({})", number);
  const std::string look = "colour = " + quoted(colour_of(layer));
  const std::string fill = "fill = " + quoted(colour_of(layer));
  const auto term = [&](const char* geom, const char* aes, const std::string& more) {
    return fmt::format(" +\n  {}(aes({}), {}, {})", geom, aes, data, more);
  };
  const std::string points =
      term("geom_point", "x, y",
           fmt::format("shape = {}, size = {:.3g}, {}",
                       kShapes[static_cast<std::size_t>(layer.glyph)], layer.size, look));
  const std::string style = layer.dashed ? ", linetype = 2" : "";
  switch (layer.kind) {
    case LayerKind::points:
      return points;
    case LayerKind::line:
      return term("geom_path", "x, y, group = text",
                  fmt::format("linewidth = {:.3g}, {}{}", 0.35 * layer.size, look, style));
    case LayerKind::path:
      return term("geom_point", "x, y, colour = value", "size = 0.3") +
             " +\n  scale_colour_viridis_c()";
    case LayerKind::band:
      return term("geom_ribbon", "x, ymin = low, ymax = high", fill + ", alpha = 0.2");
    case LayerKind::interval:
      return term("geom_linerange", "x, ymin = low, ymax = high", look) + points;
    case LayerKind::horizontal_interval:
      return term("geom_linerange", "y = y, xmin = low, xmax = high", look) + points;
    case LayerKind::box:
      return term("geom_crossbar", "x, y, ymin = low, ymax = high",
                  fmt::format("width = {:.3g}, fill = NA, linewidth = 0.3, {}",
                              layer.rows.front().value, look));
    case LayerKind::rule:
      return fmt::format(" +\n  rule({}, {}{})", data, look, style);
    case LayerKind::tile:
      return term("geom_tile", "x, y, fill = value", "colour = \"white\", show.legend = FALSE") +
             " +\n  scale_fill_gradient(low = \"white\", high = \"#003e6e\", limits = c(0, 1))" +
             term("geom_text", "x, y, label = text, colour = value > 0.5",
                  "size = 2.5, show.legend = FALSE") +
             " +\n  scale_colour_manual(values = c(\"black\", \"white\"))";
    case LayerKind::label:
      return term("geom_text", "x, y, label = text",
                  fmt::format("size = 2.8, hjust = {}, {}",
                              layer.anchor == Anchor::start ? "0"
                              : layer.anchor == Anchor::end ? "1"
                                                            : "0.5",
                              look));
    case LayerKind::arrow:
      return term("geom_segment", "x, y, xend = low, yend = high",
                  "arrow = grid::arrow(length = grid::unit(0.1, \"cm\")), " + look);
    case LayerKind::picture:
      return fmt::format(" +\n  picture({}, \"{}\")", data, number);
  }
  return "";
}

std::string r_axis(char name, const Axis& axis) {
  std::string scale = fmt::format("scale_{}_continuous({}", name, quoted(axis.label));
  if (!axis.names.empty()) {
    scale += fmt::format(", breaks = {}, labels = {}", numbers_of(axis.names, "c(", ")"),
                         list_of(axis.names, "c(", ")"));
  }
  if (axis.logarithmic) {
    scale += ", trans = \"log10\"";
  } else if (axis.reversed) {
    scale += ", trans = \"reverse\"";
  }
  std::string script = " +\n  " + scale + ")";
  if (axis.hidden) {
    script += fmt::format(
        " +\n  theme(axis.text.{0} = element_blank(), axis.ticks.{0} = element_blank(), "
        "axis.line.{0} = element_blank())",
        name);
  }
  return script;
}

/// Limits that do not drop data.
std::string r_limits(const Panel& panel) {
  const auto limits = [](const Axis& axis) -> std::string {
    const bool is_named = !axis.names.empty();
    if (!is_named && (!axis.low || !axis.high)) return "NULL";
    const std::string ends = is_named ? fmt::format("c(0.5, {}.5)", axis.names.size())
                                      : fmt::format("c({:.6g}, {:.6g})", *axis.low, *axis.high);
    return axis.reversed ? "rev(" + ends + ")" : ends;
  };
  return fmt::format(" +\n  coord_cartesian(xlim = {}, ylim = {})", limits(panel.x),
                     limits(panel.y));
}

}  // namespace

std::string ggplot_script(const Figure& figure, const Layout& layout) {
  const Grid grid = grid_of(figure, layout);
  std::string script =
      fmt::format(
          "# Draws {0}.csv (in the same folder) with ggplot2:\n#     Rscript {0}.r FILE.pdf\n",
          figure.id) +
      std::string(ggplot_head());
  int number = 0;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    script += fmt::format("\npanels[[{}]] <- ggplot()", i + 1);
    for (const Layer& layer : panel.layers) {
      ++number;
      if (!layer.rows.empty()) script += r_layer(layer, number);
    }
    script += " +\n  theme_classic(base_size = 8)" + r_axis('x', panel.x) + r_axis('y', panel.y) +
              r_limits(panel) + fmt::format(" +\n  ggtitle({})\n", quoted(panel.title));
  }
  return script +
         fmt::format(
             "\nfiles <- commandArgs(TRUE)\npdf(if (length(files)) files[1] else paste0(stem, "
             "\"-ggplot2.pdf\"), {:.2f}, {:.2f})\ngrid::pushViewport(grid::viewport(layout = "
             "grid::grid.layout({}, {}, widths = c({}), heights = c({}))))\nfor (i in "
             "seq_along(panels)) {{\n  print(panels[[i]], vp = grid::viewport(layout.pos.row = (i "
             "- 1) %/% {} + 1, layout.pos.col = (i - 1) %% {} + 1))\n}}\n",
             figure.width_cm * kInchesPerCm, layout.height_cm * kInchesPerCm, grid.rows,
             grid.columns, grid.widths, grid.heights, grid.columns, grid.columns) +
         (figure.simulated || !figure.stamp.empty()
              ? fmt::format("grid::popViewport()\ngrid::grid.text({}, 0.99, 0.99, c(\"right\", "
                            "\"top\"), gp = grid::gpar(col = \"#b3261e\", fontsize = 8))\n",
                            quoted(stamps_of(figure)))
              : "") +
         "invisible(dev.off())\n";
}

}  // namespace touchtrial::analysis
