#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/rating/analysis/page.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

constexpr int kCorrelationDecimals = 2;

std::string class_of(const RatingReport& report, int number) {
  return report.classes[static_cast<std::size_t>(number)];
}

std::string method_of(const RatingReport& report, int number) {
  return report.methods[static_cast<std::size_t>(number)];
}

/// n, mean, interval and SD.
void add_mean(std::vector<Cell>& row, const MeanEstimate& mean) {
  row.emplace_back(std::to_string(mean.participants));
  row.emplace_back(plain_figure(mean.mean, kRatingDecimals));
  row.emplace_back(plain_range(mean.known_interval(), kRatingDecimals));
  row.emplace_back(plain_figure(mean.sd, kRatingDecimals));
}

Table items_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{
      id_of(report, scale, "means"),
      caption_of(report, scale, "Mean ratings over participants"),
      {{"texture", Align::left}, {"method", Align::left}, {"n"}, {"mean"}, {"t 95%"}, {"SD"}}};
  for (const ItemMean& one : scale.means.items) {
    std::vector<Cell>& row = table.rows.emplace_back(std::vector<Cell>{
        class_of(report, one.item.texture_class), method_of(report, one.item.method)});
    add_mean(row, one.mean);
  }
  table.notes = {
      {"n: participants with a rating. Each counts with the mean of the own repeats."},
      {"The interval is Student's, over participants, cut to the scale.", {Source::student}}};
  return table;
}

Table groups_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "means-over-items"),
              caption_of(report, scale, "Mean ratings by method, and by texture"),
              {{"over all of", Align::left}, {"items"}, {"n"}, {"mean"}, {"t 95%"}, {"SD"}}};
  const auto add = [&](const std::string& name, const GroupMean& one) {
    std::vector<Cell>& row =
        table.rows.emplace_back(std::vector<Cell>{name, std::to_string(one.items)});
    add_mean(row, one.mean);
  };
  for (const GroupMean& one : scale.means.methods) {
    add("method " + method_of(report, one.group), one);
  }
  for (const GroupMean& one : scale.means.classes) {
    add("texture " + class_of(report, one.group), one);
  }
  table.notes = {{"n: participants who rated all items of the row."}};
  return table;
}

Table differences_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{
      id_of(report, scale, "differences-of-methods"),
      caption_of(report, scale, "How much higher the first method is rated than the second"),
      {{"first", Align::left},
       {"second", Align::left},
       {"n"},
       {"difference"},
       {"t 95%"},
       {"SD"},
       {"p"},
       {"p by Holm"},
       {"p of t"}}};
  for (const MethodDifference& one : scale.differences) {
    const auto p_of = [](const std::optional<FamilyP>& test, double FamilyP::*which) {
      return p_figure(test ? std::optional((*test).*which) : std::nullopt);
    };
    table.rows.push_back({method_of(report, one.first), method_of(report, one.second),
                          std::to_string(one.difference.participants),
                          signed_plain_figure(one.difference.mean, kRatingDecimals),
                          plain_range(one.difference.known_interval(), kRatingDecimals),
                          plain_figure(one.difference.sd, kRatingDecimals),
                          p_of(one.sign_flip, &FamilyP::p), p_of(one.sign_flip, &FamilyP::holm),
                          p_of(one.t_test, &FamilyP::p)});
  }
  table.notes = {{"n: participants who rated every texture by both methods; each counts with one "
                  "difference, the mean over textures."},
                 {"p: exact sign flips of participants' differences, two-sided; by Holm: adjusted "
                  "over all pairs. p of t: Student's t test, two-sided, not adjusted.",
                  {Source::student, Source::holm}}};
  return table;
}

Table sizes_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "sizes-of-differences"),
              caption_of(report, scale, "Differences in units of participants' SD of them"),
              {{"first", Align::left},
               {"second", Align::left},
               {"d_z"},
               {"noncentral t 95%"},
               {"jackknife"},
               {"jackknife 95%"}}};
  for (const MethodDifference& one : scale.differences) {
    const auto& size = one.standardised;
    std::optional<double> estimate;
    std::optional<Interval> range;
    if (size && size->jackknifed) {
      estimate = size->jackknifed->value;
      range = size->jackknifed->interval;
    }
    table.rows.push_back(
        {method_of(report, one.first), method_of(report, one.second),
         signed_plain_figure(size ? std::optional(size->d_z) : std::nullopt, kRatingDecimals),
         plain_range(size ? size->interval : std::nullopt, kRatingDecimals),
         signed_plain_figure(estimate, kRatingDecimals), plain_range(range, kRatingDecimals)});
  }
  table.notes = {
      {"d_z: mean difference over its SD between participants; few participants make it too large. "
       "The interval by noncentral t (Cumming and Finch 2001) assumes normal differences, that by "
       "jackknife does not.",
       {Source::miller_jackknife}}};
  return table;
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
  add_correlation("one participant with another: ICC(2,1)", people, agreement.single, table);
  add_correlation("means of as many participants: ICC(2,k)", people, agreement.average, table);
  const RetestReliability& retest = scale.retest;
  table.rows.push_back({"a participant's repeats: ICC(1,1)", std::to_string(retest.participants),
                        plain_figure(retest.mean, kCorrelationDecimals),
                        plain_range(retest.interval, kCorrelationDecimals)});
  table.notes = {
      {fmt::format("ICC(2,1) and ICC(2,k): absolute agreement about {} (Shrout and Fleiss 1979), "
                   "with the intervals of McGraw and Wong 1996, which assume that participants "
                   "scatter alike: if some scatter much more, they are too narrow. An estimate "
                   "below 0 means 0.",
                   counted(agreement.items, "item"))},
      {"Repeats: each participant's own ICC(1,1) of items, averaged by Fisher's z, with a t "
       "interval over participants. It is the larger, the more textures differ to a participant."}};
  return table;
}

