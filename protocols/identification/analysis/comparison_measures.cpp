// Measures of comparisons between methods.
#include "protocols/identification/analysis/measures.hpp"

#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

/// Adds a difference between two methods over participants.
/// \param get  the MethodComparison of a row
template <typename Row, typename Get>
void add_comparison(Get get, MeasureList<Row>& all) {
  const auto member_getter = [get](auto MethodComparison::*member) {
    return [get, member](const Row& row) { return get(row).*member; };
  };
  all.push_back(count_of<Row>("participants", "n", member_getter(&MethodComparison::participants)));
  all.push_back(number_of<Row>("difference", "points", points_figure,
                               member_getter(&MethodComparison::difference)));
  all.push_back(interval_of<Row>("interval", "", share_range,
                                 [get](const Row& row) { return get(row).known_interval(); }));
  all.push_back(
      column_of<Row>("t 95%",
                     [get](const Row& row) {
                       const MethodComparison& comparison = get(row);
                       return share_range(comparison.known_interval()) +
                              (comparison.participants > 1 && !comparison.known_interval() ? " *"
                                                                                           : "");
                     })
          .with_note(
              "Points: mean of participants' differences in percentage points, with Student's t "
              "interval and t. *: all participants have the same difference.",
              {Source::student}));
  all.push_back(column_of<Row>("t", [get](const Row& row) {
    const auto& statistic = get(row).statistic;
    return statistic ? t_phrase(*statistic) : kNoFigure;
  }));
  all.push_back(
      interval_of<Row>("bootstrap", "", share_range, member_getter(&MethodComparison::bootstrap)));
  all.push_back(number_of<Row>("p", "sign-flip p", p_figure, member_getter(&MethodComparison::p))
                    .with_note("p: sign-flip permutation over participants, two-sided.",
                               {Source::phipson_smyth}));
  all.push_back(number_of<Row>("db", "", decimals(2), member_getter(&MethodComparison::db)));
  all.push_back(column_of<Row>("d_z, 95%",
                               [get](const Row& row) { return effect_figure(get(row).statistic); })
                    .with_note("d_z: the mean difference over its standard deviation between "
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
      "Mantel-Haenszel common odds ratio, participants as strata; interval: expanded percentiles "
      "of 9,999 bootstrap samples of participants; interval_of_trials: Robins-Breslow-Greenland, "
      "which treats trials as independent",
      {"mantel1959", "robins1986", "davison1997", "hesterberg2015"});
}

/// The ratio with its interval over participants, or with a mark and the interval of independent
/// trials.
std::string odds_figure(const MethodPair& pair) {
  if (!pair.odds_ratio) return kNoFigure;
  const OddsRatio& odds = *pair.odds_ratio;
  return plain_figure(odds.estimate, 2) + " " +
         (odds.bootstrap ? plain_range(odds.bootstrap, 2) : plain_range(odds.interval, 2) + " †");
}

Json classes_json(const StudyReport& report, const MethodPair& pair) {
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
  const auto name = [&report](int Row::*method_member) {
    return [&report, method_member](const Row& pair) {
      return report.methods[static_cast<std::size_t>(pair.*method_member)].method;
    };
  };
  MeasureList<Row> all{
      column_of<Row>("difference",
                     [name](const Row& pair) {
                       return name(&Row::first)(pair) + " minus " + name(&Row::second)(pair);
                     }),
      member_of<Row>("first", name(&Row::first)), member_of<Row>("second", name(&Row::second))};
  add_comparison<Row>([](const Row& pair) -> const MethodComparison& { return pair.overall; }, all);
  all.push_back(number_of<Row>("p_holm", "p, Holm", p_figure, &Row::p_holm)
                    .with_note("Holm: adjusted over all pairs of methods.", {Source::holm})
                    .hidden_if_unknown());
  all.push_back(member_of<Row>("odds_ratio", odds_ratio_json));
  all.push_back(
      column_of<Row>("odds ratio, 95%", odds_figure)
          .with_note(
              "Odds ratio: Mantel-Haenszel, with participants as strata; interval by bootstrap "
              "over participants, or with few of them (†) by Robins, Breslow and Greenland, which "
              "treats trials as independent and is too narrow.",
              {Source::mantel_haenszel, Source::davison_hinkley,
               Source::robins_breslow_greenland}));
  all.push_back(number_of<Row>("mcnemar_mid_p", "", p_figure, &Row::mcnemar_mid_p));
  all.push_back(
      member_of<Row>("classes", [&report](const Row& pair) { return classes_json(report, pair); }));
  return all;
}

MeasureList<std::size_t> class_measures(const StudyReport& report, const MethodPair& pair) {
  using Row = std::size_t;
  const auto comparison_of = [&pair](Row i) -> const ClassComparison& { return pair.classes[i]; };
  const auto name = [&](int method) {
    return report.methods[static_cast<std::size_t>(method)].method;
  };
  MeasureList<Row> all{
      label_of<Row>("class", "texture", [&report](Row i) { return report.classes[i]; }),
      member_of<Row>("first",
                     [comparison_of](Row i) { return proportion_json(comparison_of(i).first); }),
      column_of<Row>(name(pair.first),
                     [comparison_of](Row i) { return count_and_share(comparison_of(i).first); })
          .with_note("Counts pool all participants. p is not adjusted for the number of textures: "
                     "descriptive only. Other columns: as in the table above."),
      member_of<Row>("second",
                     [comparison_of](Row i) { return proportion_json(comparison_of(i).second); }),
      column_of<Row>(name(pair.second),
                     [comparison_of](Row i) { return count_and_share(comparison_of(i).second); })};
  MeasureList<Row> comparisons;
  add_comparison<Row>(
      [comparison_of](Row i) -> const MethodComparison& { return comparison_of(i).comparison; },
      comparisons);
  for (Measure<Row>& measure : comparisons) {
    measure.notes.clear();  // already below the table of all textures
    all.push_back(std::move(measure));
  }
  all.push_back(number_of<Row>("mcnemar_mid_p", "", p_figure,
                               [comparison_of](Row i) { return comparison_of(i).mcnemar_mid_p; }));
  return all;
}

}  // namespace touchtrial::analysis::identification
