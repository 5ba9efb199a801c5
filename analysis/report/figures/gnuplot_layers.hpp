/// \file Layers of data as gnuplot commands.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>

namespace touchtrial::analysis {

/// The pen of a dashed line.
inline constexpr const char* kDashes = "dt (6, 5)";

/// A layer: data before the plot, commands, and a part of the plot.
struct Drawing {
  std::string data;
  std::string commands;
  std::string plot;  ///< empty: there is nothing to plot
};

/// \param name  of the data, unique in the script
[[nodiscard]] Drawing drawing_of(const std::string& name, const Layer& layer);

/// gnuplot's number.
[[nodiscard]] int point_type(Glyph glyph) noexcept;
/// Six digits, or "NaN".
[[nodiscard]] std::string number_text(double value);
/// Sets a label.
/// \param at  gnuplot's "at .." and what follows; never from the user
[[nodiscard]] std::string text_at(const std::string& text, const std::string& at);
/// A pale rectangle.
/// \param from,to  corners as gnuplot coordinates
[[nodiscard]] std::string pale_field(const std::string& from, const std::string& to,
                                     const std::string& colour);

}  // namespace touchtrial::analysis
