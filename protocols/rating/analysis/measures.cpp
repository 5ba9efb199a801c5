#include "protocols/rating/analysis/measures.hpp"

#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

using Json = nlohmann::ordered_json;

const std::string& label_at(const std::vector<std::string>& labels, int number) {
  return labels[static_cast<std::size_t>(number)];
}

Json d_z_json(const MethodDifference& difference) {
  if (!difference.standardised) return nullptr;
  const auto& jackknife_estimate = difference.standardised->jackknife_estimate;
  return {{"estimate", figure_json(difference.standardised->d_z)},
          {"interval", interval_json(difference.standardised->interval)},
          {"jackknife", jackknife_estimate
                            ? Json{{"estimate", figure_json(jackknife_estimate->value)},
                                   {"interval", interval_json(jackknife_estimate->interval)}}
                            : Json(nullptr)}};
}

/// p or adjusted p of a test, if there is one.
auto p_of(std::optional<FamilyP> MethodDifference::*test, double FamilyP::*kind) {
  return [test, kind](const MethodDifference& pair) {
    return pair.*test ? std::optional((*(pair.*test)).*kind) : std::nullopt;
  };
}

}  // namespace

std::optional<TStatistic> statistic_of(const MethodDifference& difference) {
  if (!difference.t || !difference.standardised) return {};
  return TStatistic{*difference.t, difference.difference.participants - 1,
                    difference.standardised->d_z, difference.standardised->interval};
}

std::vector<std::size_t> people_indices(const RatingReport& report) {
  std::vector<std::size_t> people(report.people.size());
  std::iota(people.begin(), people.end(), 0U);
  return people;
}

MeasureList<ItemMean> item_measures(const RatingReport& report) {
  using Row = ItemMean;
  MeasureList<Row> all{label_of<Row>("class", "texture",
                                     [&](const Row& row) {
                                       return label_at(report.classes, row.item.texture_class);
                                     }),
                       label_of<Row>("method", "method", [&](const Row& row) {
                         return label_at(report.methods, row.item.method);
                       })};
  add_mean<Row>(kRatingDecimals, &Row::mean, all);
  all.back().notes = {
      {"n: participants with a rating, each with the mean of their repeats; Student's interval, "
       "truncated to the scale.",
       {Source::student}}};
  return all;
}

MeasureList<GroupMean> group_measures(const std::string& member,
                                      const std::vector<std::string>& labels) {
  using Row = GroupMean;
  MeasureList<Row> all{
      label_of<Row>(member, "mean over",
                    [&labels, member](const Row& row) { return label_at(labels, row.group); }),
      count_of<Row>("items", "items", &Row::items)};
  add_mean<Row>(kRatingDecimals, &Row::mean, all);
  return all;
}

MeasureList<MethodDifference> difference_measures(const RatingReport& report) {
  using Row = MethodDifference;
  const auto t_words = [](const Row& row) {
    const auto statistic = statistic_of(row);
    return statistic ? t_phrase(*statistic) : kNoFigure;
  };
  return {
      label_of<Row>("first", "first",
                    [&](const Row& row) { return label_at(report.methods, row.first); }),
      label_of<Row>("second", "second",
                    [&](const Row& row) { return label_at(report.methods, row.second); }),
      member_of<Row>("classes", &Row::classes),
      count_of<Row>("participants", "n", [](const Row& row) { return row.difference.participants; })
          .with_note("n: participants who rated every texture with both methods; each has one "
                     "difference, the mean over textures."),
      number_of<Row>("difference", "difference", signed_decimals(kRatingDecimals),
                     [](const Row& row) { return row.difference.mean; }),
      interval_of<Row>("interval", "t 95%", range_decimals(kRatingDecimals),
                       [](const Row& row) { return row.difference.known_interval(); }),
      number_of<Row>("sd", "", decimals(kRatingDecimals),
                     [](const Row& row) { return row.difference.sd; }),
      column_of<Row>("t", t_words),
      number_of<Row>("p", "p", p_figure, p_of(&Row::sign_flip, &FamilyP::p))
          .with_note(
              "p: exact sign flips of participants' differences, two-sided; by Holm: adjusted "
              "over all pairs.",
              {Source::student, Source::holm}),
      number_of<Row>("p_holm", "p by Holm", p_figure, p_of(&Row::sign_flip, &FamilyP::holm)),
      number_of<Row>("t", "", decimals(kRatingDecimals), &Row::t),
      number_of<Row>("t_p", "", p_figure, p_of(&Row::t_test, &FamilyP::p)),
      number_of<Row>("t_p_holm", "", p_figure, p_of(&Row::t_test, &FamilyP::holm)),
      column_of<Row>("d_z, 95%", [](const Row& row) { return effect_figure(statistic_of(row)); })
          .with_note(
              "d_z: mean difference over its SD between participants, biased upward with few "
              "participants. Interval by noncentral t, which assumes normal differences.",
              {Source::cumming_finch}),
      member_of<Row>("d_z", d_z_json)};
}

