/// \file Parts shared by the scripts that redraw a figure.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/layout.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

inline constexpr double kInchesPerCm = 1.0 / 2.54;

/// Quotes a text as a string literal for Python and R.
[[nodiscard]] std::string quoted(const std::string& text);

/// "c(1, 2, 3)": numbers from 1, one per name.
/// \param open,close  "c(" and ")", or "[" and "]"
[[nodiscard]] std::string numbers_of(const std::vector<std::string>& names, const char* open,
                                     const char* close);
/// "c("a", "b")"
[[nodiscard]] std::string list_of(const std::vector<std::string>& names, const char* open,
                                  const char* close);

/// The arrangement of panels.
struct Grid {
  std::size_t columns = 1;
  std::size_t rows = 1;
  std::string widths;   ///< comma-separated numbers
  std::string heights;  ///< comma-separated numbers
};

/// \param figure  must have a panel
[[nodiscard]] Grid grid_of(const Figure& figure, const Layout& layout);

/// "SIMULATED PILOT"; may be empty
[[nodiscard]] std::string stamps_of(const Figure& figure);

/// The beginnings of the scripts: redraw_matplotlib.py and redraw_ggplot.r.
[[nodiscard]] std::string_view matplotlib_head() noexcept;
[[nodiscard]] std::string_view ggplot_head() noexcept;

/// Scripts that read the figure's CSV in their folder.
[[nodiscard]] std::string matplotlib_script(const Figure& figure, const Layout& layout);
[[nodiscard]] std::string ggplot_script(const Figure& figure, const Layout& layout);

}  // namespace touchtrial::analysis
