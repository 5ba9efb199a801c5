#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/cues/cue_measures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

/// The accuracies of the ideal observers, which show how much information there was to
/// feel.
Table cue_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table = table_of(
      "cues-" + std::to_string(index + 1),
      method_prefix(report, index) + "accuracy of ideal observers that feel what hands felt",
      method.observers, efficiency_measures());
  table.rows.insert(table.rows.begin(),
                    {"(participants)", Cell(share_figure(method.human_mean.mean), true),
                     share_range(method.human_mean.known_interval()), "", "", "", ""});
  table.notes.insert(
      table.notes.begin(),
      {fmt::format("{} of {}. An observer judges each trial by the other trials, without knowing "
                   "the answers. Accuracy: mean over participants with Student's t interval; – if "
                   "all have the same.",
                   counted(method.trials, "trial"),
                   counted(static_cast<std::int64_t>(method.participants.size()), "participant")),
       {Source::student}});
  return table;
}

/// How similar observers' confusions are to participants'.
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

bool reaches(const MethodCues& method, Cue cue) {
  const auto found = std::ranges::find(method.observers, cue, &ObserverFigures::cue);
  return found == method.observers.end() || found->is_as_uncertain();
}

std::string verdict_of(const MethodCues& method, const CueMatch& match) {
  const auto participants = static_cast<std::int64_t>(method.participants.size());
  if (participants < kMinForVerdict) {
    return fmt::format("with {} whether the two differ is undecided",
                       counted(participants, "participant"));
  }
  if (!match.difference.interval) {
    return "without an interval whether the two differ is undecided";
  }
  const std::string interval = "95% interval " + plain_range(match.difference.interval, 3);
  if (match.difference.interval->low <= 0.0) {
    return interval + ", which contains 0, so the two are not distinguishable";
  }
  return interval + (match.is_distinct ? ", so the two differ" : "");
}

Cited match_of(const MethodCues& method) {
  if (!method.match) {
    return {method.method + ": too few answers to compare confusions with observers'."};
  }
  const CueMatch& match = *method.match;
  const std::string beginning =
      std::ranges::all_of(method.observers, &ObserverFigures::is_as_uncertain)
          ? "with all observers as accurate as participants, participants' confusions are most like"
          : "with observers as near to participants' accuracy as noise can bring them, "
            "participants' confusions are most like";
  std::string text = fmt::format(
      "{}: {} those of the observer of {} ({} bit less matched divergence than {}; {}).",
      method.method, beginning, title_of(match.best), plain_figure(match.difference.value, 3),
      title_of(match.second), verdict_of(method, match));
  if (!reaches(method, match.best)) {
    text +=
        " No noise makes this observer as accurate as participants, so this does not show that "
        "they "
        "used this cue alone.";
  }
  return {text, {Source::lin}};
}

void add_observers(const StudyReport& report, const CueReport& cues, Section& section) {
  for (std::size_t i = 0; i < cues.methods.size(); ++i) {
    const MethodCues& method = cues.methods[i];
    if (method.observers.empty()) continue;  // a warning says so
    section.more.emplace_back(match_of(method));
    section.more.emplace_back(cue_table(report, method, i));
    section.more.emplace_back(divergence_table(report, method, i));
  }
  if (!cues.warnings.empty()) section.more.emplace_back(Warnings{cues.warnings});
}

}  // namespace

Section cues_section(const StudyReport& report, bool explores) {
  Section section{"cues", "Ideal observers of cues", {}};
  if (report.cues) {
    add_observers(report, *report.cues, section);
  } else {
    section.more.emplace_back(
        Cited{"Not examined: ideal observers read every trace of the study. Ask for it with "
              "touchtrial report DB --out DIR --cues yes.",
              {}});
  }
  if (explores) section.more.emplace_back(Subheading{kExplorations, "How a hand explored"});
  return section;
}

}  // namespace touchtrial::analysis::identification
