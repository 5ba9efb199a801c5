/// \file The gnuplot terminal of every picture that the benchmarks draw.
#pragma once

#include <string>

namespace touchtrial::bench {

/// The command that selects gnuplot's output: PNG or SVG of this size in pixels.
[[nodiscard]] inline std::string gnuplot_terminal(bool png, int width, int height) {
  const std::string size = std::to_string(width) + ", " + std::to_string(height);
  if (png) return "set terminal pngcairo size " + size + " font 'DejaVu Sans,13'\n";
  return "set terminal svg size " + size +
         " dynamic font 'DejaVu Sans,Arial,sans-serif,13' background '#ffffff'\n";
}

}  // namespace touchtrial::bench
