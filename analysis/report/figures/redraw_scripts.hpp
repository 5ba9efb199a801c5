/// \file Parts shared by the scripts that redraw a figure.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/layout.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

inline constexpr double kInchesOfCm = 1.0 / 2.54;

/// A text as a string of Python and of R.
[[nodiscard]] std::string quoted(const std::string& text);

/// "c(1, 2, 3)": the numbers from 1, one for each name.
/// \param open,close  "c(" and ")", or "[" and "]"
[[nodiscard]] std::string numbers_of(const std::vector<std::string>& names, const char* open,
                                     const char* close);
/// The names, quoted.
[[nodiscard]] std::string list_of(const std::vector<std::string>& names, const char* open,
                                  const char* close);

/// The arrangement of panels.
struct Grid {
  std::size_t columns = 1;
  std::size_t rows = 1;
  std::string widths;   ///< comma-separated numbers
  std::string heights;  ///< likewise
};

/// \param figure  with a panel
[[nodiscard]] Grid grid_of(const Figure& figure, const Layout& layout);

/// "SIMULATED PILOT"; may be empty
[[nodiscard]] std::string stamps_of(const Figure& figure);

/// The beginning of every script: redraw_matplotlib.py and redraw_ggplot.r.
[[nodiscard]] std::string_view matplotlib_head() noexcept;
[[nodiscard]] std::string_view ggplot_head() noexcept;

/// A script for matplotlib that reads the figure's CSV beside it.
[[nodiscard]] std::string matplotlib_script(const Figure& figure, const Layout& layout);
/// The same for ggplot2.
[[nodiscard]] std::string ggplot_script(const Figure& figure, const Layout& layout);

}  // namespace touchtrial::analysis
