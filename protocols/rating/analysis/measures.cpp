#include "protocols/rating/analysis/measures.hpp"

#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

using Json = nlohmann::ordered_json;

const std::string& named(const std::vector<std::string>& labels, int number) {
  return labels[static_cast<std::size_t>(number)];
}

Json d_z_json(const MethodDifference& difference) {
  if (!difference.standardised) return nullptr;
  const auto& jackknifed = difference.standardised->jackknifed;
  return {{"estimate", figure_json(difference.standardised->d_z)},
          {"interval", interval_json(difference.standardised->interval)},
          {"jackknife", jackknifed ? Json{{"estimate", figure_json(jackknifed->value)},
                                          {"interval", interval_json(jackknifed->interval)}}
                                   : Json(nullptr)}};
}

/// One p of a family of tests, if there is a test.
auto p_of(std::optional<FamilyP> MethodDifference::*test, double FamilyP::*which) {
  return [test, which](const MethodDifference& one) {
    return one.*test ? std::optional((*(one.*test)).*which) : std::nullopt;
  };
}

}  // namespace

std::optional<TStatistic> statistic_of(const MethodDifference& difference) {
  if (!difference.t || !difference.standardised) return {};
  return TStatistic{*difference.t, difference.difference.participants - 1,
                    difference.standardised->d_z, difference.standardised->interval};
}

std::vector<std::size_t> people_of(const RatingReport& report) {
  std::vector<std::size_t> people(report.people.size());
  std::iota(people.begin(), people.end(), 0U);
  return people;
}

MeasureList<ItemMean> item_measures(const RatingReport& report) {
  using Row = ItemMean;
  MeasureList<Row> all{
      label_of<Row>("class", "texture",
                    [&](const Row& one) { return named(report.classes, one.item.texture_class); }),
      label_of<Row>("method", "method",
                    [&](const Row& one) { return named(report.methods, one.item.method); })};
  add_mean<Row>(kRatingDecimals, &Row::mean, all);
  all.back().notes = {
      {"n: participants with a rating, each with the mean of the own repeats; "
       "Student's interval, cut to the scale.",
       {Source::student}}};
  return all;
}

MeasureList<GroupMean> group_measures(const std::string& member,
                                      const std::vector<std::string>& labels) {
  using Row = GroupMean;
  MeasureList<Row> all{
      label_of<Row>(member, "mean over",
                    [&labels, member](const Row& one) { return named(labels, one.group); }),
      count_of<Row>("items", "items", &Row::items)};
  add_mean<Row>(kRatingDecimals, &Row::mean, all);
  return all;
}

MeasureList<MethodDifference> difference_measures(const RatingReport& report) {
  using Row = MethodDifference;
  const auto shown = [](const Row& one) {
    const auto statistic = statistic_of(one);
    return statistic ? t_phrase(*statistic) : kNoFigure;
  };
  return {
      label_of<Row>("first", "first",
                    [&](const Row& one) { return named(report.methods, one.first); }),
      label_of<Row>("second", "second",
                    [&](const Row& one) { return named(report.methods, one.second); }),
      member_of<Row>("classes", &Row::classes),
      count_of<Row>("participants", "n", [](const Row& one) { return one.difference.participants; })
          .with("n: participants who rated every texture by both methods; each counts with one "
                "difference, the mean over textures."),
      number_of<Row>("difference", "difference", signed_decimals(kRatingDecimals),
                     [](const Row& one) { return one.difference.mean; }),
      interval_of<Row>("interval", "t 95%", range_decimals(kRatingDecimals),
                       [](const Row& one) { return one.difference.known_interval(); }),
      number_of<Row>("sd", "", decimals(kRatingDecimals),
                     [](const Row& one) { return one.difference.sd; }),
      column_of<Row>("t", shown),
      number_of<Row>("p", "p", p_figure, p_of(&Row::sign_flip, &FamilyP::p))
          .with("p: exact sign flips of participants' differences, two-sided; by Holm: adjusted "
                "over all pairs.",
                {Source::student, Source::holm}),
      number_of<Row>("p_holm", "p by Holm", p_figure, p_of(&Row::sign_flip, &FamilyP::holm)),
      number_of<Row>("t", "", decimals(kRatingDecimals), &Row::t),
      number_of<Row>("t_p", "", p_figure, p_of(&Row::t_test, &FamilyP::p)),
      number_of<Row>("t_p_holm", "", p_figure, p_of(&Row::t_test, &FamilyP::holm)),
      column_of<Row>("d_z, 95%", [](const Row& one) { return effect_figure(statistic_of(one)); })
          .with("d_z: mean difference over its SD between participants; few participants make it "
                "too large. Interval by noncentral t, which assumes normal differences.",
                {Source::cumming_finch}),
      member_of<Row>("d_z", d_z_json)};
}

MeasureList<std::size_t> use_measures(const RatingReport& report, const ScaleReport& scale) {
  using Row = std::size_t;
  const auto use = [&scale](auto get) {
    return [&scale, get](Row i) { return std::invoke(get, scale.use.participants[i]); };
  };
  const auto share_at = [](Proportion ScaleUse::*end) {
    return [end](const ScaleUse& one) { return share_figure((one.*end).share()); };
  };
  return {
      label_of<Row>("participant", "participant", [&](Row i) { return report.people[i]; }),
      count_of<Row>("n", "n", use([](const ScaleUse& one) { return one.at_low.n; }))
          .with(fmt::format("Over all scored answers. SD: emphasised below {:.0f} % of the scale's "
                            "length. Values: different ones. Scatter: SD of what is left of the "
                            "means of items without the means of participant and item. Repeats: "
                            "the participant's own ICC(1,1).",
                            100.0 * kNarrowUse)),
      member_of<Row>("at_low", use([](const ScaleUse& one) { return one.at_low.correct; })),
      member_of<Row>("at_high", use([](const ScaleUse& one) { return one.at_high.correct; })),
      number_of<Row>("mean", "mean", decimals(kRatingDecimals), use(&ScaleUse::mean)),
      number_of<Row>("sd", "", decimals(kRatingDecimals), use(&ScaleUse::sd)),
      column_of<Row>("SD", use([](const ScaleUse& one) {
                       return Cell(plain_figure(one.sd, kRatingDecimals), one.narrow);
                     })),
      count_of<Row>("distinct", "values", use(&ScaleUse::distinct)),
      column_of<Row>("at low end", use(share_at(&ScaleUse::at_low))),
      column_of<Row>("at high end", use(share_at(&ScaleUse::at_high))),
      member_of<Row>("narrow", use(&ScaleUse::narrow)),
      number_of<Row>("scatter", "scatter", decimals(kRatingDecimals),
                     [&](Row i) { return scale.scatter[i]; }),
      number_of<Row>("retest", "repeats", decimals(kCorrelationDecimals),
                     [&](Row i) { return scale.retest.own[i]; })};
}

MeasureList<CatchRating> catch_measures(const RatingReport& report) {
  using Row = CatchRating;
  return {label_of<Row>("participant", "participant",
                        [&](const Row& one) { return named(report.people, one.participant); }),
          number_of<Row>("catch", "catch trials", decimals(kRatingDecimals), &Row::catches),
          number_of<Row>("scored", "textures", decimals(kRatingDecimals), &Row::scored),
          number_of<Row>("", "difference", signed_decimals(kRatingDecimals),
                         [](const Row& one) { return std::optional(one.scored - one.catches); })};
}

}  // namespace touchtrial::analysis::rating
