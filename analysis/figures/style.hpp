/// \file The one look of a report's figures: sizes in centimetres as printed, text of 8 points,
/// colours after Okabe and Ito that differ in lightness too, and a mark beside every colour.
/// Private to figures.
#pragma once

#include "analysis/figures/figure.hpp"
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

/// Of the n-th method or other series; they come round after six.
[[nodiscard]] std::string_view series_colour(std::size_t n) noexcept;
/// gnuplot's filled mark of the n-th series.
[[nodiscard]] int series_mark(std::size_t n) noexcept;

/// What a figure is drawn on.
struct Sheet {
  double width_cm = 16.0;
  double height_cm = 8.0;
  bool simulated = false;
};

/// Distances of a panel's border from the sheet's edges.
struct Margins {
  double left_cm = 1.5;
  double right_cm = 0.4;
  double top_cm = 0.9;
  double bottom_cm = 1.0;
};

/// Borders, tics, grid and, where it is due, the stamp.
[[nodiscard]] std::string sheet_head(const Sheet& sheet);
[[nodiscard]] std::string panel_at(const Sheet& sheet, const Margins& margins);
/// A text on the sheet. \param at  gnuplot's "at .." and whatever follows; never from the user
[[nodiscard]] std::string text_at(const std::string& text, const std::string& at);
/// The same a number of centimetres from the sheet's left and top edge.
[[nodiscard]] std::string text_on_sheet(const Sheet& sheet, const std::string& text, double left_cm,
                                        double top_cm, const std::string& more = "left");

/// "$name << EOD .." of numbers alone; what is not finite becomes "NaN", which gnuplot leaves out.
[[nodiscard]] std::string data_block(const std::string& name,
                                     std::span<const std::vector<double>> rows);

/// Per cent from 0 to 100, with headroom so that marks at 100 are whole.
[[nodiscard]] std::string accuracy_axis(const std::string& label);
/// A dashed line at 1 / classes over the panel; it is said what it is in `chance_words`.
[[nodiscard]] std::string chance_line(int classes);
/// "chance (1 of 5)"
[[nodiscard]] std::string chance_words(int classes);

/// Of a panel on the sheet's left.
inline constexpr std::size_t kSlantedColumns = 18;

/// Names below an axis from 1 to names.size(): level where they fit, else slanted and shortened.
class NamesBelow {
 public:
  /// \param slanted_columns  to which slanted names are cut: longer ones leave the sheet
  NamesBelow(std::span<const std::string> names, double axis_cm,
             std::size_t slanted_columns = kSlantedColumns);
  /// Room that they need below the axis.
  [[nodiscard]] double room_cm() const noexcept { return room_cm_; }
  /// Sets the axis' range and writes the names.
  [[nodiscard]] std::string script() const;

 private:
  std::vector<std::string> names_;
  bool slanted_ = false;
  double room_cm_ = 0.6;
};

/// A mark, a line or a field, and what it stands for.
struct LegendEntry {
  enum class Kind { mark, line, dashes, field };
  Kind kind{};
  std::string colour;
  int mark = 7;  ///< gnuplot's number, of a mark alone
  std::string text;
};

[[nodiscard]] LegendEntry mark_entry(int mark, std::string_view colour, std::string text);
[[nodiscard]] LegendEntry chance_entry(int classes);

/// Entries in rows above the panels, placed by us: gnuplot's own key overlaps what is narrow.
class Legend {
 public:
  Legend(const Sheet& sheet, double left_cm, std::span<const LegendEntry> entries);
  /// Room that it needs below the sheet's upper edge.
  [[nodiscard]] double room_cm() const noexcept { return room_cm_; }
  [[nodiscard]] const std::string& script() const noexcept { return script_; }

 private:
  double room_cm_ = 0.0;
  std::string script_;
};

/// "SIMULATED participants: " where it is due, then the sentence.
[[nodiscard]] std::string stamped(bool simulated, const std::string& sentence);
/// "87.0 % (60.9 to 91.1 %)", or "87.0 %" without an interval
[[nodiscard]] std::string with_interval(double share, const std::optional<Interval>& interval);

}  // namespace touchtrial::analysis
