#include "analysis/report/figures/gnuplot_layers.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

const char* word_of(Anchor anchor) noexcept {
  if (anchor == Anchor::start) return "left";
  return anchor == Anchor::middle ? "center" : "right";
}

using Columns = std::vector<double Datum::*>;

bool has_numbers(const Datum& row, const Columns& columns) {
  return std::ranges::all_of(columns,
                             [&](double Datum::*column) { return std::isfinite(row.*column); });
}

/// "$name << EOD .." with the rows that have all columns. Lines and paths break where the text
/// changes or a number is missing.
/// \return empty without a row
std::string data_block(const std::string& name, const Layer& layer, const Columns& columns) {
  const bool is_line = layer.kind == LayerKind::line || layer.kind == LayerKind::path;
  std::string block;
  const Datum* previous = nullptr;
  bool has_rows = false;
  for (const Datum& row : layer.rows) {
    const bool drawn = has_numbers(row, columns);
    if (is_line && previous != nullptr && (previous->text != row.text || !drawn)) block += '\n';
    previous = drawn ? &row : nullptr;
    if (!drawn) continue;
    has_rows = true;
    for (double Datum::*column : columns) block += number_text(row.*column) + ' ';
    block.back() = '\n';
  }
  return has_rows ? fmt::format("${} << EOD\n{}EOD\n", name, block) : "";
}

/// \param using_terms  columns and style
Drawing plot_layer(const std::string& name, const Layer& layer, const Columns& columns,
                   const std::string& using_terms) {
  Drawing drawing{data_block(name, layer, columns), "", ""};
  if (!drawing.data.empty()) drawing.plot = fmt::format("${} using {} notitle", name, using_terms);
  return drawing;
}

Drawing points(const std::string& name, const Layer& layer) {
  const bool has_sizes =
      std::ranges::any_of(layer.rows, [](const Datum& row) { return std::isfinite(row.value); });
  const double size = 0.36 * layer.size;
  const std::string look = fmt::format("lw 1.1 lc rgb '{}'", colour_of(layer));
  const int type = point_type(layer.glyph);
  if (!has_sizes) {
    return plot_layer(name, layer, {&Datum::x, &Datum::y},
                      fmt::format("1:2 with points pt {} ps {:.3g} {}", type, size, look));
  }
  return plot_layer(
      name, layer, {&Datum::x, &Datum::y, &Datum::value},
      fmt::format("1:2:({:.3g} * sqrt($3)) with points pt {} ps variable {}", size, type, look));
}

/// A bar and a mark. gnuplot's error bars would leave a gap around the mark.
/// \param bar  columns of the bar's start and length
Drawing interval(const std::string& name, const Layer& layer, const char* bar) {
  const std::string colour = colour_of(layer);
  return plot_layer(
      name, layer, {&Datum::x, &Datum::y, &Datum::low, &Datum::high},
      fmt::format("{} with vectors nohead lw {:.3g} lc rgb '{}' notitle, ${} using 1:2 "
                  "with points pt {} ps {:.3g} lc rgb '{}'",
                  bar, 1.4 * layer.size, colour, name, point_type(layer.glyph), 0.55 * layer.size,
                  colour));
}

Drawing box(const std::string& name, const Layer& layer) {
  return plot_layer(
      name, layer, {&Datum::x, &Datum::y, &Datum::low, &Datum::high, &Datum::value},
      fmt::format("1:2:($1 - 0.5 * $5):($1 + 0.5 * $5):3:4 with boxxyerror fs empty border lc rgb "
                  "'{0}' lw 1.1 lc rgb '{0}' notitle, ${1} using ($1 - 0.5 * $5):2:5:(0) with "
                  "vectors nohead lw 2.4 lc rgb '{0}'",
                  colour_of(layer), name));
}

/// Rules with bands and names. Names of horizontal rules are above their right end or beyond it.
Drawing rules(const Layer& layer) {
  const std::string colour = colour_of(layer);
  const std::string pen = fmt::format("nohead {} lw {:.3g} lc rgb '{}' back\n",
                                      layer.dashed ? kDashes : "", 1.1 * layer.size, colour);
  Drawing drawing;
  for (const Datum& row : layer.rows) {
    const bool horizontal = std::isfinite(row.y);
    if (std::isfinite(row.low) && std::isfinite(row.high)) {
      drawing.commands += horizontal
                              ? pale_field("graph 0, first " + number_text(row.low),
                                           "graph 1, first " + number_text(row.high), colour)
                              : pale_field("first " + number_text(row.low) + ", graph 0",
                                           "first " + number_text(row.high) + ", graph 1", colour);
    }
    const std::string position = number_text(horizontal ? row.y : row.x);
    if (!horizontal && !std::isfinite(row.x)) continue;
    drawing.commands +=
        horizontal ? fmt::format("set arrow from graph 0, first {0} to graph 1, first {0} {1}",
                                 position, pen)
                   : fmt::format("set arrow from first {0}, graph 0 to first {0}, graph 1 {1}",
                                 position, pen);
    if (row.text.empty()) continue;
    const std::string label_position =
        !horizontal ? fmt::format("first {}, graph 1 left offset 0.4, -0.5", position)
        : layer.anchor == Anchor::start
            ? fmt::format("graph 1, first {} left offset 0.5, 0", position)
            : fmt::format("graph 1, first {} right offset -0.3, 0.45", position);
    drawing.commands +=
        text_at(row.text, fmt::format("{} front textcolor rgb '{}'", label_position, colour));
  }
  return drawing;
}