MeasureList<std::size_t> use_measures(const RatingReport& report, const ScaleReport& scale) {
  using Row = std::size_t;
  const auto use = [&scale](auto get) {
    return [&scale, get](Row i) { return std::invoke(get, scale.use.participants[i]); };
  };
  const auto share_at = [](Proportion ScaleUse::*end) {
    return [end](const ScaleUse& answers) { return share_figure((answers.*end).share()); };
  };
  return {
      label_of<Row>("participant", "participant", [&](Row i) { return report.people[i]; }),
      count_of<Row>("n", "n", use([](const ScaleUse& answers) { return answers.at_low.n; }))
          .with_note(
              fmt::format("Over all scored answers. SD: emphasised below {:.0f}% of the scale's "
                          "length. Values: number of distinct ones. Scatter: SD of means of items "
                          "without the effects of participant and item. Repeats: the participant's "
                          "ICC(1,1).",
                          100.0 * kNarrowUse)),
      member_of<Row>("at_low", use([](const ScaleUse& answers) { return answers.at_low.correct; })),
      member_of<Row>("at_high",
                     use([](const ScaleUse& answers) { return answers.at_high.correct; })),
      number_of<Row>("mean", "mean", decimals(kRatingDecimals), use(&ScaleUse::mean)),
      number_of<Row>("sd", "", decimals(kRatingDecimals), use(&ScaleUse::sd)),
      column_of<Row>("SD", use([](const ScaleUse& answers) {
                       return Cell(plain_figure(answers.sd, kRatingDecimals), answers.is_narrow);
                     })),
      count_of<Row>("distinct", "values", use(&ScaleUse::distinct)),
      column_of<Row>("at low end", use(share_at(&ScaleUse::at_low))),
      column_of<Row>("at high end", use(share_at(&ScaleUse::at_high))),
      member_of<Row>("narrow", use(&ScaleUse::is_narrow)),
      number_of<Row>("scatter", "scatter", decimals(kRatingDecimals),
                     [&](Row i) { return scale.scatter[i]; }),
      number_of<Row>("retest", "repeats", decimals(kCorrelationDecimals),
                     [&](Row i) { return scale.retest.correlations[i]; })};
}

MeasureList<CatchRating> catch_measures(const RatingReport& report) {
  using Row = CatchRating;
  return {label_of<Row>("participant", "participant",
                        [&](const Row& row) { return label_at(report.people, row.participant); }),
          number_of<Row>("catch", "catch trials", decimals(kRatingDecimals), &Row::catches),
          number_of<Row>("scored", "textures", decimals(kRatingDecimals), &Row::scored),
          number_of<Row>("", "difference", signed_decimals(kRatingDecimals),
                         [](const Row& row) { return std::optional(row.scored - row.catches); })};
}

}  // namespace touchtrial::analysis::rating
