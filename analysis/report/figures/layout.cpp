#include "analysis/report/figures/layout.hpp"

#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::analysis {
namespace {

constexpr double kEdge_cm = 0.15;
constexpr double kNumbers_cm = 0.85;  ///< beside a y axis
constexpr double kLabel_cm = 0.45;
constexpr double kTick_cm = 0.15;
constexpr double kTitle_cm = 0.65;
constexpr double kScale_cm = 1.75;  ///< a colour scale with its numbers and label
constexpr double kStampWidth_cm = 1.9;
constexpr double kKeyRow_cm = 0.42;
constexpr double kSlant = 0.707;  ///< sine of 45 degrees
constexpr std::size_t kKeyColumns = 48;

double width_cm(const std::string& text) {
  return kLetter_cm * static_cast<double>(display_width(text));
}

double widest_cm(const std::vector<std::string>& names) {
  double widest = 0.0;
  for (const std::string& name : names) widest = std::max(widest, width_cm(name));
  return std::min(widest, kLetter_cm * kNameColumns);
}

double tick_labels_cm(const Axis& y) {
  if (y.hidden) return 0.0;
  return y.names.empty() ? kNumbers_cm : widest_cm(y.names) + 2 * kTick_cm;
}

double left_room_cm(const Axis& y) {
  const double label_cm = y.label.empty() ? 0.0 : kLabel_cm;
  return kEdge_cm + label_cm + tick_labels_cm(y);
}

double right_room_cm(const Panel& panel, const Figure& figure) {
  return 2 * kEdge_cm + panel.room_right_cm + (figure.stamp.empty() ? 0.0 : 0.3) +
         (panel.colour_scale.empty() ? 0.0 : kScale_cm);
}

NamesBelow names_below(const Axis& x, double axis_cm) {
  NamesBelow below{x.names, false, 0.0};
  if (x.names.empty()) return below;
  const double slot_cm = axis_cm / static_cast<double>(x.names.size());
  below.slanted = widest_cm(x.names) + 0.08 > slot_cm;
  const auto columns = static_cast<std::size_t>(slot_cm / kLetter_cm);
  for (std::string& name : below.names) {
    name = fitted(name, below.slanted ? kNameColumns : std::max<std::size_t>(columns, 1));
  }
  below.room_cm = below.slanted ? kSlant * (widest_cm(x.names) + 2 * kLetter_cm) : 0.45;
  return below;
}

double bottom_room_cm(const Axis& x, const NamesBelow& below) {
  const double label_cm = x.label.empty() ? 0.0 : kLabel_cm;
  if (!below.names.empty()) return kTick_cm + below.room_cm + label_cm;
  return x.hidden ? kTick_cm + label_cm : kTick_cm + 0.4 + label_cm;
}

/// The largest length that panels of each row, or of each column, need.
class Maxima {
 public:
  explicit Maxima(std::size_t count) : cm_(count, 0.0) {}
  void add(std::size_t index, double cm) { cm_[index] = std::max(cm_[index], cm); }
  [[nodiscard]] double operator[](std::size_t index) const { return cm_[index]; }

 private:
  std::vector<double> cm_;
};

void place_key(const Figure& figure, Layout& layout) {
  const double left_cm = kEdge_cm + 0.3;
  double x_cm = left_cm;
  double y_cm = 0.3;
  const double end_cm = figure.width_cm - (figure.simulated ? kStampWidth_cm : kEdge_cm);
  std::set<std::string> names_in_key;
  for (const Panel& panel : figure.panels) {
    for (const Layer& layer : panel.layers) {
      if (!layer.in_key || layer.rows.empty() || !names_in_key.insert(layer.name).second) continue;
      const std::string text = fitted(layer.name, kKeyColumns);
      const double entry_cm = kSample_cm + 0.35 + width_cm(text);
      if (x_cm + entry_cm > end_cm && x_cm > left_cm) {
        x_cm = left_cm;
        y_cm += kKeyRow_cm;
      }
      layout.key.push_back({&layer, text, x_cm, y_cm});
      x_cm += entry_cm;
    }
  }
  const bool empty = layout.key.empty() && !figure.simulated;
  layout.height_cm = empty ? kEdge_cm : y_cm + 0.3;
}

/// The widths of a row's panels between the ends of their axes.
std::vector<double> axes_cm(const Figure& figure, const Maxima& left, const Maxima& right) {
  const std::size_t columns = std::min(figure.panels_per_row, figure.panels.size());
  double free_cm = figure.width_cm;
  double shares = 0.0;
  for (std::size_t i = 0; i < columns; ++i) {
    free_cm -= left[i] + right[i];
    shares += figure.panels[i].share;
  }
  std::vector<double> widths;
  for (std::size_t i = 0; i < columns; ++i) {
    widths.push_back(std::max(free_cm, 1.0) * figure.panels[i].share / shares);
  }
  return widths;
}

}  // namespace

Layout layout_of(const Figure& figure) {
  Layout layout;
  place_key(figure, layout);
  if (figure.panels.empty()) return layout;
  const std::size_t columns = std::min(figure.panels_per_row, figure.panels.size());
  const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
  Maxima left(columns);
  Maxima right(columns);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    left.add(i % columns, left_room_cm(figure.panels[i].y));
    right.add(i % columns, right_room_cm(figure.panels[i], figure));
  }
  const std::vector<double> widths = axes_cm(figure, left, right);
  Maxima top(rows);
  Maxima bottom(rows);
  Maxima height(rows);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    PlacedPanel placed;
    placed.tick_labels_cm = tick_labels_cm(panel.y);
    placed.x_names = names_below(panel.x, widths[i % columns]);
    top.add(i / columns, panel.title.empty() ? kEdge_cm : kTitle_cm);
    bottom.add(i / columns, bottom_room_cm(panel.x, placed.x_names));
    height.add(i / columns,
               panel.aspect > 0.0 ? widths[i % columns] * panel.aspect : panel.height_cm);
    layout.panels.push_back(std::move(placed));
  }
  double row_cm = layout.height_cm;
  for (std::size_t row = 0; row < rows; ++row) {
    double column_cm = 0.0;
    for (std::size_t i = row * columns; i < std::min((row + 1) * columns, figure.panels.size());
         ++i) {
      PlacedPanel& placed = layout.panels[i];
      placed.left_cm = column_cm + left[i % columns];
      placed.right_cm = placed.left_cm + widths[i % columns];
      placed.top_cm = row_cm + top[row];
      placed.bottom_cm = placed.top_cm + height[row];
      column_cm = placed.right_cm + right[i % columns];
    }
    row_cm += top[row] + height[row] + bottom[row];
  }
  layout.height_cm = row_cm + kEdge_cm;
  return layout;
}

}  // namespace touchtrial::analysis
