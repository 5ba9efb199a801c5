#include "analysis/figures/gnuplot.hpp"

#include "analysis/figures/gnuplot_process.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

namespace touchtrial::analysis {

void require_gnuplot() {
  static_cast<void>(GnuplotProcess("--version", "").result());
}

void draw_with_gnuplot(const std::string& script, const std::filesystem::path& picture,
                       FileMode mode) {
  const std::string drawn = GnuplotProcess("", script).result();
  if (drawn.empty()) throw Error("gnuplot: drew nothing; try version 5.2 or later");
  replace_file(picture, drawn, mode);
}

std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : one_line(text)) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace touchtrial::analysis
