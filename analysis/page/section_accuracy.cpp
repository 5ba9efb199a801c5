#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::vector<Cell> accuracy_row(const std::string& name, const ClassAccuracy& one) {
  return {name,
          std::to_string(one.accuracy.n),
          std::to_string(one.accuracy.correct),
          share_figure(one.accuracy.share()),
          share_range(one.wilson),
          share_range(one.clopper_pearson),
          share_range(one.jeffreys)};
}

Table class_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  Table table{"accuracy-by-class-" + method_slug(report, index),
              method_prefix(report, index) +
                  "right answers by the texture presented, all participants' trials pooled",
              {{"texture", Align::left},
               {"n"},
               {"right"},
               {"accuracy"},
               {"Wilson 95% (%)"},
               {"Clopper-Pearson 95% (%)"},
               {"Jeffreys 95% (%)"}}};
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    table.rows.push_back(accuracy_row(report.classes[i], method.accuracy[i]));
  }
  table.notes = {{"Wilson: score interval.", {Source::wilson}},
                 {"Clopper-Pearson: exact, never below its level.", {Source::clopper_pearson}},
                 {"Jeffreys: quantiles of a beta distribution, by convention from 0 where no "
                  "answer is right and to 1 where all are. All three take trials as "
                  "independent, which a participant's are not, "
                  "so they are too narrow; the interval to quote is that of the headline.",
                  {Source::brown_cai_dasgupta}}};
  return table;
}

/// Which labels the best matching exchanges: "pebbles → brick, brick → pebbles".
std::string exchange_of(const LabelMatching& matching, const std::vector<std::string>& classes) {
  if (matching.answer_of.empty()) return kNoFigure;
  std::string text;
  for (std::size_t i = 0; i < matching.answer_of.size() && i < classes.size(); ++i) {
    const auto answer = static_cast<std::size_t>(matching.answer_of[i]);
    if (answer == i || answer >= classes.size()) continue;
    text += (text.empty() ? "" : ", ") + classes[i] + " → " + classes[answer];
  }
  return text.empty() ? "none" : text;
}

Table participant_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  Table table{"accuracy-by-participant-" + method_slug(report, index),
              method_prefix(report, index) + "right answers by participant",
              {{"participant", Align::left},
               {"n"},
               {"right"},
               {"accuracy"},
               {"with the best exchange of labels"},
               {"exchange", Align::left},
               {"consistency (bit)"}}};
  for (const ParticipantAccuracy& one : method.per_participant) {
    table.rows.push_back(
        {one.participant, std::to_string(one.accuracy.n), std::to_string(one.accuracy.correct),
         share_figure(one.accuracy.share()), share_figure(one.matching.accuracy.share()),
         exchange_of(one.matching, report.classes), plain_figure(one.consistency, 2)});
  }
  table.notes = {
      {"The best exchange of labels is the one-to-one matching of textures and answers with the "
       "most trials: somebody who swaps two labels tells them apart all the same. It is chosen "
       "after the fact, and so biased upward.",
       {Source::kuhn}},
      {"Consistency is the raw information transfer of one participant's trials, biased upward "
       "and not to be quoted.",
       {Source::tan_reed_durlach}}};
  return table;
}

}  // namespace

Section accuracy_section(const StudyReport& report) {
  Section section{"accuracy", "Accuracy", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    add_method_heading(report, i, section);
    section.blocks.emplace_back(class_table(report, i));
    section.blocks.emplace_back(participant_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis
