/// \file The common look of all figures: sizes in centimetres as printed, text of 8 points, colours
/// after Okabe and Ito that also differ in lightness, and a mark for every colour.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/statistics/proportion.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

inline constexpr std::string_view kInk = "#1a1a1a";
inline constexpr std::string_view kFaint = "#8c8c8c";

/// The colour of the n-th method or other series; colours repeat after six.
[[nodiscard]] std::string_view series_colour(std::size_t n) noexcept;
/// gnuplot's number of the n-th series' filled mark.
[[nodiscard]] int series_mark(std::size_t n) noexcept;

struct Rgb {
  int red = 0;  ///< 0 to 255, like the others
  int green = 0;
  int blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// A colour from white to dark blue: the larger the share, the darker, in colour and in grey.
/// \param share  0 .. 1
[[nodiscard]] Rgb shade_of(double share) noexcept;
/// Black or white, whichever has more contrast.
[[nodiscard]] Rgb ink_on(Rgb ground) noexcept;
/// The contrast of two colours, from 1 to 21. Source: WCAG 2.1, relative luminance.
[[nodiscard]] double contrast(Rgb a, Rgb b) noexcept;
/// "#003e6e"
[[nodiscard]] std::string hexadecimal(Rgb colour);

/// The paper that a figure is drawn on.
struct Sheet {
  double width_cm = 16.0;
  double height_cm = 8.0;
  bool simulated = false;
};

/// The distances of a panel's border from the sheet's edges.
struct Margins {
  double left_cm = 1.5;
  double right_cm = 0.4;
  double top_cm = 0.9;
  double bottom_cm = 1.0;
};

/// A figure of the sheet's size, still without caption and script.
/// \param section  Figure::section
[[nodiscard]] Figure figure_on(const Sheet& sheet, std::string id, std::string alt = {},
                               std::string section = {});

/// Sets borders, tics and grid, and stamps what is simulated.
[[nodiscard]] std::string sheet_head(const Sheet& sheet);
/// Places a panel.
[[nodiscard]] std::string panel_at(const Sheet& sheet, const Margins& margins);
/// A text on the sheet.
/// \param at  gnuplot's "at .." and what follows; never from the user
[[nodiscard]] std::string text_at(const std::string& text, const std::string& at);
/// A text at a distance from the sheet's left and top edge.
[[nodiscard]] std::string text_on_sheet(const Sheet& sheet, const std::string& text, double left_cm,
                                        double top_cm, const std::string& more = "left");

/// Numbers by row and column.
using Rows = std::vector<std::vector<double>>;

/// "$name << EOD .." with rows of numbers; those not finite become "NaN", which gnuplot omits.
[[nodiscard]] std::string data_block(const std::string& name,
                                     std::span<const std::vector<double>> rows);

/// Adds a row for a mark with a bar: its place, and a mean and the ends of its interval, which are
/// the mean itself if there is none.
void add_bar(Rows& rows, double place, double mean, const std::optional<Interval>& interval,
             double unit = 1.0);

/// At most `most` of the values, evenly spaced in their order.
/// \param most  >= 2
[[nodiscard]] std::vector<double> evenly_chosen(const std::vector<double>& sorted,
                                                std::size_t most);
/// The most dots that `add_dots` adds.
inline constexpr std::size_t kMaxDots = 100;
/// Adds a row (x, value) for each of at most kMaxDots evenly chosen values. A sequence that fills
/// intervals evenly (multiples of the golden section) spreads them around x.
void add_dots(Rows& rows, double x, double width, const std::vector<double>& sorted);

/// An axis in per cent from 0 to 100, with room for whole marks at 100.
[[nodiscard]] std::string accuracy_axis(const std::string& label);
/// A dashed line across the panel.
[[nodiscard]] std::string dashed_line(double height);
/// A dashed line at 1 / classes across the panel; `chance_entry` explains it.
[[nodiscard]] std::string chance_line(int classes);

/// The columns of slanted names below a panel at the sheet's left edge.
inline constexpr std::size_t kSlantedColumns = 18;

/// Names below an axis from 1 to names.size(): level if they fit, else slanted and shortened.
class NamesBelow {
 public:
  /// \param slanted_columns  length to which slanted names are cut, so that they stay on the sheet
  NamesBelow(std::span<const std::string> names, double axis_cm,
             std::size_t slanted_columns = kSlantedColumns);
  /// The room that the names need below the axis.
  [[nodiscard]] double room_cm() const noexcept { return room_cm_; }
  /// Sets the axis' range and the names.
  [[nodiscard]] std::string script() const;

 private:
  std::vector<std::string> names_;
  bool slanted_ = false;
  double room_cm_ = 0.6;
};

/// A mark, a line or a field, with its meaning.
struct LegendEntry {
  enum class Kind { mark, line, dashes, field };
  Kind kind{};
  std::string colour;
  int mark = 7;  ///< gnuplot's number; only of a mark
  std::string text;
};

[[nodiscard]] LegendEntry mark_entry(int mark, std::string_view colour, std::string text);
[[nodiscard]] LegendEntry chance_entry(int classes);

/// Entries in rows above the panels. gnuplot's own key would overlap narrow panels.
class Legend {
 public:
  Legend(const Sheet& sheet, double left_cm, std::span<const LegendEntry> entries);
  /// The room that the legend needs below the sheet's upper edge.
  [[nodiscard]] double room_cm() const noexcept { return room_cm_; }
  [[nodiscard]] const std::string& script() const noexcept { return script_; }

 private:
  double room_cm_ = 0.0;
  std::string script_;
};

/// The sentence, after "SIMULATED participants: " if they are.
[[nodiscard]] std::string stamped(bool simulated, const std::string& sentence);
/// "87.0 % (60.9 to 91.1 %)", or "87.0 %" without an interval
[[nodiscard]] std::string with_interval(double share, const std::optional<Interval>& interval);

/// Room above all panels for the legend.
inline constexpr double kLegend_cm = 0.7;

/// Panels of equal size in rows, one for each method, on a sheet as high as they need.
class Panels {
 public:
  /// \param count  >= 1
  /// \param across  the most panels in a row
  /// \param height_cm  of one panel with its margins
  /// \param around  margins of one panel, within its share of the sheet
  Panels(std::size_t count, std::size_t across, double height_cm, const Margins& around,
         bool simulated);

  [[nodiscard]] const Sheet& sheet() const noexcept { return sheet_; }
  /// The width of one panel between its axes' ends.
  [[nodiscard]] double axis_cm() const noexcept;
  /// Places a panel, with its title if there are several.
  [[nodiscard]] std::string begin(std::size_t panel, const std::string& title) const;

 private:
  std::size_t count_;
  std::size_t across_;
  double height_cm_;
  Margins around_;
  Sheet sheet_;
};

}  // namespace touchtrial::analysis
