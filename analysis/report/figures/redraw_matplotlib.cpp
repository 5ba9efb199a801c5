#include "analysis/report/figures/redraw_scripts.hpp"
#include "analysis/report/figures/style.hpp"

#include <array>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::array kMarkers{"o", "s", "^", "D", "v", "o", "x"};  // in the order of Glyph

/// The statements of one layer.
/// \param number  of the layer in the CSV
std::string python_layer(const Layer& layer, int number) {
  const std::string colour = quoted(colour_of(layer));
  const auto columns = [number](const std::string& names) {
    std::string list;
    for (std::size_t at = 0; at != std::string::npos;) {
      const std::size_t end = names.find(' ', at);
      list += fmt::format("{}column({}, \"{}\")", list.empty() ? "" : ", ", number,
                          names.substr(at, end - at));
      at = end == std::string::npos ? end : end + 1;
    }
    return list;
  };
  const std::string label = layer.in_key ? ", label=" + quoted(layer.name) : "";
  const std::string scatter = fmt::format(
      "ax.scatter({}, s={:.3g}, marker=\"{}\", {}={}, linewidths=0.7{})\n", columns("x y"),
      9.0 * layer.size * layer.size, kMarkers[static_cast<std::size_t>(layer.glyph)],
      layer.glyph == Glyph::ring ? "facecolors=\"none\", edgecolors" : "color", colour, label);
  const std::string style = layer.dashed ? ", linestyle=\"--\"" : "";
  switch (layer.kind) {
    case LayerKind::points:
      return scatter;
    case LayerKind::line:
      return fmt::format("lines(ax, {}, color={}, linewidth={:.3g}{}{})\n", number, colour,
                         0.9 * layer.size, style, label);
    case LayerKind::path:
      return fmt::format(
          "points = ax.scatter({}, c=column({}, \"value\"), s=3, cmap=\"viridis\")\n",
          columns("x y"), number);
    case LayerKind::band:
      return fmt::format("ax.fill_between({}, color={}, alpha=0.2, linewidth=0{})\n",
                         columns("x low high"), colour, label);
    case LayerKind::interval:
      return fmt::format("ax.vlines({}, color={}, linewidth=1.2)\n", columns("x low high"),
                         colour) +
             scatter;
    case LayerKind::horizontal_interval:
      return fmt::format("ax.hlines({}, color={}, linewidth=1.2)\n", columns("y low high"),
                         colour) +
             scatter;
    case LayerKind::box:
      return fmt::format(
          "for x, y, low, high, width in zip({}):\n"
          "    ax.add_patch(plt.Rectangle((x - width / 2, low), width, high - low, fill=False, "
          "edgecolor={}))\n    ax.hlines(y, x - width / 2, x + width / 2, color={}, linewidth=2)\n",
          columns("x y low high value"), colour, colour);
    case LayerKind::rule:
      return fmt::format("rules(ax, {}, {}{}, linewidth={:.3g}{}{})\n", number, colour,
                         layer.anchor == Anchor::start ? ", beyond=True" : "", 0.9 * layer.size,
                         style, label);
    case LayerKind::tile:
      return fmt::format(
          "for x, y, share, row in zip({}, rows({})):\n    ax.add_patch(plt.Rectangle((x - 0.5, y "
          "- 0.5), 1, 1, facecolor=plt.cm.Blues(share), edgecolor=\"white\"))\n    ax.text(x, y, "
          "row[\"text\"], ha=\"center\", va=\"center\", color=\"white\" if share > 0.5 else "
          "\"black\")\n",
          columns("x y value"), number);
    case LayerKind::label: {
      const char* where = layer.anchor == Anchor::start ? "left"
                          : layer.anchor == Anchor::end ? "right"
                                                        : "center";
      return fmt::format("texts(ax, {}, ha=\"{}\", va=\"center\", color={})\n", number, where,
                         colour);
    }
    case LayerKind::arrow:
      return fmt::format(
          "for x, y, to_x, to_y in zip({}):\n    ax.annotate(\"\", (to_x, to_y), (x, y), "
          "arrowprops={{\"arrowstyle\": \"->\", \"color\": {}}})\n",
          columns("x y low high"), colour);
    case LayerKind::picture:
      return fmt::format(
          "for left, top, right, bottom in zip({}):\n    "
          "ax.imshow(plt.imread(f\"{{stem}}-{}.png\"), cmap=\"gray\", vmin=0, vmax=1, "
          "extent=(left, right, bottom, top), aspect=\"auto\")\n",
          columns("x y low high"), number);
  }
  return "";
}

