#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"

#include <fmt/format.h>

namespace touchtrial {
namespace {

std::string mean_range(const MeanEstimate& mean) {
  return mean.participants > 1 ? share_range(mean.interval) : kNoFigure;
}

std::vector<Cell> observer_row(const ObserverFigures& observer) {
  return {std::string(title_of(observer.cue)),
          share_figure(observer.mean.mean),
          mean_range(observer.mean),
          plain_figure(observer.efficiency.value, 2),
          plain_range(observer.efficiency.interval, 2),
          plain_figure(observer.corrected_efficiency.value, 2),
          plain_range(observer.corrected_efficiency.interval, 2),
          plain_figure(observer.divergence.value, 3),
          plain_range(observer.divergence.interval, 3)};
}

Table cue_table(const StudyReport& report, const MethodCues& method, std::size_t index) {
  Table table{"cues-" + std::to_string(index + 1),
              (report.methods.size() > 1 ? method.method + ": " : "") +
                  "what ideal observers would have made of what each hand felt",
              {{"observer uses", Align::left},
               {"accuracy"},
               {"95% (%)"},
               {"efficiency"},
               {"95%"},
               {"above chance"},
               {"95%"},
               {"divergence (bit)"},
               {"95%"}}};
  table.rows.push_back({"(participants themselves)",
                        Cell(share_figure(method.human_mean.mean), true),
                        mean_range(method.human_mean), "", "", "", "", "", ""});
  for (const ObserverFigures& one : method.observers) table.rows.push_back(observer_row(one));
  table.notes = {
      {fmt::format("{} of {}; observers judge each trial by the others' and know nothing of "
                   "answers. Accuracy: mean over participants with Student's t interval.",
                   counted(method.trials, "trial"),
                   counted(static_cast<std::int64_t>(method.participants.size()), "participant")),
       {Source::student}},
      {"Efficiency: participants' accuracy over the observer's; above chance: the same of what "
       "both have above chance. Intervals: bootstrap over participants.",
       {Source::davison_hinkley}},
      {"Divergence: Jensen-Shannon, between participants' and the observer's answers, mean over "
       "textures; 0 if they confuse alike.",
       {Source::lin}}};
  return table;
}

Cited match_of(const MethodCues& method) {
  if (!method.match) return {method.method + ": no trial tells which observer confuses alike."};
  const CueMatch& match = *method.match;
  const std::string verdict = match.told_apart
                                  ? "the two are told apart"
                                  : "the interval holds 0, so the two are not told apart";
  return {fmt::format("{}: participants' confusions are most like those of the observer of {} "
                      "({} bit less divergence than {}, {}: {}).",
                      method.method, title_of(match.best), plain_figure(match.difference.value, 3),
                      title_of(match.second), plain_range(match.difference.interval, 3), verdict),
          {Source::lin}};
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

}  // namespace

Section cues_section(const StudyReport& report) {
  Section section{"cues", "Which cue was it?", {}};
  if (!report.cues) {
    section.blocks.emplace_back(
        Cited{"Not looked at: ideal observers read every trace of the study. Ask for it with "
              "touchtrial report DB --out DIR --cues yes.",
              {}});
    return section;
  }
  for (std::size_t i = 0; i < report.cues->methods.size(); ++i) {
    const MethodCues& method = report.cues->methods[i];
    if (method.observers.empty()) {
      section.blocks.emplace_back(Cited{method.method + ": no trial could be judged.", {}});
      continue;
    }
    section.blocks.emplace_back(match_of(method));
    section.blocks.emplace_back(cue_table(report, method, i));
    const std::string left_out = left_out_of(method);
    if (!left_out.empty()) section.blocks.emplace_back(Cited{left_out, {}});
  }
  if (!report.cues->warnings.empty()) section.blocks.emplace_back(Warnings{report.cues->warnings});
  return section;
}

}  // namespace touchtrial
