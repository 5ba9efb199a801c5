#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table breakdown_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const char* explanation = breakdown.kind == BreakdownKind::exemplar ? ": picture of a texture"
                            : breakdown.kind == BreakdownKind::order_group ? ": order of methods"
                                                                           : "";
  std::string kind = name_of(breakdown.kind);
  const std::string id = "accuracy-by-" + slug_of(kind);
  std::ranges::replace(kind, '_', ' ');
  return method_table(report, index, id, "right answers by " + kind + explanation, breakdown.groups,
                      breakdown_measures(breakdown.kind));
}

std::vector<Cell> dependence_row(const char* question, const SerialDependence& dependence) {
  return {question, fmt::format("{} of {}", dependence.same, dependence.wrong), kNoFigure,
          plain_figure(dependence.expected, 1), p_figure(dependence.p)};
}

/// A slope in percentage points per ten trials.
std::string slope_figure(std::optional<double> slope) {
  return slope ? points_figure(10.0 * *slope) : kNoFigure;
}

Table order_table(const StudyReport& report, std::size_t index, const OrderEffects& order) {
  auto [id, caption] = method_table_name(
      report, index, "order", "dependence of answers on trial number and on the previous trial");
  Table table{std::move(id), std::move(caption),
              columns_of({"question", "found", "t 95%", "at random", "p"})};
  const auto interval = order.slope.known_interval();
  table.rows = {
      {"learning: change of accuracy over ten trials (points)", slope_figure(order.slope.mean),
       interval ? share_range(Interval{10.0 * interval->low, 10.0 * interval->high}) : kNoFigure,
       "0.0", p_figure(order.slope_p)},
      dependence_row("wrong answers that name the previous texture", order.class_before),
      dependence_row("wrong answers that repeat the previous answer", order.answer_before)};
  table.notes = {
      {fmt::format(
           "p: two-sided, from {} orders that the design could have produced, in which each answer "
           "stays with its presentation. More than at random: attraction to the previous trial; "
           "fewer: repulsion. The three tests are not adjusted.",
           order.draws),
       {Source::phipson_smyth, Source::fischer_whitney}},
      {"Learning: least squares within blocks, mean slope over participants with Student's t "
       "interval.",
       {Source::student}}};
  return table;
}

CitedText area_sentence(const StudyReport& report, std::size_t index,
                        const ConfidenceReport& confidence) {
  const MeanEstimate& area = confidence.area;
  if (!area.mean) {
    return {method_prefix(report, index) +
            "no participant has both a right and a wrong answer, so confidence cannot be compared "
            "between the two."};
  }
  std::string text = fmt::format("{}area under the type-2 ROC curve {}",
                                 method_prefix(report, index), plain_figure(area.mean, 2));
  if (const auto interval = area.known_interval()) {
    text += ", 95% t interval " + plain_range(interval, 2);
  }
  text += fmt::format(
      " (mean over {}). It is the probability of higher confidence in a right "
      "answer than in a wrong one; .50 if confidence is uninformative.",
      counted(area.participants, "participant"));
  if (confidence.without_area > 0) {
    text += fmt::format(
        " {} all right or all wrong and no area.",
        confidence.without_area == 1
            ? "1 participant has answers that are"
            : fmt::format("{} participants have answers that are", confidence.without_area));
  }
  return {text, {Source::fleming_lau, Source::student}};
}

}  // namespace

Section order_section(const StudyReport& report) {
  Section section{"order", "Order and carry-over", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    if (method.order) section.folded_blocks.emplace_back(order_table(report, i, *method.order));
    for (const Breakdown& breakdown : method.breakdowns) {
      // A figure shows accuracy by trial.
      if (breakdown.kind == BreakdownKind::trial || is_between_people(breakdown.kind)) continue;
      section.folded_blocks.emplace_back(breakdown_table(report, i, breakdown));
    }
  }
  return section;
}

Section visits_section(const StudyReport& report) {
  Section section{"visits-and-groups", "Visits and groups", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    bool is_first = true;
    for (const Breakdown& breakdown : report.methods[i].breakdowns) {
      if (!is_between_people(breakdown.kind)) continue;
      if (is_first) add_method_heading(report, i, section);
      is_first = false;
      section.blocks.emplace_back(breakdown_table(report, i, breakdown));
    }
  }
  return section;
}

Section confidence_section(const StudyReport& report) {
  Section section{"confidence", "Confidence", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const auto& confidence = report.methods[i].confidence;
    if (!confidence) continue;
    add_method_heading(report, i, section);
    section.blocks.emplace_back(area_sentence(report, i, *confidence));
    if (confidence->ratings.empty()) continue;
    section.blocks.emplace_back(method_table(report, i, "confidence", "right answers by confidence",
                                             confidence->ratings, rating_measures(*confidence)));
  }
  return section;
}

/// Contains only a note, because a figure shows the times and "Accuracy" has their medians by
/// texture.
Section times_section(const StudyReport& report) {
  Section section{"reaction-times", "Reaction times", {}};
  int paused = 0;
  for (const MethodReport& method : report.methods) {
    if (!method.reaction_times.empty()) paused += method.reaction_times.back().paused;
  }
  if (std::ranges::all_of(report.methods, &std::vector<ReactionTimes>::empty,
                          &MethodReport::reaction_times)) {
    return section;
  }
  section.folded_blocks.emplace_back(
      CitedText{fmt::format("Trials with a response, right or wrong, on the servo's clock: from "
                            "rendering of the plane to the answer. {} after a pause omitted.",
                            counted(paused, "response"))});
  return section;
}

Section robustness_section(const StudyReport& report) {
  Section section{"servo-and-validity", "Servo and validity", {}};
  if (const auto servo = servo_table(report.collection)) {
    section.folded_blocks.emplace_back(*servo);
  } else {
    section.folded_blocks.emplace_back(CitedText{
        "No trial ran in real time. In virtual time every tick is on time by construction."});
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].robustness.empty()) continue;
    section.folded_blocks.emplace_back(
        method_table(report, i, "with-and-without", "mean accuracy with other selections of trials",
                     report.methods[i].robustness, subset_measures()));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
