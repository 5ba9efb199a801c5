#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

namespace touchtrial::analysis::threshold {
namespace {

Table group_table(const ThresholdReport& report) {
  Table table =
      table_of("d-prime-by-level", "d' of same or different, all participants' answers pooled",
               report.same_different_groups, group_measures(report));
  table.notes = {
      {"Differencing: the observer judges the difference between the two impressions; quote it if "
       "levels are mixed or gains roved. Independent: each impression is judged separately, which "
       "needs two fixed stimuli; its d' is smaller (Macmillan and Creelman 2005, chapter 9). Hits "
       "are of the level, false alarms of all levels of the standard. Counts of none or all are "
       "changed by half an answer. With fewer hits than false alarms d' is 0, its most likely "
       "value."},
      {"Bootstrap: expanded percentiles over participants, with at least six. There is no mean of "
       "participants' d', which would be far too small for small d' with realistic numbers of "
       "trials.",
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
