#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

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

}  // namespace touchtrial::analysis::identification
