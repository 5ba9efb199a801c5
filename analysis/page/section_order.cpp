#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"

namespace touchtrial::analysis {
namespace {

struct KindWords {
  const char* id;
  const char* caption;
  const char* column;
};

KindWords words_of(BreakdownKind kind) {
  switch (kind) {
    case BreakdownKind::exemplar:
      return {"exemplar", "by exemplar: which picture of a texture", "exemplar"};
    case BreakdownKind::trial:
      return {"trial", "by trial: its place among a participant's scored trials", "trial"};
    case BreakdownKind::order_group:
      return {"order-group", "by order group: in which order methods came", "order group"};
    case BreakdownKind::previous_stimulus:
      return {"previous-texture", "by the texture presented just before", "before it"};
    case BreakdownKind::previous_response:
      return {"previous-answer", "by the answer given just before", "answered before it"};
  }
  return {"", "", ""};
}

Table breakdown_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table{std::string("accuracy-by-") + words.id + "-" + method_slug(report, index),
              method_prefix(report, index) + "right answers " + words.caption,
              {{words.column, Align::left}, {"n"}, {"right"}, {"accuracy"}, {"Wilson 95% (%)"}}};
  for (const GroupAccuracy& group : breakdown.groups) {
    table.rows.push_back({group.group, std::to_string(group.accuracy.n),
                          std::to_string(group.accuracy.correct),
                          share_figure(group.accuracy.share()), share_range(group.wilson)});
  }
  table.notes = {
      {"All participants' trials pooled as if independent: to look at, not to test "
       "with. Of many such rows some stand out by chance.",
       {Source::wilson}}};
  return table;
}

}  // namespace

Section order_section(const StudyReport& report) {
  Section section{"order", "Order and carry-over", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].breakdowns.empty()) continue;
    add_method_heading(report, i, section);
    for (const Breakdown& one : report.methods[i].breakdowns) {
      section.blocks.emplace_back(breakdown_table(report, i, one));
    }
  }
  return section;
}

}  // namespace touchtrial::analysis
