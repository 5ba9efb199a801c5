#include "analysis/text_figures.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {

std::string percent(std::optional<double> percentage, int decimals) {
  if (!percentage) return "-";
  return fmt::format("{:.{}f}%", *percentage, decimals);
}

std::string percent_of_share(std::optional<double> share) {
  if (!share) return "-";
  return percent(100.0 * *share, 1);
}

std::string percent_of(const Proportion& proportion) {
  return percent_of_share(proportion.share());
}

std::string signed_figure(std::optional<double> figure, int decimals) {
  if (!figure) return "-";
  const std::string text = fmt::format("{:+.{}f}", *figure, decimals);
  // A number that rounds to zero has no sign.
  return text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

std::string p_value(double p) {
  // Rounds halves up, so that 0.03125, a smallest possible p, is not shown as less.
  return fmt::format("{:.3g}", p * (1.0 + 1e-9));
}

std::string heading(const std::string& title, bool simulated) {
  return fmt::format("\n{}{}\n", title, simulated ? " [SIMULATED]" : "");
}

std::string simulated_line(bool simulated) {
  return simulated ? "SIMULATED: these numbers come from simulated participants.\n" : "";
}

}  // namespace touchtrial::analysis
