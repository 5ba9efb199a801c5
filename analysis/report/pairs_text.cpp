#include "analysis/report/report_text_parts.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string p_or_none(const std::optional<double>& p) {
  return p ? p_value(*p) : "-";
}

std::string odds_text(const std::optional<OddsRatio>& ratio) {
  if (!ratio) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", ratio->estimate, ratio->interval.low,
                     ratio->interval.high);
}

std::string together_text(const MethodsTogether& together) {
  return wrapped("  ", fmt::format("all at once: Cochran's Q = {:.2f}, {} degrees of freedom, "
                                   "methods exchanged within participants p = {}",
                                   together.cochran.q, together.cochran.degrees_of_freedom,
                                   p_or_none(together.permuted_p)));
}

}  // namespace

std::string pairs_text(const StudyReport& report) {
  if (report.methods.size() < 3) return "";
  TextTable table({"first less second", "points", "95 % interval", "p", "p (Holm)", "odds ratio"});
  for (const MethodPair& pair : report.pairs) {
    const MethodComparison& overall = pair.overall;
    table.add({report.methods[pair.first].method + " - " + report.methods[pair.second].method,
               overall.difference ? points(*overall.difference) : "-",
               points_range(overall.known_interval()), p_or_none(overall.p), p_or_none(pair.p_holm),
               odds_text(pair.odds_ratio)});
  }
  std::string text = heading("every two methods", report.simulated) + table.text();
  if (report.together) text += together_text(*report.together);
  return text;
}

}  // namespace touchtrial::analysis
