#include "analysis/report/figures/gnuplot_script.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/gnuplot_layers.hpp"
#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr double kPixelsPerCm = 96.0 / 2.54;  ///< as in style sheets
constexpr double kText_pt = 8.0;
constexpr double kText_px = kText_pt * 96.0 / 72.0;
constexpr const char* kStampColour = "#b3261e";

constexpr const char* kStyle = R"(set encoding utf8
set tics nomirror out scale 0.4
unset key
unset grid
set multiplot
)";

/// Converts cm from the top left corner to gnuplot coordinates.
class Sheet {
 public:
  Sheet(double width_cm, double height_cm) : width_cm_(width_cm), height_cm_(height_cm) {}
  [[nodiscard]] std::string position(double x_cm, double y_cm) const {
    return fmt::format("screen {:.4f}, screen {:.4f}", x(x_cm), y(y_cm));
  }
  [[nodiscard]] double x(double cm) const { return cm / width_cm_; }
  [[nodiscard]] double y(double cm) const { return 1.0 - cm / height_cm_; }

 private:
  double width_cm_;
  double height_cm_;
};

std::string limit(const std::optional<double>& end) {
  return end ? number_text(*end) : "*";
}

/// "1, 2, 5, 10": the ticks within the range.
std::string log_ticks(double low, double high) {
  std::string ticks;
  for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high;
       decade *= 10.0) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double tick = step * decade;
      if (tick >= low && tick <= high) ticks += (ticks.empty() ? "" : ", ") + number_text(tick);
    }
  }
  return ticks;
}

/// \param name  "x" or "y"
std::string axis_script(const char* name, const Axis& axis) {
  std::string script = fmt::format("unset logscale {0}\nset {0}label {1} noenhanced{2}\n", name,
                                   gnuplot_string(axis.names.empty() ? axis.label : ""),
                                   *name == 'x' ? " offset 0, 0.5" : " offset 0.9, 0");
  std::string low = limit(axis.low);
  std::string high = limit(axis.high);
  if (!axis.names.empty()) {
    low = "0.5";
    high = fmt::format("{}.5", axis.names.size());
  }
  if (axis.logarithmic) script += fmt::format("set logscale {}\n", name);
  script += axis.reversed ? fmt::format("set {}range [{}:{}]\n", name, high, low)
                          : fmt::format("set {}range [{}:{}]\n", name, low, high);
  if (axis.hidden) return script + fmt::format("unset {}tics\n", name);
  if (!axis.names.empty()) {
    return script + fmt::format("set {}tics 1, 1, {} format ''\n", name, axis.names.size());
  }
  if (axis.logarithmic && axis.low && axis.high) {
    return script +
           fmt::format("set {}tics ({}) format '%g'\n", name, log_ticks(*axis.low, *axis.high));
  }
  if (axis.step > 0.0) {
    return script + fmt::format("set {}tics {}, {} format '%g'\n", name, axis.first, axis.step);
  }
  return script + fmt::format("set {}tics autofreq format '%g'\n", name);
}

/// The names along axes, and the labels of named axes.
std::string names_script(const Sheet& sheet, const Panel& panel, const PlacedPanel& placed) {
  std::string script;
  const NamesBelow& below = placed.x_names;
  for (std::size_t i = 0; i < below.names.size(); ++i) {
    script +=
        text_at(below.names[i], fmt::format("first {}, graph 0 {}", i + 1,
                                            below.slanted ? "right rotate by 45 offset 0.4, -0.5"
                                                          : "center offset 0, -0.9"));
  }
  for (std::size_t i = 0; i < panel.y.names.size(); ++i) {
    script += text_at(fitted(panel.y.names[i], kNameColumns),
                      fmt::format("graph 0, first {} right offset -0.9, 0", i + 1));
  }
  if (!panel.x.names.empty()) {
    script +=
        text_at(panel.x.label, sheet.position(0.5 * (placed.left_cm + placed.right_cm),
                                              placed.bottom_cm + placed.x_names.room_cm + 0.4) +
                                   " center");
  }
  if (!panel.y.names.empty()) {
    script += text_at(panel.y.label, sheet.position(placed.left_cm - placed.tick_labels_cm - 0.2,
                                                    0.5 * (placed.top_cm + placed.bottom_cm)) +
                                         " center rotate by 90");
  }
  return script;
}

std::string scale_script(const Sheet& sheet, const Panel& panel, const PlacedPanel& placed) {
  if (panel.colour_scale.empty()) return "";
  std::string stops;
  const std::vector<std::string>& colours = colour_stops();
  for (std::size_t i = 0; i < colours.size(); ++i) {
    stops += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, colours[i]);
  }
  const double width = sheet.x(0.28);
  return fmt::format(
      "set palette defined ({})\nset cbrange [0:{:.3g}]\nset cblabel {} noenhanced offset -0.6, "
      "0\nset format cb '%g'\nset colorbox user origin screen {:.4f}, screen {:.4f} size screen "
      "{:.4f}, screen {:.4f} noborder\n",
      stops, panel.scale_max > 0.0 ? panel.scale_max : 1.0, gnuplot_string(panel.colour_scale),
      sheet.x(placed.right_cm + 0.2), sheet.y(placed.bottom_cm), width,
      sheet.y(placed.top_cm) - sheet.y(placed.bottom_cm));
}

