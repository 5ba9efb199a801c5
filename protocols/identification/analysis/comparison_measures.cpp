// The numbers by which methods are compared.
#include "protocols/identification/analysis/measures.hpp"

#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

/// Whether all participants' differences are equal, which does not mean that they are certain.
bool are_alike(const MethodComparison& paired) {
  return paired.participants > 1 && !paired.known_interval();
}

/// Adds a difference between two methods over participants.
/// \param get  the MethodComparison of a row
template <typename Row, typename Get>
void add_comparison(Get get, MeasureList<Row>& all) {
  const auto of = [get](auto MethodComparison::*member) {
    return [get, member](const Row& row) { return get(row).*member; };
  };
  all.push_back(count_of<Row>("participants", "n", of(&MethodComparison::participants)));
  all.push_back(
      number_of<Row>("difference", "points", points_figure, of(&MethodComparison::difference)));
  all.push_back(interval_of<Row>("interval", "", share_range,
                                 [get](const Row& row) { return get(row).known_interval(); }));
  all.push_back(
      column_of<Row>("t 95%",
                     [get](const Row& row) {
                       const MethodComparison& one = get(row);
                       return share_range(one.known_interval()) + (are_alike(one) ? " *" : "");
                     })
          .with("Points: mean of participants' differences in percentage points, with Student's t "
                "interval and t. *: all participants have the same difference.",
                {Source::student}));
  all.push_back(column_of<Row>("t", [get](const Row& row) {
    const auto& statistic = get(row).statistic;
    return statistic ? t_phrase(*statistic) : kNoFigure;
  }));
  all.push_back(interval_of<Row>("bootstrap", "", share_range, of(&MethodComparison::bootstrap)));
  all.push_back(
      number_of<Row>("p", "sign-flip p", p_figure, of(&MethodComparison::p))
          .with("p: sign-flip permutation over participants, two-sided.", {Source::phipson_smyth}));
  all.push_back(number_of<Row>("db", "", decimals(2), of(&MethodComparison::db)));
  all.push_back(column_of<Row>("d_z, 95%",
                               [get](const Row& row) { return effect_figure(get(row).statistic); })
                    .with("d_z: the mean difference over its standard deviation between "
                          "participants, with the interval by noncentral t.",
                          {Source::cumming_finch}));
  all.push_back(member_of<Row>(
      "statistic", [get](const Row& row) { return statistic_json(get(row).statistic); }));
}

Json odds_ratio_json(const MethodPair& pair) {
  if (!pair.odds_ratio) return nullptr;
  const OddsRatio& ratio = *pair.odds_ratio;
  return with_method(
      {{"estimate", figure_json(ratio.estimate)},
       {"interval", interval_json(ratio.bootstrap)},
       {"interval_of_trials", interval_json(ratio.interval)}},
      "Mantel and Haenszel's common odds ratio, participants as strata; interval: expanded "
      "percentiles of 9,999 draws of participants; interval_of_trials: of Robins, Breslow "
      "and Greenland, which takes trials as independent",
      {"mantel1959", "robins1986", "davison1997", "hesterberg2015"});
}

/// The ratio with its interval over participants, or else that of independent trials, with a mark.
std::string odds_figure(const MethodPair& pair) {
  if (!pair.odds_ratio) return kNoFigure;
  const OddsRatio& odds = *pair.odds_ratio;
  return plain_figure(odds.estimate, 2) + " " +
         (odds.bootstrap ? plain_range(odds.bootstrap, 2) : plain_range(odds.interval, 2) + " †");
}

Json members_of_classes(const StudyReport& report, const MethodPair& pair) {
  std::vector<std::size_t> classes(pair.classes.size());
  std::iota(classes.begin(), classes.end(), 0U);
  return objects_of(classes, class_measures(report, pair));
}

Json proportion_json(const Proportion& proportion) {
  return object_of(proportion, trials_measures());
}

}  // namespace

MeasureList<MethodPair> pair_measures(const StudyReport& report) {
  using Row = MethodPair;
  const auto name = [&report](int Row::*which) {
    return [&report, which](const Row& pair) {
      return report.methods[static_cast<std::size_t>(pair.*which)].method;
    };
  };
  MeasureList<Row> all{
      column_of<Row>("difference",
                     [name](const Row& pair) {
                       return name(&Row::first)(pair) + " less " + name(&Row::second)(pair);
                     }),
      member_of<Row>("first", name(&Row::first)), member_of<Row>("second", name(&Row::second))};
  add_comparison<Row>([](const Row& pair) -> const MethodComparison& { return pair.overall; }, all);
  all.push_back(number_of<Row>("p_holm", "p, Holm", p_figure, &Row::p_holm)
                    .with("Holm: adjusted over all pairs of methods.", {Source::holm})
                    .if_known());
  all.push_back(member_of<Row>("odds_ratio", odds_ratio_json));
  all.push_back(
      column_of<Row>("odds ratio, 95%", odds_figure)
          .with("Odds ratio: common to participants, each a stratum; interval by bootstrap over "
                "participants, or, with few of them, (†) Robins, Breslow and Greenland's, which "
                "treats trials as independent and is too narrow.",
                {Source::mantel_haenszel, Source::davison_hinkley,
                 Source::robins_breslow_greenland}));
  all.push_back(number_of<Row>("mcnemar_mid_p", "", p_figure, &Row::mcnemar_mid_p));
  all.push_back(member_of<Row>(
      "classes", [&report](const Row& pair) { return members_of_classes(report, pair); }));
  return all;
}

MeasureList<std::size_t> class_measures(const StudyReport& report, const MethodPair& pair) {
  using Row = std::size_t;
  const auto of = [&pair](Row i) -> const ClassComparison& { return pair.classes[i]; };
  const auto name = [&](int method) {
    return report.methods[static_cast<std::size_t>(method)].method;
  };
  MeasureList<Row> all{
      label_of<Row>("class", "texture", [&report](Row i) { return report.classes[i]; }),
      member_of<Row>("first", [of](Row i) { return proportion_json(of(i).first); }),
      column_of<Row>(name(pair.first), [of](Row i) { return count_and_share(of(i).first); })
          .with("Counts pool all participants. p is not adjusted for the number of textures: "
                "descriptive only. Other columns: as in the table above."),
      member_of<Row>("second", [of](Row i) { return proportion_json(of(i).second); }),
      column_of<Row>(name(pair.second), [of](Row i) { return count_and_share(of(i).second); })};
  MeasureList<Row> compared;
  add_comparison<Row>([of](Row i) -> const MethodComparison& { return of(i).paired; }, compared);
  for (Measure<Row>& one : compared) {
    one.notes.clear();  // they stand under the table of all textures
    all.push_back(std::move(one));
  }
  all.push_back(
      number_of<Row>("mcnemar_mid_p", "", p_figure, [of](Row i) { return of(i).mcnemar_mid_p; }));
  return all;
}

}  // namespace touchtrial::analysis::identification