Drawing tiles(const std::string& name, const Layer& layer) {
  Drawing drawing;
  for (const Datum& row : layer.rows) {
    if (!has_numbers(row, {&Datum::x, &Datum::y, &Datum::value})) continue;
    const Rgb shade = shade_of(std::clamp(row.value, 0.0, 1.0));
    drawing.data += fmt::format("{:.6g} {:.6g} {}\n", row.x, row.y,
                                shade.red * 65536 + shade.green * 256 + shade.blue);
    drawing.commands +=
        text_at(row.text, fmt::format("first {:.6g}, {:.6g} center front textcolor rgb '{}'", row.x,
                                      row.y, hex_code(ink_on(shade))));
  }
  if (drawing.data.empty()) return drawing;
  drawing.data = fmt::format("${} << EOD\n{}EOD\n", name, drawing.data);
  drawing.plot = fmt::format(
      "${} using 1:2:(0.49):(0.49):3 with boxxyerror fs solid 1 border lc rgb '#c8c8c8' lw 0.5 fc "
      "rgb variable notitle",
      name);
  return drawing;
}

Drawing labels(const Layer& layer) {
  Drawing drawing;
  for (const Datum& row : layer.rows) {
    if (!has_numbers(row, {&Datum::x, &Datum::y})) continue;
    const char* offset = layer.anchor == Anchor::start ? "offset 0.6, 0"
                         : layer.anchor == Anchor::end ? "offset -0.6, 0"
                                                       : "";
    drawing.commands += text_at(
        row.text, fmt::format("first {}, {} {} front {} textcolor rgb '{}'", number_text(row.x),
                              number_text(row.y), word_of(layer.anchor), offset, colour_of(layer)));
  }
  return drawing;
}

/// Draws `grey` as a matrix between the two corners.
Drawing pictures(const std::string& name, const Layer& layer) {
  const GreyImage& grey = layer.grey;
  if (layer.rows.empty() || grey.empty()) return {};
  const Datum& corners = layer.rows.front();
  Drawing drawing{fmt::format("${} << EOD\n", name), "", ""};
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) drawing.data += fmt::format("{} ", grey.at(y, x));
    drawing.data.back() = '\n';
  }
  drawing.data += "EOD\n";
  const auto coordinate = [](const char* column, double from, double to, int count) {
    return fmt::format("({:.6g} + ({} + 0.5) * {:.8g})", from, column, (to - from) / count);
  };
  drawing.plot = fmt::format("${} matrix using {}:{}:3:3:3 with rgbimage notitle", name,
                             coordinate("$1", corners.x, corners.low, grey.width()),
                             coordinate("$2", corners.y, corners.high, grey.height()));
  return drawing;
}

}  // namespace

Drawing drawing_of(const std::string& name, const Layer& layer) {
  const std::string colour = colour_of(layer);
  const Columns xy{&Datum::x, &Datum::y};
  switch (layer.kind) {
    case LayerKind::points:
      return points(name, layer);
    case LayerKind::line:
      return plot_layer(name, layer, xy,
                        fmt::format("1:2 with lines {} lw {:.3g} lc rgb '{}'",
                                    layer.dashed ? kDashes : "", 1.1 * layer.size, colour));
    case LayerKind::path:
      // A dark edge separates the path from a picture below it, in grey as well.
      return plot_layer(name, layer, {&Datum::x, &Datum::y, &Datum::value},
                        fmt::format("1:2 with lines lw {:.3g} lc rgb '{}' notitle, ${} using 1:2:3 "
                                    "with lines lw {:.3g} lc palette",
                                    2.2 * layer.size, kInk, name, 1.6 * layer.size));
    case LayerKind::band:
      return plot_layer(
          name, layer, {&Datum::x, &Datum::low, &Datum::high},
          fmt::format("1:2:3 with filledcurves fs transparent solid 0.2 noborder lc rgb "
                      "'{}'",
                      colour));
    case LayerKind::interval:
      return interval(name, layer, "1:3:(0):($4 - $3)");
    case LayerKind::horizontal_interval:
      return interval(name, layer, "3:2:($4 - $3):(0)");
    case LayerKind::box:
      return box(name, layer);
    case LayerKind::rule:
      return rules(layer);
    case LayerKind::tile:
      return tiles(name, layer);
    case LayerKind::label:
      return labels(layer);
    case LayerKind::arrow:
      return plot_layer(name, layer, {&Datum::x, &Datum::y, &Datum::low, &Datum::high},
                        fmt::format("1:2:($3 - $1):($4 - $2) with vectors head filled size screen "
                                    "0.012, 24 fixed lw {:.3g} lc rgb '{}'",
                                    layer.size, colour));
    case LayerKind::picture:
      return pictures(name, layer);
  }
  return {};
}

int point_type(Glyph glyph) noexcept {
  static constexpr std::array kTypes{7, 5, 9, 13, 11, 6, 2};  // in the order of Glyph
  return kTypes[static_cast<std::size_t>(glyph)];
}

std::string number_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "NaN";
}

std::string text_at(const std::string& text, const std::string& placement) {
  return fmt::format("set label {} at {} noenhanced\n", gnuplot_string(text), placement);
}

std::string pale_field(const std::string& from, const std::string& to, const std::string& colour) {
  return fmt::format(
      "set object rectangle from {} to {} fs solid 0.16 noborder fc rgb '{}' behind\n", from, to,
      colour);
}

}  // namespace touchtrial::analysis
