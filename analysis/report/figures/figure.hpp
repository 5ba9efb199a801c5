/// \file A figure as a declaration: panels with axes and layers of data. gnuplot draws it
/// (gnuplot_script.hpp), and its data and scripts go to whoever wants to redraw it (redraw.hpp).
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

/// One row of a layer's data, in units of the axes. Numbers that its layer does not use are NaN.
struct Datum {
  double x = kNoNumber;
  double y = kNoNumber;
  double low = kNoNumber;
  double high = kNoNumber;
  double value = kNoNumber;
  std::string text{};  ///< what the row is of, such as a participant
};

/// How a layer shows its rows. Rows without the numbers that a kind needs are left out.
enum class LayerKind {
  points,    ///< a mark at (x, y); with `value`, its area grows by that factor
  line,      ///< through the rows; a new line where `text` changes
  path,      ///< likewise, coloured by `value` on the panel's colour scale
  band,      ///< between `low` and `high` over x
  interval,  ///< a mark at (x, y) and a bar from `low` to `high`, along y
  across,    ///< the same along x
  box,       ///< from `low` to `high` around x with a line at y, `value` wide
  rule,      ///< a line through the panel at y, or at x; with a band from `low` to `high`
  tile,      ///< a square around (x, y), shaded by `value` in 0 .. 1, with `text`
  label,     ///< `text` at (x, y)
  arrow,     ///< from (x, y) to (`low`, `high`)
  picture    ///< `grey` from the corner (x, y) to the corner (`low`, `high`), the first line at y
};

enum class Glyph { disc, square, triangle, diamond, down, ring, cross };
enum class Anchor { start, middle, end };

struct Layer {
  LayerKind kind = LayerKind::points;
  std::string name{};  ///< of the data: "participants"
  std::vector<Datum> rows{};
  std::string colour{};  ///< "#0072b2"; empty: ink
  double size = 1.0;     ///< of marks and of a line's width, relative to the usual one
  Glyph glyph = Glyph::disc;
  bool dashed = false;
  bool in_key = false;  ///< whether the key above the panels names it
  /// Which part of a label's text is at x. The text of a level rule stands within the panel at its
  /// right end, with `start` beyond it.
  Anchor anchor = Anchor::middle;
  GreyImage grey{};
};

struct Axis {
  std::string label{};
  std::optional<double> low{};  ///< of the range; nothing: from the data
  std::optional<double> high{};
  double step = 0.0;                 ///< between ticks from `first` on; 0: chosen
  double first = 0.0;                ///< tick
  std::vector<std::string> names{};  ///< at 1, 2 and so on, in place of numbers
  bool logarithmic = false;
  bool reversed = false;
  bool hidden = false;  ///< neither line nor ticks
};

struct Panel {
  std::string title{};
  Axis x{};
  Axis y{};
  std::vector<Layer> layers{};
  double height_cm = 4.6;      ///< between the ends of the y axis; 0: as the row's others
  double aspect = 0.0;         ///< height by width, in place of a height; 0: none
  double share = 1.0;          ///< of the row's width
  double room_right_cm = 0.0;  ///< for labels beyond the axis
  std::string colour_scale{};  ///< label of the scale of a path; empty: none
  double strongest = 0.0;      ///< upper end of that scale; it begins at 0
};

struct Figure {
  std::string id;         ///< file name without extension: "accuracy-by-class"
  std::string caption;    ///< one sentence or two, with the intervals' method; stamped if simulated
  std::string alt;        ///< text alternative with the main numbers
  std::string section{};  ///< id of the section or subheading below which it stands; empty: no page
  std::vector<Panel> panels{};  ///< row by row
  std::size_t across = 1;       ///< panels in a row
  double width_cm = kColumn_cm;
  bool simulated = false;
  std::string stamp{};  ///< besides SIMULATED; may be empty
};

enum class FigureFormat { svg, pdf };

/// Runs gnuplot. An SVG file has a title and a description for screen readers, and no script or
/// reference to other files. Equal figures give equal bytes.
/// \return the whole SVG or PDF file
/// \throws Error if gnuplot is not installed or refuses the script
/// Thread-safe.
[[nodiscard]] std::string drawn(const Figure& figure, FigureFormat format);

/// Draws every figure, several at the same time.
/// \return the files, in the order of the figures
/// \throws Error as `drawn`
/// Thread-safe.
[[nodiscard]] std::vector<std::string> all_drawn(std::span<const Figure> figures,
                                                 FigureFormat format);

}  // namespace touchtrial::analysis
