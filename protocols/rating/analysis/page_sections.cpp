#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/rating/analysis/measures.hpp"
#include "protocols/rating/analysis/page.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

Table items_table(const RatingReport& report, const ScaleReport& scale) {
  return table_of(id_of(report, scale, "means"),
                  caption_of(report, scale, "Mean ratings over participants"), scale.means.items,
                  item_measures(report));
}

Table groups_table(const RatingReport& report, const ScaleReport& scale) {
  Table table = table_of(id_of(report, scale, "means-over-items"),
                         caption_of(report, scale, "Mean ratings by method, and by texture"),
                         scale.means.methods, group_measures("method", report.methods));
  std::ranges::move(
      table_of("", "", scale.means.classes, group_measures("class", report.classes)).rows,
      std::back_inserter(table.rows));
  table.notes = {
      {"n: participants who rated all items of the row; Student's interval.", {Source::student}}};
  return table;
}

Table differences_table(const RatingReport& report, const ScaleReport& scale) {
  return table_of(
      id_of(report, scale, "differences-of-methods"),
      caption_of(report, scale, "Ratings of the first method minus those of the second"),
      scale.differences, difference_measures(report));
}

void add_correlation(const std::string& name, const std::string& people,
                     const std::optional<IntraclassCorrelation>& one, Table& table) {
  table.rows.push_back(
      {name, people,
       plain_figure(one ? std::optional(one->estimate) : std::nullopt, kCorrelationDecimals),
       plain_range(one ? one->interval : std::nullopt, kCorrelationDecimals)});
}

Table reliability_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "reliability"),
              caption_of(report, scale, "Agreement about textures and methods"),
              {{"of", Align::left}, {"n"}, {"estimate"}, {"95%"}}};
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
                   "with the intervals of McGraw and Wong 1996, which assume equal variances of "
                   "participants and are too narrow otherwise. Read an estimate below 0 as 0.",
                   counted(agreement.items, "item"))},
      {"Repeats: each participant's own ICC(1,1) of items, averaged by Fisher's z, with a t "
       "interval over participants. It increases with the differences that a participant perceives "
       "between textures."}};
  return table;
}

Table use_table(const RatingReport& report, const ScaleReport& scale) {
  return table_of(id_of(report, scale, "use-of-the-scale"),
                  caption_of(report, scale, "Use of the scale by participant"), people_of(report),
                  use_measures(report, scale));
}

Table catches_table(const RatingReport& report, const ScaleReport& scale) {
  return table_of(id_of(report, scale, "catch-trials"),
                  caption_of(report, scale, "Catch trials and textures"),
                  scale.catches.participants, catch_measures(report));
}

std::string catches_sentence(const ScaleReport& scale) {
  const CatchComparison& catches = scale.catches;
  return fmt::format(
      "In catch trials there is a picture and nothing to feel. Textures were rated {} higher than "
      "these {} ({}); {} rated catch trials at least as high.",
      signed_plain_figure(catches.difference.mean, kRatingDecimals),
      plain_range(catches.difference.known_interval(), kRatingDecimals),
      counted(catches.difference.participants, "participant"),
      catches.not_lower == 0 ? "nobody" : std::to_string(catches.not_lower));
}

bool has_ratings(const ScaleReport& scale) {
  return scale.use.at_low.n > 0;
}

/// Adds blocks for each scale that was rated.
template <typename Add>
Section section_of_scales(const RatingReport& report, const char* id, const char* title, Add add) {
  Section section{id, title, {}};
  for (const ScaleReport& scale : report.scales) {
    if (has_ratings(scale)) add(scale, section);
  }
  return section;
}

}  // namespace

Section means_section(const RatingReport& report, bool drawn) {
  return section_of_scales(
      report, "ratings", "Ratings", [&](const ScaleReport& scale, Section& section) {
        section.blocks.emplace_back(groups_table(report, scale));
        (drawn ? section.more : section.blocks).emplace_back(items_table(report, scale));
      });
}

Section differences_section(const RatingReport& report) {
  return section_of_scales(report, "differences", "Differences between methods",
                           [&](const ScaleReport& scale, Section& section) {
                             if (scale.differences.empty()) return;
                             section.blocks.emplace_back(differences_table(report, scale));
                           });
}

Section reliability_section(const RatingReport& report) {
  return section_of_scales(report, "agreement", "Agreement",
                           [&](const ScaleReport& scale, Section& section) {
                             section.blocks.emplace_back(reliability_table(report, scale));
                           });
}

Section use_section(const RatingReport& report) {
  return section_of_scales(report, "use-of-scales", "Use of the scale",
                           [&](const ScaleReport& scale, Section& section) {
                             section.more.emplace_back(use_table(report, scale));
                           });
}

Section catches_section(const RatingReport& report) {
  return section_of_scales(report, "catch", "Catch trials",
                           [&](const ScaleReport& scale, Section& section) {
                             if (scale.catches.participants.empty()) return;
                             section.blocks.emplace_back(Cited{catches_sentence(scale)});
                             section.more.emplace_back(catches_table(report, scale));
                           });
}

}  // namespace touchtrial::analysis::rating
