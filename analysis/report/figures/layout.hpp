/// \file Places the parts of a figure on its sheet. The lengths of texts determine the places.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The names below an axis, shortened to fit.
struct NamesBelow {
  std::vector<std::string> names;
  bool slanted = false;
  double room_cm = 0.0;
};

/// The distances of a panel's axis ends from the left and top edges of the sheet.
struct PlacedPanel {
  double left_cm = 0.0;
  double right_cm = 0.0;
  double top_cm = 0.0;
  double bottom_cm = 0.0;
  double tick_labels_cm = 0.0;  ///< width of the numbers or names beside the y axis
  NamesBelow x_names{};
};

/// An entry of the key.
struct KeyEntry {
  const Layer* layer = nullptr;  ///< shown by its sample
  std::string text;
  double left_cm = 0.0;
  double top_cm = 0.0;  ///< of its middle
};

struct Layout {
  double height_cm = 0.0;  ///< of the sheet
  std::vector<PlacedPanel> panels;
  std::vector<KeyEntry> key;
};

/// Aligns the axes of the panels in each row and column.
/// \return pointers into the figure
[[nodiscard]] Layout layout_of(const Figure& figure);

/// The average width of a letter, in the widest of the usual fonts.
inline constexpr double kLetter_cm = 0.148;
/// The maximum length of slanted names and of names beside an axis.
inline constexpr std::size_t kNameColumns = 18;
/// The width of a sample in the key, with its gap.
inline constexpr double kSample_cm = 0.55;

}  // namespace touchtrial::analysis
