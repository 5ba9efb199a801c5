#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/rating/analysis/measures.hpp"
#include "protocols/rating/analysis/page.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

template <typename Row>
Table scale_table(const RatingReport& report, const ScaleReport& scale, const char* id,
                  const char* caption, const std::vector<Row>& rows,
                  const MeasureList<Row>& measures) {
  return table_of(id_of(report, scale, id), caption_of(report, scale, caption), rows, measures);
}

Table groups_table(const RatingReport& report, const ScaleReport& scale) {
  Table table =
      scale_table(report, scale, "means-over-items", "Mean ratings by method, and by texture",
                  scale.means.methods, group_measures("method", report.methods));
  std::ranges::move(
      table_of("", "", scale.means.classes, group_measures("class", report.classes)).rows,
      std::back_inserter(table.rows));
  table.notes = {
      {"n: participants who rated all items of the row; Student's interval.", {Source::student}}};
  return table;
}

void add_correlation(const std::string& name, const std::string& people,
                     const std::optional<IntraclassCorrelation>& correlation, Table& table) {
  table.rows.push_back(
      {name, people,
       plain_figure(correlation ? std::optional(correlation->estimate) : std::nullopt,
                    kCorrelationDecimals),
       plain_range(correlation ? correlation->interval : std::nullopt, kCorrelationDecimals)});
}

Table reliability_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "reliability"),
              caption_of(report, scale, "Agreement about textures and methods"),
              {{"agreement", Align::left}, {"n"}, {"estimate"}, {"95%"}}};
  const Agreement& agreement = scale.agreement;
  const std::string people = std::to_string(agreement.participants);
  add_correlation("between single participants: ICC(2,1)", people, agreement.single, table);
  add_correlation("between means of k participants: ICC(2,k)", people, agreement.average, table);
  const RetestReliability& retest = scale.retest;
  table.rows.push_back({"repeats within a participant: ICC(1,1)",
                        std::to_string(retest.participants),
                        plain_figure(retest.mean, kCorrelationDecimals),
                        plain_range(retest.interval, kCorrelationDecimals)});
  table.notes = {
      {fmt::format("ICC(2,1) and ICC(2,k): absolute agreement about {} (Shrout and Fleiss 1979), "
                   "with the intervals of McGraw and Wong (1996), which are too narrow if "
                   "participants differ in variance. Read an estimate below 0 as 0.",
                   counted(agreement.items, "item"))},
      {"Repeats: ICC(1,1) of items by participant, averaged by Fisher's z, with a t interval over "
       "participants. It increases with the differences that a participant perceives between "
       "textures."}};
  return table;
}

std::string catches_sentence(const ScaleReport& scale) {
  const CatchComparison& catches = scale.catches;
  return fmt::format(
      "Catch trials have a picture but no texture. Textures were rated higher than these by {} {} "
      "({}); {} rated catch trials at least as high.",
      signed_plain_figure(catches.difference.mean, kRatingDecimals),
      plain_range(catches.difference.known_interval(), kRatingDecimals),
      counted(catches.difference.participants, "participant"),
      catches.not_lower == 0 ? "nobody" : std::to_string(catches.not_lower));
}

/// Calls `add` for each scale with ratings.
template <typename Add>
Section section_of_scales(const RatingReport& report, const char* id, const char* title, Add add) {
  Section section{id, title, {}};
  for (const ScaleReport& scale : report.scales) {
    if (scale.use.at_low.n > 0) add(scale, section);
  }
  return section;
}

}  // namespace

Section means_section(const RatingReport& report, bool has_figure) {
  return section_of_scales(
      report, "ratings", "Ratings", [&](const ScaleReport& scale, Section& section) {
        section.blocks.emplace_back(groups_table(report, scale));
        (has_figure ? section.folded_blocks : section.blocks)
            .emplace_back(scale_table(report, scale, "means", "Mean ratings over participants",
                                      scale.means.items, item_measures(report)));
      });
}

Section differences_section(const RatingReport& report) {
  return section_of_scales(report, "differences", "Differences between methods",
                           [&](const ScaleReport& scale, Section& section) {
                             if (scale.differences.empty()) return;
                             section.blocks.emplace_back(scale_table(
                                 report, scale, "differences-of-methods",
                                 "Ratings of the first method minus those of the second",
                                 scale.differences, difference_measures(report)));
                           });
}

Section reliability_section(const RatingReport& report) {
  return section_of_scales(report, "agreement", "Agreement",
                           [&](const ScaleReport& scale, Section& section) {
                             section.blocks.emplace_back(reliability_table(report, scale));
                           });
}

Section use_section(const RatingReport& report) {
  return section_of_scales(
      report, "use-of-scales", "Use of the scale", [&](const ScaleReport& scale, Section& section) {
        section.folded_blocks.emplace_back(
            scale_table(report, scale, "use-of-the-scale", "Use of the scale by participant",
                        people_indices(report), use_measures(report, scale)));
      });
}

Section catches_section(const RatingReport& report) {
  return section_of_scales(
      report, "catch", "Catch trials", [&](const ScaleReport& scale, Section& section) {
        if (scale.catches.participants.empty()) return;
        section.blocks.emplace_back(CitedText{catches_sentence(scale)});
        section.folded_blocks.emplace_back(
            scale_table(report, scale, "catch-trials", "Catch trials and textures",
                        scale.catches.participants, catch_measures(report)));
      });
}

}  // namespace touchtrial::analysis::rating