std::string panel_script(const Sheet& sheet, const Panel& panel, const PlacedPanel& placed,
                         std::size_t index) {
  const int border = (panel.x.hidden ? 0 : 1) + (panel.y.hidden ? 0 : 2);
  std::string script = fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset tmargin at screen "
      "{:.4f}\nset bmargin at screen {:.4f}\nset border {} lw 0.8 lc rgb '{}'\n",
      sheet.x(placed.left_cm), sheet.x(placed.right_cm), sheet.y(placed.top_cm),
      sheet.y(placed.bottom_cm), border, kInk);
  script += axis_script("x", panel.x) + axis_script("y", panel.y) +
            names_script(sheet, panel, placed) + scale_script(sheet, panel, placed);
  if (!panel.title.empty()) {
    const auto columns =
        static_cast<std::size_t>((placed.right_cm - placed.left_cm + 0.4) / kLetter_cm);
    script += text_at(fitted(panel.title, std::max<std::size_t>(columns, 8)),
                      "graph 0, graph 1 left offset 0, 0.7");
  }
  std::string plot;
  for (std::size_t i = 0; i < panel.layers.size(); ++i) {
    const Drawing drawing = drawing_of(fmt::format("d{}_{}", index + 1, i + 1), panel.layers[i]);
    script += drawing.data + drawing.commands;
    if (!drawing.plot.empty()) plot += (plot.empty() ? "plot " : ", ") + drawing.plot;
  }
  if (plot.empty()) {
    const auto default_range = [](const char* name, const Axis& axis) {
      const bool has_range = (axis.low && axis.high) || !axis.names.empty();
      return has_range ? std::string() : fmt::format("set {}range [0:1]\n", name);
    };
    plot = default_range("x", panel.x) + default_range("y", panel.y) + "plot NaN notitle";
  }
  return script + plot + "\nunset label\nunset arrow\nunset object\n";
}

std::string sample(const Sheet& sheet, const KeyEntry& entry) {
  const Layer& layer = *entry.layer;
  const std::string colour = colour_of(layer);
  const double end_cm = entry.left_cm + kSample_cm - 0.12;
  switch (layer.kind) {
    case LayerKind::line:
    case LayerKind::rule:
    case LayerKind::arrow:
      return fmt::format("set arrow from {} to {} nohead {} lw {:.3g} lc rgb '{}'\n",
                         sheet.position(entry.left_cm, entry.top_cm),
                         sheet.position(end_cm, entry.top_cm), layer.dashed ? kDashes : "",
                         std::max(1.1 * layer.size, 1.0), colour);
    case LayerKind::band:
      return pale_field(sheet.position(entry.left_cm, entry.top_cm + 0.12),
                        sheet.position(end_cm, entry.top_cm - 0.12), colour);
    default:
      return text_at("", fmt::format("{} left point pt {} ps {:.3g} lw 1.3 lc rgb '{}'",
                                     sheet.position(0.5 * (entry.left_cm + end_cm), entry.top_cm),
                                     point_type(layer.glyph),
                                     std::clamp(0.5 * layer.size, 0.35, 0.6), colour));
  }
}

std::string frame_script(const Figure& figure, const Layout& layout, const Sheet& sheet) {
  std::string script;
  if (figure.simulated) {
    script += text_at("SIMULATED", sheet.position(figure.width_cm - 0.15, 0.3) +
                                       fmt::format(" right textcolor rgb '{}'", kStampColour));
  }
  if (!figure.stamp.empty()) {
    script += text_at(figure.stamp,
                      sheet.position(figure.width_cm - 0.17, 0.6) +
                          fmt::format(" left rotate by -90 textcolor rgb '{}'", kStampColour));
  }
  for (const KeyEntry& entry : layout.key) {
    script +=
        sample(sheet, entry) +
        text_at(entry.text, sheet.position(entry.left_cm + kSample_cm, entry.top_cm) + " left");
  }
  return script;
}

}  // namespace

const std::vector<std::string>& colour_stops() {
  static const std::vector<std::string> stops{"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                                              "#28ae80", "#5ec962", "#addc30", "#fde725"};
  return stops;
}

std::string gnuplot_terminal(const Figure& figure, const Layout& layout, FigureFormat format) {
  if (format == FigureFormat::pdf) {  // both scales were measured to match the SVG
    return fmt::format(
        "set terminal pdfcairo size {}cm, {:.4g}cm font 'Arial,{}' fontscale 0.75 linewidth 1.5\n",
        figure.width_cm, layout.height_cm, kText_pt);
  }
  return fmt::format(
      "set terminal svg standalone size {:.0f}, {:.0f} font 'Arial,Helvetica,sans-serif,{:.2f}' "
      "background '#ffffff'\n",
      figure.width_cm * kPixelsPerCm, layout.height_cm * kPixelsPerCm, kText_px);
}

std::string gnuplot_script(const Figure& figure, const Layout& layout) {
  const Sheet sheet(figure.width_cm, layout.height_cm);
  std::string script = kStyle + frame_script(figure, layout, sheet);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    script += panel_script(sheet, figure.panels[i], layout.panels[i], i);
  }
  return script + "unset multiplot\n";
}

}  // namespace touchtrial::analysis
