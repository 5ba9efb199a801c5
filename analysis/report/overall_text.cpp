#include "analysis/report/report_text_parts.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string mean_line(const MethodReport& method) {
  std::string text = fmt::format(
      "mean over {} {}, 95 % interval {}", counted(method.mean.participants, "participant"),
      percent_of_share(method.mean.mean), percent_range(method.mean.known_interval()));
  if (method.bootstrap) text += fmt::format(", bootstrap {}", percent_range(*method.bootstrap));
  return text;
}

std::string pooled_line(const MethodReport& method) {
  std::string text = fmt::format("pooled {} of {}, {}", method.overall.correct, method.overall.n,
                                 percent_of(method.overall));
  if (method.chance) {
    text += fmt::format("; by chance {:.1f}, p = {} ({})", method.chance->expected,
                        p_value(method.chance->p), method.chance->exact ? "exact" : "Monte Carlo");
  }
  return text;
}

std::string matching_line(const MethodReport& method) {
  if (method.overall.n == 0) return "";
  return fmt::format("{} under the best exchange of labels", percent_of(method.matching.accuracy));
}

std::string information_line(const InformationTransfer& information) {
  if (!information.raw) return "";
  return fmt::format(
      "information transfer {:.2f} bit raw, {:.2f} corrected, {:.2f} if answers were dealt at "
      "random",
      *information.raw, information.corrected.value_or(0.0), information.null_mean.value_or(0.0));
}

std::string seconds(const Quartiles& times) {
  return fmt::format("{:.2f} s [{:.2f}, {:.2f}]", *times.median, *times.lower, *times.upper);
}

std::string reaction_line(const MethodReport& method) {
  if (method.reaction.empty() || !method.reaction.back().from_plane_on.median) return "";
  const ReactionTimes& all = method.reaction.back();
  std::string text = "answered after " + seconds(all.from_plane_on) + " (median, quartiles)";
  if (all.from_contact.median) text += ", " + seconds(all.from_contact) + " from contact";
  return text;
}

/// Subsets that are other trials than the headline's.
std::string robustness_line(const MethodReport& method) {
  constexpr std::pair<TrialSubset, const char*> kTold[] = {
      {TrialSubset::answered, "answered trials alone"},
      {TrialSubset::valid, "valid trials alone"},
      {TrialSubset::with_excluded_sessions, "excluded sessions put back"}};
  std::string text;
  for (const SubsetAccuracy& one : method.robustness) {
    if (one.pooled.n == method.overall.n) continue;
    for (const auto& [subset, name] : kTold) {
      if (subset != one.subset) continue;
      text += fmt::format("{}{} {}", text.empty() ? "the mean with other trials: " : ", ", name,
                          percent_of_share(one.mean.mean));
    }
  }
  return text;
}

}  // namespace

std::string overall_text(const MethodReport& method) {
  std::string text;
  for (const std::string& line :
       {mean_line(method), pooled_line(method), matching_line(method),
        information_line(method.information), reaction_line(method), robustness_line(method)}) {
    if (!line.empty()) text += wrapped("  ", line);
  }
  return text;
}

std::string flow_text(const ParticipantFlow& flow) {
  const std::pair<int, const char*> lost[] = {{flow.withdrawn, "withdrawn"},
                                              {flow.replaced, "replaced"},
                                              {flow.excluded, "excluded"},
                                              {flow.stopped, "stopped"},
                                              {flow.open, "open"},
                                              {flow.other_kind, "of another kind"},
                                              {flow.unseen, "ended after the look"},
                                              {flow.analysed, "analysed"}};
  std::string text = fmt::format("{} enrolled", flow.enrolled);
  for (const auto& [n, what] : lost) {
    if (n > 0) text += fmt::format(", {} {}", n, what);
  }
  return wrapped("", text);
}

}  // namespace touchtrial::analysis
