#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/cues/cue_measures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// The accuracies of the ideal observers show the available information.
Table cue_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table =
      table_of("cues-" + std::to_string(index + 1),
               method_prefix(report, index) + "accuracy of ideal observers from the same traces",
               method.observers, efficiency_measures());
  table.rows.insert(table.rows.begin(),
                    {"(participants)", Cell(share_figure(method.human_mean.mean), true),
                     share_range(method.human_mean.known_interval()), "", "", "", ""});
  table.notes.insert(
      table.notes.begin(),
      {fmt::format("{} of {}. An observer judges each trial from the other trials, without knowing "
                   "the answers. Accuracy: mean over participants with Student's t interval; – if "
                   "all are equal.",
                   counted(method.trials, "trial"),
                   counted(static_cast<std::int64_t>(method.participants.size()), "participant")),
       {Source::student}});
  return table;
}

Table divergence_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table = table_of(
      "cues-confusing-" + std::to_string(index + 1),
      method_prefix(report, index) + "divergence of observers' confusions from participants'",
      method.observers, divergence_measures(method.match));
  if (!std::ranges::all_of(method.observers, &ObserverFigures::is_as_uncertain)) {
    table.notes.push_back(
        {"* No noise makes this observer as accurate as participants, so its divergence also "
         "reflects the difference in accuracy."});
  }
  return table;
}

bool can_match_accuracy(const MethodCues& method, Cue cue) {
  const auto found = std::ranges::find(method.observers, cue, &ObserverFigures::cue);
  return found == method.observers.end() || found->is_as_uncertain();
}

std::string verdict_of(const MethodCues& method, const CueMatch& match) {
  const auto participants = static_cast<std::int64_t>(method.participants.size());
  if (participants < kMinForVerdict) {
    return fmt::format("with {}, it is undecided whether the two differ",
                       counted(participants, "participant"));
  }
  if (!match.difference.interval) {
    return "without an interval, it is undecided whether the two differ";
  }
  const std::string interval = "95% interval " + plain_range(match.difference.interval, 3);
  if (match.difference.interval->low <= 0.0) {
    return interval + ", which contains 0, so the two are not distinguishable";
  }
  return interval + (match.is_distinct ? ", so the two differ" : "");
}

CitedText match_sentence(const MethodCues& method) {
  if (!method.match) {
    return {method.method + ": too few answers to compare confusions with observers'."};
  }
  const CueMatch& match = *method.match;
  const std::string conditions =
      std::ranges::all_of(method.observers, &ObserverFigures::is_as_uncertain)
          ? "with all observers as accurate as participants, participants' confusions are most like"
          : "with observers as close to participants' accuracy as noise permits, participants' "
            "confusions are most like";
  std::string text = fmt::format(
      "{}: {} those of the observer of {} ({} bit less matched divergence than {}; {}).",
      method.method, conditions, title_of(match.best), plain_figure(match.difference.value, 3),
      title_of(match.second), verdict_of(method, match));
  if (!can_match_accuracy(method, match.best)) {
    text +=
        " No noise makes this observer as accurate as participants, so this does not show that "
        "they used only this cue.";
  }
  return {text, {Source::lin}};
}

void add_observers(const StudyReport& report, const CueReport& cues, Section& section) {
  for (std::size_t i = 0; i < cues.methods.size(); ++i) {
    const MethodCues& method = cues.methods[i];
    if (method.observers.empty()) continue;  // there is a warning
    section.folded_blocks.emplace_back(match_sentence(method));
    section.folded_blocks.emplace_back(cue_table(report, method, i));
    section.folded_blocks.emplace_back(divergence_table(report, method, i));
  }
  if (!cues.warnings.empty()) section.folded_blocks.emplace_back(Warnings{cues.warnings});
}

}  // namespace

Section cues_section(const StudyReport& report, bool has_explorations) {
  Section section{"cues", "Ideal observers of cues", {}};
  if (report.cues) {
    add_observers(report, *report.cues, section);
  } else {
    section.folded_blocks.emplace_back(CitedText{
        "Not examined: ideal observers read every trace of the study. To include them, run "
        "touchtrial report DB --out DIR --cues yes.",
        {}});
  }
  if (has_explorations)
    section.folded_blocks.emplace_back(Subheading{kExplorations, "Examples of exploration"});
  return section;
}

}  // namespace touchtrial::analysis::identification
