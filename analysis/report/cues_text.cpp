#include "analysis/report/report_text_parts.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string figure_text(const CueFigure& figure, int decimals) {
  if (!figure.value) return "-";
  std::string text = fmt::format("{:.{}f}", *figure.value, decimals);
  if (figure.interval) {
    text += fmt::format(" [{:.{}f}, {:.{}f}]", figure.interval->low, decimals,
                        figure.interval->high, decimals);
  }
  return text;
}

std::string mean_text(const MeanEstimate& mean) {
  const std::string text = percent_of_share(mean.mean);
  return mean.known_interval() ? text + ' ' + percent_range(mean.known_interval()) : text;
}

std::string verdict_text(const CueMatch& match) {
  return wrapped(
      "  ", fmt::format("confusions are most like those of {} ({} bit less divergence than {}): {}",
                        title_of(match.best), figure_text(match.difference, 3),
                        title_of(match.second), match.told_apart ? "told apart" : "no verdict"));
}

std::string observers_text(const MethodCues& cues, bool simulated) {
  TextTable table({"who", "accuracy, 95 %", "efficiency, 95 %", "matched divergence (bit), 95 %"});
  table.add({"participants", mean_text(cues.human_mean), "", ""});
  for (const ObserverFigures& one : cues.observers) {
    table.add({std::string(title_of(one.cue)), mean_text(one.mean), figure_text(one.efficiency, 2),
               figure_text(one.matched_divergence, 3)});
  }
  std::string text = heading(cues.method + ": ideal observers of what was felt", simulated);
  text += table.text();
  if (cues.match) text += verdict_text(*cues.match);
  return text;
}

}  // namespace

std::string cues_text(const CueReport& cues) {
  std::string text;
  for (const MethodCues& method : cues.methods) text += observers_text(method, cues.simulated);
  if (cues.warnings.empty()) return text;
  text += heading("to bear in mind of the observers", cues.simulated);
  for (const std::string& warning : cues.warnings) text += wrapped("  - ", warning);
  return text;
}

}  // namespace touchtrial::analysis
