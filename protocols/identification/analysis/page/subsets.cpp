#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/named.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <array>
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
      return {"accuracy-by-exemplar", "right answers by exemplar: which picture of a texture",
              "exemplar"};
    case BreakdownKind::trial:
      break;
    case BreakdownKind::order_group:
      return {"accuracy-by-order-group",
              "right answers by order group: in which order methods came", "order group"};
    case BreakdownKind::visit:
      return {"accuracy-by-visit", "right answers by visit", "visit"};
    case BreakdownKind::group:
      return {"accuracy-by-group", "right answers by group", "group"};
  }
  return {"", "", ""};
}

bool is_about_people(BreakdownKind kind) {
  return kind == BreakdownKind::visit || kind == BreakdownKind::group;
}

/// Over participants: what visits and groups differ in is about people.
Table people_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table = method_table(
      report, index, words.id, words.caption,
      columns_of({words.column, "participants", "n", "right", "mean (%)", "t 95% (%)"}));
  for (const GroupAccuracy& group : breakdown.groups) {
    const MeanEstimate mean = group.mean.value_or(MeanEstimate{});
    table.rows.push_back({group.group, std::to_string(mean.participants),
                          std::to_string(group.accuracy.n), std::to_string(group.accuracy.correct),
                          share_figure(mean.mean), share_range(mean.known_interval())});
  }
  table.notes = {
      {"Mean of participants' own accuracies with Student's t interval: to look at. The registered "
       "test decides, over the visits that were registered and all groups.",
       {Source::student}}};
  return table;
}

Table breakdown_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table =
      method_table(report, index, words.id, words.caption,
                   columns_of({words.column, "n", "right", "accuracy", "Wilson 95% (%)"}));
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
  Table table =
      method_table(report, index, "order",
                   "whether answers depend on when a texture came, and on what came just before",
                   columns_of({"question", "found", "t 95%", "at random", "p"}));
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

Table rating_table(const StudyReport& report, std::size_t index,
                   const ConfidenceReport& confidence) {
  Table table = method_table(
      report, index, "confidence", "right answers by how sure participants were",
      columns_of({"confidence", "n", "right", "accuracy", "participants", "mean", "t 95% (%)"}));
  for (const RatedAccuracy& one : confidence.ratings) {
    const bool lowest = &one == &confidence.ratings.front();
    const bool highest = &one == &confidence.ratings.back();
    const char* const meaning = lowest ? " (guessed)" : highest ? " (certain)" : "";
    table.rows.push_back(
        pooled_and_mean_row(std::to_string(one.rating) + meaning, one.accuracy, one.mean));
  }
  table.notes = {
      {"Trials with a response. Mean: of the own accuracies of the participants who gave this "
       "rating, with Student's t interval; ratings that few gave compare different people.",
       {Source::student}}};
  return table;
}