std::string python_limit(const std::optional<double>& end) {
  return end ? fmt::format("{:.6g}", *end) : "None";
}

std::string python_axis(char name, const Axis& axis) {
  std::string script = fmt::format("ax.set_{}label({})\n", name, quoted(axis.label));
  if (axis.logarithmic) {
    script += fmt::format("ax.set_{0}scale(\"log\")\nax.{0}axis.set_major_formatter(\"{{x:g}}\")\n",
                          name);
  }
  if (!axis.names.empty()) {
    script +=
        fmt::format("ax.set_{}lim(0.5, {}.5)\nax.set_{}ticks({}, {}{})\n", name, axis.names.size(),
                    name, numbers_of(axis.names, "[", "]"), list_of(axis.names, "[", "]"),
                    name == 'x' ? ", rotation=45, ha=\"right\"" : "");
  } else {
    script += fmt::format("ax.set_{}lim({}, {})\n", name, python_limit(axis.low),
                          python_limit(axis.high));
  }
  if (axis.reversed) script += fmt::format("ax.invert_{}axis()\n", name);
  if (axis.hidden) script += fmt::format("ax.{}axis.set_visible(False)\n", name);
  return script;
}

}  // namespace

std::string matplotlib_script(const Figure& figure, const Layout& layout) {
  const Grid grid = grid_of(figure, layout);
  const std::size_t columns = grid.columns;
  std::string script =
      fmt::format(
          "# Draws {0}.csv (in the same folder) with matplotlib 3.6 or later:\n#     python3 "
          "{0}.py FILE.pdf\n",
          figure.id) +
      std::string(matplotlib_head()) +
      fmt::format(
          "figure, axes = plt.subplots({}, {}, figsize=({:.2f}, {:.2f}), squeeze=False, "
          "layout=\"constrained\",\n                            gridspec_kw={{\"width_ratios\": "
          "[{}], \"height_ratios\": [{}]}})\n",
          grid.rows, columns, figure.width_cm * kInchesPerCm, layout.height_cm * kInchesPerCm,
          grid.widths, grid.heights);
  int number = 0;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    script += fmt::format("\nax = axes[{}][{}]\nax.set_title({}, loc=\"left\", fontsize=8)\n",
                          i / columns, i % columns, quoted(panel.title));
    for (const Layer& layer : panel.layers) script += python_layer(layer, ++number);
    script += python_axis('x', panel.x) + python_axis('y', panel.y);
    if (!panel.colour_scale.empty()) {
      script +=
          fmt::format("figure.colorbar(points, ax=ax, label={})\n", quoted(panel.colour_scale));
    }
  }
  for (std::size_t i = figure.panels.size(); i < grid.rows * columns; ++i) {
    script += fmt::format("axes[{}][{}].set_axis_off()\n", i / columns, i % columns);
  }
  const std::string stamp = stamps_of(figure);
  if (!stamp.empty()) {
    script +=
        fmt::format("figure.suptitle({}, x=0.99, ha=\"right\", fontsize=8, color=\"#b3261e\")\n",
                    quoted(stamp));
  }
  if (!layout.key.empty()) {
    script +=
        "named = {}\nfor ax in axes.flat:\n    for handle, label in "
        "zip(*ax.get_legend_handles_labels()):\n"
        "        named.setdefault(label, handle)\n"
        "axes.flat[0].legend(named.values(), named.keys(), loc=\"lower left\", ncols=2,\n"
        "                    bbox_to_anchor=(0, 1.04), frameon=False)\n";
  }
  return script +
         "figure.savefig(sys.argv[1] if len(sys.argv) > 1 else f\"{stem}-matplotlib.pdf\")\n";
}

}  // namespace touchtrial::analysis
