#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

namespace touchtrial::analysis::threshold {
namespace {

Table group_table(const ThresholdReport& report) {
  Table table =
      table_of("d-prime-by-level", "d' of same or different, of all participants' answers pooled",
               report.same_different_groups, group_measures(report));
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
  section.blocks.emplace_back(group_table(report));
  return section;
}

}  // namespace touchtrial::analysis::threshold
