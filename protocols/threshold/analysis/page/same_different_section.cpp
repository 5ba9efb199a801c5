#include "analysis/report/page/wording.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

std::string cell_of(const Proportion& of) {
  return fmt::format("{} of {}", of.correct, of.n);
}

Table same_different_table(const ThresholdReport& report, const std::string& id,
                           const std::string& caption, bool pooled) {
  Table table{id, caption,
              columns_of({"participant", "standard", "level (dB)", "hits", "false alarms",
                          "at all levels", "d' differencing", "d' independent"},
                         {"standard"})};
  for (const SameDifferentLevel& one : report.same_different) {
    if (one.participant.empty() != pooled) continue;
    table.rows.push_back({pooled ? "all, pooled" : one.participant,
                          report.standards[one.standard].words, plain_figure(one.level, 1),
                          cell_of(one.different), cell_of(one.same), cell_of(one.same_at_all),
                          plain_figure(one.d_differencing, 2), plain_figure(one.d_independent, 2)});
  }
  return table;
}

Table group_d_prime_table(const ThresholdReport& report) {
  Table table{"d-prime-by-level", "d' of same or different, of all participants' answers pooled",
              columns_of({"standard", "level (dB)", "participants", "d' differencing",
                          "bootstrap 95%", "d' independent", "bootstrap 95%"})};
  for (const SameDifferentGroup& one : report.same_different_groups) {
    table.rows.push_back(
        {report.standards[one.standard].words, plain_figure(one.level, 1),
         std::to_string(one.participants), plain_figure(one.differencing.d_prime, 2),
         plain_range(one.differencing.interval, 2), plain_figure(one.independent.d_prime, 2),
         plain_range(one.independent.interval, 2)});
  }
  table.notes = {
      {"Differencing: the observer compares how far the two impressions are apart; to quote where "
       "levels are mixed or gains roved. Independent: each impression is judged by itself, which "
       "needs two fixed stimuli; its d' is smaller (Macmillan and Creelman 2005, chapter 9). Hits "
       "are those of the level, false alarms those of all levels of the standard. Half an answer "
       "stands for none and is taken from all. With fewer hits than false alarms d' is 0, which is "
       "most likely."},
      {"Bootstrap: expanded percentiles over draws of whole participants, from six on. There is no "
       "mean of participants' own d': where d' is small it would be far too small, with any number "
       "of trials that a session has.",
       {Source::davison_hinkley, Source::hesterberg}}};
  return table;
}

}  // namespace

Section same_different_section(const ThresholdReport& report) {
  Section section{"same-or-different", "Same or different", {}};
  if (report.same_different.empty()) return section;
  section.blocks.emplace_back(group_d_prime_table(report));
  section.more.emplace_back(same_different_table(
      report, "same-different-pooled", "Answers \"different\", all participants pooled", true));
  section.more.emplace_back(same_different_table(report, "same-different-participants",
                                                 "Answers \"different\" by participant", false));
  return section;
}

}  // namespace touchtrial::analysis::threshold
