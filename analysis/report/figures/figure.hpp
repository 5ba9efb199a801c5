/// \file A figure as a declaration: panels with axes and layers of data. gnuplot draws it
/// (gnuplot_script.hpp); users can redraw it from its data and scripts (redraw.hpp).
#pragma once

#include "core/plane.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Figure widths of two-column journals.
inline constexpr double kColumn_cm = 8.5;
inline constexpr double kPage_cm = 17.0;

/// One row of a layer's data, in units of the axes. Unused numbers are NaN.
struct Datum {
  double x = kNoNumber;
  double y = kNoNumber;
  double low = kNoNumber;
  double high = kNoNumber;
  double value = kNoNumber;
  std::string text{};  ///< what the row describes, such as a participant
};

/// How a layer shows its rows. Rows without the numbers that the kind needs are not drawn.
enum class LayerKind {
  points,               ///< a mark at (x, y); with `value`, its area grows by that factor
  line,                 ///< through the rows; a new line where `text` changes
  path,                 ///< a line coloured by `value` on the panel's colour scale
  band,                 ///< between `low` and `high` over x
  interval,             ///< a mark at (x, y) and a bar from `low` to `high`, along y
  horizontal_interval,  ///< `interval` along x
  box,                  ///< from `low` to `high` around x with a line at y, `value` wide
  rule,    ///< a line through the panel at y, or at x; with a band from `low` to `high`
  tile,    ///< a square around (x, y), shaded by `value` in 0 .. 1, with `text`
  label,   ///< `text` at (x, y)
  arrow,   ///< from (x, y) to (`low`, `high`)
  picture  ///< `grey` from the corner (x, y) to the corner (`low`, `high`), the first line at y
};

enum class Glyph { disc, square, triangle, diamond, down, ring, cross };
enum class Anchor { start, middle, end };

struct Layer {
  LayerKind kind = LayerKind::points;
  std::string name{};  ///< of the data: "participants"
  std::vector<Datum> rows{};
  std::string colour{};  ///< "#0072b2"; empty: ink
  double size = 1.0;     ///< scale of marks and line widths
  Glyph glyph = Glyph::disc;
  bool dashed = false;
  bool in_key = false;  ///< whether the key above the panels names it
  /// The part of a label's text that is at x. The text of a horizontal rule is within the panel at
  /// its right end, or with `start` beyond it.
  Anchor anchor = Anchor::middle;
  GreyImage grey{};
};

struct Axis {
  std::string label{};
  std::optional<double> low{};  ///< of the range; nothing: from the data
  std::optional<double> high{};
  double step = 0.0;                 ///< between ticks; 0: automatic
  double first = 0.0;                ///< first tick
  std::vector<std::string> names{};  ///< at 1, 2, .., in place of numbers
  bool logarithmic = false;
  bool reversed = false;
  bool hidden = false;  ///< no line and no ticks
};

struct Panel {
  std::string title{};
  Axis x{};
  Axis y{};
  std::vector<Layer> layers{};
  double height_cm = 4.6;      ///< length of the y axis; 0: as the other panels of the row
  double aspect = 0.0;         ///< height / width, replaces height_cm; 0: unused
  double share = 1.0;          ///< of the row's width
  double room_right_cm = 0.0;  ///< for labels beyond the axis
  std::string colour_scale{};  ///< label of the scale of a path; empty: none
  double scale_max = 0.0;      ///< upper end of that scale; it begins at 0
};

struct Figure {
  std::string id;         ///< file name without extension: "accuracy-by-class"
  std::string caption;    ///< one or two sentences with the intervals' method; stamped if simulated
  std::string alt;        ///< text alternative with the main numbers
  std::string section{};  ///< id of its section or subheading on the page; empty: not on the page
  std::vector<Panel> panels{};  ///< row by row
  std::size_t panels_per_row = 1;
  double width_cm = kColumn_cm;
  bool simulated = false;
  std::string stamp{};  ///< in addition to SIMULATED; may be empty
};

enum class FigureFormat { svg, pdf };

/// Runs gnuplot. An SVG file has a title and a description for screen readers, but no scripts or
/// references to other files. Equal figures give equal bytes.
/// \return the whole SVG or PDF file
/// \throws Error if gnuplot is not installed or fails
/// Thread-safe.
[[nodiscard]] std::string draw_figure(const Figure& figure, FigureFormat format);

/// Draws figures, several at the same time.
/// \return the files, in the order of the figures
/// \throws Error as draw_figure
/// Thread-safe.
[[nodiscard]] std::vector<std::string> draw_figures(std::span<const Figure> figures,
                                                    FigureFormat format);

}  // namespace touchtrial::analysis
