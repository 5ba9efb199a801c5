/// \file Panels of equal size in rows, one a method.
#pragma once

#include "analysis/figures/style.hpp"

#include <cstddef>

namespace touchtrial::analysis {

/// Where panels lie on their sheet, which is as high as they need.
class Panels {
 public:
  /// \param count  >= 1 \param across  at most this many in a row
  /// \param around  of one panel, within its share of the sheet
  Panels(std::size_t count, std::size_t across, double height_cm, const Margins& around,
         bool simulated);

  [[nodiscard]] const Sheet& sheet() const noexcept { return sheet_; }
  /// Width of one panel between its axes' ends.
  [[nodiscard]] double axis_cm() const noexcept;
  /// Its place, and its title where there are several.
  [[nodiscard]] std::string begin(std::size_t panel, const std::string& title) const;

 private:
  std::size_t count_;
  std::size_t across_;
  double height_cm_;
  Margins around_;
  Sheet sheet_;
};

/// Room above all panels for the legend.
inline constexpr double kLegend_cm = 0.7;

}  // namespace touchtrial::analysis
