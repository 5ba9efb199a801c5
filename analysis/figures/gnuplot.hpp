/// \file Figures by gnuplot, which is needed only when one is asked for.
#pragma once

#include "core/files.hpp"

#include <filesystem>
#include <string>

namespace touchtrial::analysis {

/// For before long work whose figure would come last.
/// \throws Error if gnuplot is not there or does not start, with the remedy
void require_gnuplot();

/// Runs a script and writes the picture that it prints to its standard output.
/// gnuplot starts from its defaults, whatever the user's own settings.
/// \param script  sets a terminal, and no output file
/// \param mode  who may read the picture
/// \throws Error if gnuplot is not there or refuses the script
/// \throws FileError if the picture cannot be written
/// Thread-safe.
void draw_with_gnuplot(const std::string& script, const std::filesystem::path& picture,
                       FileMode mode = FileMode::everyone);

/// A text as a gnuplot string: on one line, in quotes. What gnuplot makes of
/// mark-up is up to the script ("noenhanced").
[[nodiscard]] std::string gnuplot_string(const std::string& text);

}  // namespace touchtrial::analysis