Cited area_sentence(const StudyReport& report, std::size_t index,
                    const ConfidenceReport& confidence) {
  const MeanEstimate& area = confidence.area;
  if (!area.mean) {
    return {
        method_prefix(report, index) +
        "no participant has both a right and a wrong answer, so that nobody's confidence can be "
        "compared between the two."};
  }
  std::string text = fmt::format("{}area under the type-2 ROC curve {}",
                                 method_prefix(report, index), plain_figure(area.mean, 2));
  if (const auto interval = area.known_interval()) {
    text += ", 95% t interval " + plain_range(interval, 2);
  }
  text += fmt::format(
      " (mean of the own areas of {}). It is the probability that somebody was surer of a right "
      "answer than of a wrong one; .50 if confidence tells nothing.",
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

Table times_table(const StudyReport& report) {
  Table table{"reaction-times", "Reaction times in seconds: medians and quartiles",
              columns_of({"texture"})};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    for (const char* from : {"plane on", "contact"}) {
      table.columns.push_back({method_prefix(report, i) + "from " + from});
    }
  }
  const auto cell = [](const Quartiles& of) {
    return of.median ? fmt::format("{} ({}, {})", plain_figure(of.median, 2),
                                   plain_figure(of.lower, 2), plain_figure(of.upper, 2))
                     : kNoFigure;
  };
  int paused = 0;
  for (std::size_t place = 0; place <= report.classes.size(); ++place) {
    const bool all = place == report.classes.size();
    std::vector<Cell>& row =
        table.rows.emplace_back(std::vector<Cell>{all ? "all" : report.classes[place]});
    for (const MethodReport& method : report.methods) {
      const ReactionTimes times =
          place < method.reaction.size() ? method.reaction[place] : ReactionTimes{};
      row.emplace_back(cell(times.from_plane_on));
      row.emplace_back(cell(times.from_contact));
      if (all) paused += times.paused;
    }
  }
  table.notes = {
      {"Trials with a response, right or wrong. From the moment the plane can be felt, and from "
       "first contact, to the answer; one monotonic clock, the servo's. Quantiles by "
       "interpolation (definition 7).",
       {Source::hyndman_fan}}};
  if (paused > 0) {
    table.notes.push_back({fmt::format("{} waited for the end of a pause and {} left out.",
                                       counted(paused, "response"), paused == 1 ? "is" : "are")});
  }
  return table;
}

const char* words_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames = std::to_array<Named<TrialSubset>>(
      {{"as counted (a missing response is wrong)", counted},
       {"trials without a response left out", answered},
       {"trials that break the validity rule left out", valid},
       {"excluded participants' sessions put back", with_excluded_sessions}});
  return name_in(kNames, subset).data();
}

Table robustness_table(const StudyReport& report, std::size_t index) {
  Table table = method_table(
      report, index, "with-and-without", "the mean accuracy with other choices of trials",
      columns_of({"trials", "n", "right", "pooled", "participants", "mean", "t 95% (%)"}));
  for (const SubsetAccuracy& one : report.methods[index].robustness) {
    table.rows.push_back(pooled_and_mean_row(words_of(one.subset), one.pooled, one.mean));
  }
  table.notes = {
      {"Mean over participants with Student's t interval. If a row's conclusion differs "
       "from the first's, say so beside the result.",
       {Source::student}}};
  return table;
}

}  // namespace

Section order_section(const StudyReport& report) {
  Section section{"order", "Order and carry-over", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    if (method.order) section.more.emplace_back(order_table(report, i, *method.order));
    for (const Breakdown& one : method.breakdowns) {
      // A figure shows accuracy by trial; the table above tests it.
      if (one.kind == BreakdownKind::trial || is_about_people(one.kind)) continue;
      section.more.emplace_back(breakdown_table(report, i, one));
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

Section confidence_section(const StudyReport& report) {
  Section section{"confidence", "Confidence", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const auto& confidence = report.methods[i].confidence;
    if (!confidence) continue;
    add_method_heading(report, i, section);
    section.blocks.emplace_back(area_sentence(report, i, *confidence));
    section.blocks.emplace_back(rating_table(report, i, *confidence));
  }
  return section;
}

Section times_section(const StudyReport& report) {
  Section section{"reaction-times", "Reaction times", {}};
  const auto has_times = [](const MethodReport& method) { return !method.reaction.empty(); };
  if (std::ranges::any_of(report.methods, has_times)) {
    section.more.emplace_back(times_table(report));
  }
  return section;
}

Section robustness_section(const StudyReport& report) {
  Section section{"servo-and-validity", "Servo and validity", {}};
  if (const auto servo = servo_table(report.collection)) {
    section.more.emplace_back(*servo);
  } else {
    section.more.emplace_back(
        Cited{"No trial ran in real time. In virtual time every tick is on time by construction, "
              "and says nothing about a device."});
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].robustness.empty()) continue;
    section.more.emplace_back(robustness_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