Table use_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "use-of-the-scale"),
              caption_of(report, scale, "What each participant makes of the scale"),
              {{"participant", Align::left},
               {"n"},
               {"mean"},
               {"SD"},
               {"values"},
               {"at low end"},
               {"at high end"},
               {"scatter"},
               {"repeats"}}};
  for (std::size_t i = 0; i < report.people.size(); ++i) {
    const ScaleUse& one = scale.use.participants[i];
    table.rows.push_back({report.people[i],
                          std::to_string(one.at_low.n),
                          plain_figure(one.mean, kRatingDecimals),
                          {plain_figure(one.sd, kRatingDecimals), one.narrow},
                          std::to_string(one.distinct),
                          share_figure(one.at_low.share()),
                          share_figure(one.at_high.share()),
                          plain_figure(scale.scatter[i], kRatingDecimals),
                          plain_figure(scale.retest.own[i], kCorrelationDecimals)});
  }
  table.notes = {{fmt::format(
      "Over all scored answers. SD: emphasised below {:.0f} % of the scale's length. Values: "
      "different ones. Scatter: SD of what is left of the means of items without the means of "
      "participant and item. Repeats: the participant's own ICC(1,1).",
      100.0 * kNarrowUse)}};
  return table;
}

Table catches_table(const RatingReport& report, const ScaleReport& scale) {
  Table table{id_of(report, scale, "catch-trials"),
              caption_of(report, scale, "Catch trials and textures"),
              {{"participant", Align::left}, {"catch trials"}, {"textures"}, {"difference"}}};
  for (const CatchRating& one : scale.catches.participants) {
    table.rows.push_back({report.people[static_cast<std::size_t>(one.participant)],
                          plain_figure(one.catches, kRatingDecimals),
                          plain_figure(one.scored, kRatingDecimals),
                          signed_plain_figure(one.scored - one.catches, kRatingDecimals)});
  }
  return table;
}

std::string catches_sentence(const ScaleReport& scale) {
  const CatchComparison& catches = scale.catches;
  return fmt::format(
      "In catch trials there is a picture and nothing to feel. Textures were rated {} higher than "
      "these {} ({}); {} of them rated catch trials at least as high.",
      signed_plain_figure(catches.difference.mean, kRatingDecimals),
      plain_range(catches.difference.known_interval(), kRatingDecimals),
      counted(catches.difference.participants, "participant"), catches.not_lower);
}

bool has_ratings(const ScaleReport& scale) {
  return scale.use.at_low.n > 0;
}

/// Adds blocks for each scale that was rated.
template <typename Add>
Section section_of_scales(const RatingReport& report, const char* id, const char* title, Add add) {
  Section section{id, title, {}};
  for (const ScaleReport& scale : report.scales) {
    if (has_ratings(scale)) add(scale, section.blocks);
  }
  return section;
}

}  // namespace

Section means_section(const RatingReport& report) {
  return section_of_scales(report, "ratings", "Ratings",
                           [&](const ScaleReport& scale, std::vector<Block>& blocks) {
                             blocks.emplace_back(items_table(report, scale));
                             blocks.emplace_back(groups_table(report, scale));
                           });
}

Section differences_section(const RatingReport& report) {
  return section_of_scales(report, "differences", "Differences between methods",
                           [&](const ScaleReport& scale, std::vector<Block>& blocks) {
                             if (scale.differences.empty()) return;
                             blocks.emplace_back(differences_table(report, scale));
                             blocks.emplace_back(sizes_table(report, scale));
                           });
}

Section reliability_section(const RatingReport& report) {
  return section_of_scales(report, "agreement", "Agreement",
                           [&](const ScaleReport& scale, std::vector<Block>& blocks) {
                             blocks.emplace_back(reliability_table(report, scale));
                           });
}

Section use_section(const RatingReport& report) {
  return section_of_scales(report, "use-of-scales", "Use of the scale",
                           [&](const ScaleReport& scale, std::vector<Block>& blocks) {
                             blocks.emplace_back(use_table(report, scale));
                           });
}

Section catches_section(const RatingReport& report) {
  return section_of_scales(report, "catch", "Catch trials",
                           [&](const ScaleReport& scale, std::vector<Block>& blocks) {
                             if (scale.catches.participants.empty()) return;
                             blocks.emplace_back(Cited{catches_sentence(scale)});
                             blocks.emplace_back(catches_table(report, scale));
                           });
}

}  // namespace touchtrial::analysis::rating
