/// \file What the scripts that redraw a figure share.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/layout.hpp"

#include <cstddef>
#include <string>
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

/// How panels share the figure.
struct Grid {
  std::size_t columns = 1;
  std::size_t rows = 1;
  std::string widths;   ///< numbers with commas between them
  std::string heights;  ///< likewise
};

/// \param figure  with a panel
[[nodiscard]] Grid grid_of(const Figure& figure, const Layout& layout);

/// "SIMULATED PILOT"; may be empty
[[nodiscard]] std::string stamps_of(const Figure& figure);

/// A script for matplotlib that reads the figure's CSV beside it.
[[nodiscard]] std::string matplotlib_script(const Figure& figure, const Layout& layout);
/// The same for ggplot2.
[[nodiscard]] std::string ggplot_script(const Figure& figure, const Layout& layout);

}  // namespace touchtrial::analysis
