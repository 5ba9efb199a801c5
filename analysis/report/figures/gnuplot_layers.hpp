/// \file Layers of data as gnuplot commands.
#pragma once

#include "analysis/report/figures/figure.hpp"

#include <string>

namespace touchtrial::analysis {

/// The pen of a dashed line.
inline constexpr const char* kDashes = "dt (6, 5)";

/// The script of a layer.
struct Drawing {
  std::string data;      ///< before the plot
  std::string commands;  ///< before the plot
  std::string plot;      ///< part of the plot command; may be empty
};

/// \param name  of the data, unique in the script
[[nodiscard]] Drawing drawing_of(const std::string& name, const Layer& layer);

/// gnuplot's number of a glyph.
[[nodiscard]] int point_type(Glyph glyph) noexcept;
/// A number with six significant digits, or "NaN".
[[nodiscard]] std::string number_text(double value);
/// Sets a label.
/// \param placement  position and options in gnuplot's syntax; never user text
[[nodiscard]] std::string text_at(const std::string& text, const std::string& placement);
/// Draws a pale rectangle.
/// \param from,to  corners as gnuplot coordinates
[[nodiscard]] std::string pale_field(const std::string& from, const std::string& to,
                                     const std::string& colour);

}  // namespace touchtrial::analysis
