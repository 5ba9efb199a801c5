#include "protocols/identification/analysis/measures.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

/// Whether all participants' differences are equal, which does not mean that they are certain.
bool are_alike(const MethodComparison& paired) {
  return paired.participants > 1 && !paired.known_interval();
}

/// What two methods differ in, over participants.
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
      shown_of<Row>("t 95%",
                    [get](const Row& row) {
                      const MethodComparison& one = get(row);
                      return share_range(one.known_interval()) + (are_alike(one) ? " *" : "");
                    })
          .with("Mean of participants' differences in percentage points, with Student's t "
                "interval and t. *: every participant has the same difference, so that "
                "nothing shows how certain it is.",
                {Source::student}));
  all.push_back(shown_of<Row>("t", [get](const Row& row) {
    const auto& statistic = get(row).statistic;
    return statistic ? t_phrase(*statistic) : kNoFigure;
  }));
  all.push_back(interval_of<Row>("bootstrap", "", share_range, of(&MethodComparison::bootstrap)));
  all.push_back(
      number_of<Row>("p", "sign-flip p", p_figure, of(&MethodComparison::p))
          .with("p: sign-flip permutation over participants, two-sided.", {Source::phipson_smyth}));
  all.push_back(number_of<Row>("db", "", decimals(2), of(&MethodComparison::db)));
  all.push_back(
      shown_of<Row>("d_z, 95%", [get](const Row& row) { return effect_figure(get(row).statistic); })
          .with("d_z: the mean difference over its standard deviation between "
                "participants, with the interval by noncentral t.",
                {Source::cumming_finch}));
  all.push_back(kept_of<Row>("statistic",
                             [get](const Row& row) { return statistic_json(get(row).statistic); }));
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

std::string spread_figure(const std::optional<Spread>& spread) {
  if (!spread) return kNoFigure;
  return plain_figure(100.0 * spread->estimate, 1) + " " + share_range(spread->interval);
}

/// The limits of d' over participants, or else those of independent trials, with a mark.
std::string bound_of(const MethodReport& method) {
  const auto& over_people = method.d_prime_over_participants;
  const DPrime& of = over_people ? *over_people : method.d_prime;
  const std::string mark = over_people ? "" : " *";
  if (!of.estimate && !of.low && !of.high) return kNoFigure + mark;
  if (!of.low) return "up to " + plain_figure(of.high, 2) + mark;
  if (!of.high) return "at least " + plain_figure(of.low, 2) + mark;
  return plain_range(Interval{*of.low, *of.high}, 2) + mark;
}

Json members_of_classes(const StudyReport& report, const MethodPair& pair) {
  std::vector<std::size_t> classes(pair.classes.size());
  std::iota(classes.begin(), classes.end(), 0U);
  return objects_of(classes, class_measures(report, pair));
}

Json proportion_json(const Proportion& proportion) {
  Json object;
  put_proportion(object, proportion);
  return object;
}

}  // namespace

std::string count_and_share(const Proportion& of) {
  return of.n == 0 ? kNoFigure
                   : fmt::format("{}/{} {}", of.correct, of.n, share_figure(of.share()));
}

MeasureList<MethodReport> headline_measures(const StudyReport& report) {
  using Row = MethodReport;
  return {
      label_of<Row>("", "method", &Row::method),
      count_of<Row>("", "participants", [](const Row& one) { return one.mean.participants; }),
      count_of<Row>("", "trials", [](const Row& one) { return one.overall.n; }),
      shown_of<Row>("mean", [](const Row& one) { return Cell(share_figure(one.mean.mean), true); }),
      interval_of<Row>("", "t 95% (%)", share_range,
                       [](const Row& one) { return one.mean.known_interval(); })
          .with(fmt::format("Each participant weighs the same; a trial without a response counts "
                            "as wrong; chance is {}. t: Student's interval of the mean.",
                            share_figure(1.0 / static_cast<double>(report.classes.size()))),
                {Source::student}),
      shown_of<Row>("SD between (points)", [](const Row& one) { return spread_figure(one.spread); })
          .with("SD between: of participants' own probabilities of a right answer, without what a "
                "limited number of trials adds by chance, with its 95% interval.",
                {Source::paule_mandel, Source::viechtbauer}),
      number_of<Row>("", "d′", decimals(2), [](const Row& one) { return one.d_prime.estimate; })
          .with("d′ is what an unbiased observer of as many equally distant textures would need "
                "for this accuracy; a bound in place of infinity; interval by bootstrap over "
                "participants, or (*) from that of independent trials, if there are fewer than "
                "six participants or they do not differ.",
                {Source::hacker_ratcliff, Source::davison_hinkley, Source::clopper_pearson}),
      shown_of<Row>("d′ 95%", bound_of),
      number_of<Row>("", "information (bit)", decimals(2),
                     [](const Row& one) { return one.information.corrected; })
          .with("Information transfer, less Miller and Madow's bias.",
                {Source::tan_reed_durlach, Source::miller})};
}

MeasureList<MethodPair> pair_measures(const StudyReport& report) {
  using Row = MethodPair;
  const auto name = [&report](int Row::*which) {
    return [&report, which](const Row& pair) {
      return report.methods[static_cast<std::size_t>(pair.*which)].method;
    };
  };
  MeasureList<Row> all{
      shown_of<Row>("difference",
                    [name](const Row& pair) {
                      return name(&Row::first)(pair) + " less " + name(&Row::second)(pair);
                    }),
      kept_of<Row>("first", name(&Row::first)), kept_of<Row>("second", name(&Row::second))};
  add_comparison<Row>([](const Row& pair) -> const MethodComparison& { return pair.overall; }, all);
  all.push_back(number_of<Row>("p_holm", "p, Holm", p_figure, &Row::p_holm)
                    .with("Holm: adjusted over all pairs of methods.", {Source::holm})
                    .if_known());
  all.push_back(kept_of<Row>("odds_ratio", odds_ratio_json));
  all.push_back(
      shown_of<Row>("odds ratio, 95%", odds_figure)
          .with("Odds ratio: common to participants, each a stratum; interval by bootstrap over "
                "participants, or (†) Robins, Breslow and Greenland's, which treats trials as "
                "independent and is too narrow, if there are fewer than six participants, or too "
                "few who err.",
                {Source::mantel_haenszel, Source::davison_hinkley,
                 Source::robins_breslow_greenland}));
  all.push_back(number_of<Row>("mcnemar_mid_p", "", p_figure, &Row::mcnemar_mid_p));
  all.push_back(kept_of<Row>(
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
      kept_of<Row>("first", [of](Row i) { return proportion_json(of(i).first); }),
      shown_of<Row>(name(pair.first), [of](Row i) { return count_and_share(of(i).first); })
          .with("Counts pool all participants. p is not adjusted for the number of textures: to "
                "look at, not to test with. The other columns are those of the table above."),
      kept_of<Row>("second", [of](Row i) { return proportion_json(of(i).second); }),
      shown_of<Row>(name(pair.second), [of](Row i) { return count_and_share(of(i).second); })};
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
