// How sure participants were of their answers, and how long they took.
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table rating_table(const StudyReport& report, std::size_t index,
                   const ConfidenceReport& confidence) {
  Table table{"confidence-" + method_slug(report, index),
              method_prefix(report, index) + "right answers by how sure participants were",
              {{"confidence", Align::left},
               {"n"},
               {"right"},
               {"accuracy"},
               {"participants"},
               {"mean"},
               {"t 95% (%)"}}};
  for (const RatedAccuracy& one : confidence.ratings) {
    const bool lowest = &one == &confidence.ratings.front();
    const bool highest = &one == &confidence.ratings.back();
    const char* const meaning = lowest ? " (guessed)" : highest ? " (certain)" : "";
    table.rows.push_back({std::to_string(one.rating) + meaning, std::to_string(one.accuracy.n),
                          std::to_string(one.accuracy.correct), share_figure(one.accuracy.share()),
                          std::to_string(one.mean.participants), share_figure(one.mean.mean),
                          share_range(one.mean.known_interval())});
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

std::vector<Cell> time_row(const std::string& name, const ReactionTimes& times) {
  return {name,
          std::to_string(times.from_plane_on.n),
          plain_figure(times.from_plane_on.lower, 2),
          plain_figure(times.from_plane_on.median, 2),
          plain_figure(times.from_plane_on.upper, 2),
          plain_figure(times.from_contact.lower, 2),
          plain_figure(times.from_contact.median, 2),
          plain_figure(times.from_contact.upper, 2)};
}

Table times_table(const StudyReport& report, std::size_t index) {
  Table table{"reaction-times-" + method_slug(report, index),
              method_prefix(report, index) +
                  "reaction times in seconds by the texture presented: quartiles and medians",
              {{"texture", Align::left},
               {"n"},
               {"plane on, 25%"},
               {"plane on, median"},
               {"plane on, 75%"},
               {"contact, 25%"},
               {"contact, median"},
               {"contact, 75%"}}};
  const std::vector<ReactionTimes>& times = report.methods[index].reaction;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool all = i >= report.classes.size();
    table.rows.push_back(time_row(all ? "all" : report.classes[i], times[i]));
  }
  table.notes = {
      {"Trials with a response, right or wrong. From the moment the plane can be felt, "
       "and from first contact, to the answer; one monotonic clock, the servo's. "
       "Quantiles by interpolation (definition 7).",
       {Source::hyndman_fan}}};
  if (const int paused = times.empty() ? 0 : times.back().paused; paused > 0) {
    table.notes.push_back({fmt::format("{} waited for the end of a pause and {} left out.",
                                       counted(paused, "response"), paused == 1 ? "is" : "are")});
  }
  return table;
}

}  // namespace

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
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].reaction.empty()) continue;
    section.blocks.emplace_back(times_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
