/// \file Where the parts of a figure lie on its sheet, by the lengths of their texts.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The names below an axis, as far as there is room for them.
struct NamesBelow {
  std::vector<std::string> names;  ///< shortened if they are slanted
  bool slanted = false;
  double room_cm = 0.0;
};

/// A panel, with the distances of its axes' ends from the sheet's left and top edge.
struct PlacedPanel {
  double left_cm = 0.0;
  double right_cm = 0.0;
  double top_cm = 0.0;
  double bottom_cm = 0.0;
  double beside_cm = 0.0;  ///< the room of numbers or names beside the y axis
  NamesBelow below{};
};

/// A layer's name in the key.
struct KeyEntry {
  const Layer* layer = nullptr;  ///< of the figure, for a sample
  std::string text;
  double left_cm = 0.0;
  double top_cm = 0.0;  ///< of its middle
};

struct Layout {
  double height_cm = 0.0;  ///< of the sheet
  std::vector<PlacedPanel> panels;
  std::vector<KeyEntry> key;
};

/// Panels of a column have their axes below each other, panels of a row side by side.
/// \return with pointers into the figure
[[nodiscard]] Layout layout_of(const Figure& figure);

/// The average width of a letter of the figures' texts, in the widest of the usual fonts.
inline constexpr double kLetter_cm = 0.148;
/// The longest slanted names, and names beside an axis.
inline constexpr std::size_t kNameColumns = 18;
/// The room of a sample in the key, with its gap.
inline constexpr double kSample_cm = 0.55;

}  // namespace touchtrial::analysis
