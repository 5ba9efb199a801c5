#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

std::string mean_range(const MeanEstimate& mean) {
  return share_range(mean.known_interval());
}

std::vector<Cell> observer_row(const ObserverFigures& observer) {
  return {std::string(title_of(observer.cue)),
          share_figure(observer.mean.mean),
          mean_range(observer.mean),
          plain_figure(observer.efficiency.value, 2),
          plain_range(observer.efficiency.interval, 2),
          plain_figure(observer.corrected_efficiency.value, 2),
          plain_range(observer.corrected_efficiency.interval, 2)};
}

/// The accuracies of the ideal observers, which show how much information there was to feel.
Table cue_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table{
      "cues-" + std::to_string(index + 1),
      method_prefix(report, index) + "accuracy of ideal observers, given what each hand felt",
      columns_of(
          {"observer uses", "accuracy", "95% (%)", "efficiency", "95%", "above chance", "95%"})};
  table.rows.push_back({"(participants)", Cell(share_figure(method.human_mean.mean), true),
                        mean_range(method.human_mean), "", "", "", ""});
  for (const ObserverFigures& one : method.observers) table.rows.push_back(observer_row(one));
  table.notes = {
      {fmt::format("{} of {}; observers judge each trial by the other trials, and do not know the "
                   "answers. Accuracy: mean over participants with Student's t interval; – if all "
                   "have the same.",
                   counted(method.trials, "trial"),
                   counted(static_cast<std::int64_t>(method.participants.size()), "participant")),
       {Source::student}},
      {"Efficiency: participants' accuracy over the observer's; above chance: the same of what "
       "both have above chance. Intervals: bootstrap over participants.",
       {Source::davison_hinkley}}};
  return table;
}

std::vector<Cell> confusing_row(const ObserverFigures& observer, bool best) {
  return {std::string(title_of(observer.cue)),
          plain_figure(observer.divergence.value, 3),
          plain_range(observer.divergence.interval, 3),
          plain_figure(observer.matched_noise, 2) + (observer.is_as_uncertain() ? "" : " *"),
          Cell(plain_figure(observer.matched_divergence.value, 3), best),
          plain_range(observer.matched_divergence.interval, 3)};
}

/// The table on which observer confuses classes as participants do.
Table confusing_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table{"cues-confusing-" + std::to_string(index + 1),
              method_prefix(report, index) + "how far observers' confusions are from participants'",
              columns_of({"observer uses", "divergence (bit)", "95%", "noise to match",
                          "divergence, matched (bit)", "95%"})};
  for (const ObserverFigures& one : method.observers) {
    table.rows.push_back(confusing_row(one, method.match && method.match->best == one.cue));
  }
  table.notes = {
      {"Divergence: Jensen-Shannon, between participants' and the observer's answers, mean over "
       "textures; 0 if they confuse alike, 1 at most. Estimates and intervals: jackknife over "
       "participants, because confusions of few answers lie too far from any observer's.",
       {Source::lin, Source::miller_jackknife}},
      {"Matched: an observer that is hardly ever wrong has no confusions to be compared, so its "
       "sense is given noise (on each felt log intensity) until it is right as often as "
       "participants; 0 if "
       "it is not right more often without. The least is emphasised."}};
  const auto lacks = [](const ObserverFigures& one) { return !one.is_as_uncertain(); };
  if (std::ranges::any_of(method.observers, lacks)) {
    table.notes.push_back(
        {"* No noise makes this observer right as often as participants, so that its divergence "
         "also shows that it is right more or less often."});
  }
  return table;
}

/// With fewer participants, an interval over participants does not support a verdict.
constexpr std::size_t kMinToJudge = 6;

bool reaches(const MethodCues& method, Cue cue) {
  const auto found = std::ranges::find(method.observers, cue, &ObserverFigures::cue);
  return found == method.observers.end() || found->is_as_uncertain();
}

std::string verdict_of(const MethodCues& method, const CueMatch& match) {
  const std::size_t participants = method.participants.size();
  if (participants < kMinToJudge) {
    return fmt::format("with {} it cannot be decided whether the two differ",
                       counted(static_cast<std::int64_t>(participants), "participant"));
  }
  if (!match.difference.interval) {
    return "without an interval it cannot be decided whether the two differ";
  }
  const std::string interval = "95% interval " + plain_range(match.difference.interval, 3);
  if (match.difference.interval->low <= 0.0) {
    return interval + ", which contains 0, so the two are not told apart";
  }
  return interval + (match.is_distinct ? ", so the two are told apart" : "");
}

Cited match_of(const MethodCues& method) {
  if (!method.match)
    return {method.method +
            ": no trial shows which observer's confusions are "
            "most like the participants'."};
  const CueMatch& match = *method.match;
  const std::string beginning =
      std::ranges::all_of(kCues, [&](Cue cue) { return reaches(method, cue); })
          ? "once all observers are as uncertain as participants, their confusions are most like"
          : "with the noise that brings observers nearest to participants' accuracy, and not all "
            "can reach it, participants' confusions are most like";
  std::string text = fmt::format(
      "{}: {} those of the observer of {} ({} bit less matched divergence than {}; {}).",
      method.method, beginning, title_of(match.best), plain_figure(match.difference.value, 3),
      title_of(match.second), verdict_of(method, match));
  if (!reaches(method, match.best)) {
    text +=
        " No noise makes this observer right as often as participants: it is no verdict that they "
        "used this alone.";
  }
  return {text, {Source::lin}};
}

std::string left_out_of(const MethodCues& method) {
  std::string text;
  if (method.without_trace > 0) {
    text += fmt::format("{}: {} left out for want of a readable trace. ", method.method,
                        counted(method.without_trace, "trial"));
  }
  if (method.unjudged > 0) {
    text += fmt::format("{}: {} left out because no other trial had their texture.", method.method,
                        counted(method.unjudged, "trial"));
  }
  return text;
}

void add_observers(const StudyReport& report, const CueReport& cues, Section& section) {
  for (std::size_t i = 0; i < cues.methods.size(); ++i) {
    const MethodCues& method = cues.methods[i];
    if (method.observers.empty()) {
      section.more.emplace_back(Cited{method.method + ": no trial could be judged.", {}});
      continue;
    }
    section.more.emplace_back(match_of(method));
    section.more.emplace_back(cue_table(report, method, i));
    section.more.emplace_back(confusing_table(report, method, i));
    const std::string left_out = left_out_of(method);
    if (!left_out.empty()) section.more.emplace_back(Cited{left_out, {}});
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
