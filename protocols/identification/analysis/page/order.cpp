#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
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
      break;
    case BreakdownKind::order_group:
      return {"order-group", "by order group: in which order methods came", "order group"};
    case BreakdownKind::visit:
      return {"visit", "by visit", "visit"};
    case BreakdownKind::group:
      return {"group", "by group", "group"};
  }
  return {"", "", ""};
}

bool is_about_people(BreakdownKind kind) {
  return kind == BreakdownKind::visit || kind == BreakdownKind::group;
}

/// Over participants: what visits and groups differ in is about people.
Table people_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table{std::string("accuracy-by-") + words.id + "-" + method_slug(report, index),
              method_prefix(report, index) + "right answers " + words.caption,
              {{words.column, Align::left},
               {"participants"},
               {"n"},
               {"right"},
               {"mean (%)"},
               {"t 95% (%)"}}};
  for (const GroupAccuracy& group : breakdown.groups) {
    const MeanEstimate mean = group.mean.value_or(MeanEstimate{});
    const auto interval = mean.known_interval();
    table.rows.push_back({group.group, std::to_string(mean.participants),
                          std::to_string(group.accuracy.n), std::to_string(group.accuracy.correct),
                          share_figure(mean.mean), interval ? share_range(*interval) : kNoFigure});
  }
  table.notes = {
      {"Mean of participants' own accuracies with Student's t interval: to look at. The registered "
       "test decides, over the visits that were registered and all groups.",
       {Source::student}}};
  return table;
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

std::vector<Cell> dependence_row(const char* what, const SerialDependence& found) {
  return {what, fmt::format("{} of {}", found.same, found.wrong), kNoFigure,
          plain_figure(found.expected, 1), p_figure(found.p)};
}

/// A slope in percentage points per ten trials.
std::string slope_figure(std::optional<double> slope) {
  return slope ? points_figure(10.0 * *slope) : kNoFigure;
}

Table order_table(const StudyReport& report, std::size_t index, const OrderEffects& order) {
  Table table{"order-" + method_slug(report, index),
              method_prefix(report, index) +
                  "whether answers depend on when a texture came, and on what came just before",
              {{"question", Align::left}, {"found"}, {"t 95%"}, {"at random"}, {"p"}}};
  const auto interval = order.slope.known_interval();
  table.rows = {
      {"learning: change of accuracy over ten trials (points)", slope_figure(order.slope.mean),
       interval ? share_range(Interval{10.0 * interval->low, 10.0 * interval->high}) : kNoFigure,
       "0.0", p_figure(order.slope_p)},
      dependence_row("wrong answers that name the texture presented before", order.class_before),
      dependence_row("wrong answers that repeat the answer before", order.answer_before)};
  table.notes = {
      {fmt::format("p two-sided, of {} orders that the design could have produced, in which each "
                   "answer stays with its presentation. More than at random: drawn to what came "
                   "before; less: driven from it. Three tests, not adjusted for each other.",
                   order.draws),
       {Source::phipson_smyth, Source::fischer_whitney}},
      {"Learning: least squares within blocks, mean of participants' own slopes with Student's t "
       "interval.",
       {Source::student}}};
  return table;
}

}  // namespace

Section order_section(const StudyReport& report) {
  Section section{"order", "Order and carry-over", {}, true};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    if (method.breakdowns.empty() && !method.order) continue;
    add_method_heading(report, i, section);
    if (method.order) section.blocks.emplace_back(order_table(report, i, *method.order));
    for (const Breakdown& one : method.breakdowns) {
      // A figure shows accuracy by trial; the table above tests it.
      if (one.kind == BreakdownKind::trial || is_about_people(one.kind)) continue;
      section.blocks.emplace_back(breakdown_table(report, i, one));
    }
  }
  return section;
}

Section visits_section(const StudyReport& report) {
  Section section{"visits-and-groups", "Visits and groups", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    bool first = true;
    for (const Breakdown& one : report.methods[i].breakdowns) {
      if (!is_about_people(one.kind)) continue;
      if (first) add_method_heading(report, i, section);
      first = false;
      section.blocks.emplace_back(people_table(report, i, one));
    }
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
