#include "protocols/identification/analysis/measures.hpp"

#include "core/named.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

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

/// How the numbers of an object were computed.
/// \param references  keys of references_object
template <typename Row>
MeasureList<Row> method_members(const std::string& method,
                                const std::vector<std::string>& references) {
  return {member_of<Row>("method", [method](const Row&) { return method; }),
          member_of<Row>("references", [references](const Row&) { return references; })};
}

/// The labels that the best matching exchanges, for example "pebbles → brick, brick → pebbles".
std::string exchange_of(const LabelMatching& matching, const std::vector<std::string>& classes) {
  if (matching.answer_of.empty()) return kNoFigure;
  std::string text;
  for (std::size_t i = 0; i < matching.answer_of.size() && i < classes.size(); ++i) {
    const auto answer = static_cast<std::size_t>(matching.answer_of[i]);
    if (answer == i || answer >= classes.size()) continue;
    text += (text.empty() ? "" : ", ") + classes[i] + " → " + classes[answer];
  }
  return text.empty() ? "none" : text;
}

MeasureList<Spread> spread_measures() {
  return {number_member<Spread>("estimate", &Spread::estimate),
          interval_of<Spread>("interval", "", share_range, &Spread::interval)};
}

std::string how(const ChanceTest& test) {
  if (test.exact) return "one-sided, exact, over the orders that the study could have had";
  return fmt::format("one-sided, Monte Carlo over {} orders made by the study's rule, (b+1)/(m+1)",
                     test.deals);
}

const char* words_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames = std::to_array<Named<TrialSubset>>(
      {{"as counted (a missing response is wrong)", counted},
       {"trials without a response left out", answered},
       {"trials that break the validity rule left out", valid},
       {"excluded participants' sessions put back", with_excluded_sessions}});
  return name_in(kNames, subset).data();
}

/// Columns of trials pooled and of the mean over participants.
template <typename Row>
MeasureList<Row> pooled_and_mean(Proportion Row::*pooled, const char* share,
                                 MeanEstimate Row::*mean) {
  return joined_measures<Row>({measures_in<Row>(pooled, titled(trials_measures(), {{"p", share}})),
                               measures_in<Row>(mean, mean_measures())});
}

}  // namespace

MeasureList<Proportion> trials_measures() {
  using Row = Proportion;
  return {count_of<Row>("n", "n", &Row::n), count_of<Row>("correct", "right", &Row::correct),
          number_of<Row>("p", "accuracy", share_figure, &Row::share)};
}

MeasureList<MeanEstimate> mean_measures() {
  using Row = MeanEstimate;
  return {count_of<Row>("participants", "participants", &Row::participants),
          number_of<Row>("mean", "mean", share_figure, &Row::mean),
          interval_of<Row>("interval", "t 95% (%)", share_range, &Row::known_interval)};
}

MeasureList<LabelMatching> matching_measures(const std::vector<std::string>& classes) {
  using Row = LabelMatching;
  return joined_measures<Row>({measures_in<Row>(&Row::accuracy, trials_measures()),
                               {member_of<Row>("answer_of", [&classes](const Row& one) {
                                 return array_json(one.answer_of,
                                                   [&](int answer) { return classes[answer]; });
                               })}});
}

MeasureList<SubsetAccuracy> subset_measures() {
  using Row = SubsetAccuracy;
  return joined_measures<Row>(
      {{member_of<Row>("trials", [](const Row& one) { return name_of(one.subset); })
            .shown("trials", [](const Row& one) { return words_of(one.subset); })
            .with("Mean over participants with Student's t interval. If a row's conclusion differs "
                  "from the first row's, report it with the result.",
                  {Source::student})},
       pooled_and_mean<Row>(&Row::pooled, "pooled", &Row::mean)});
}

MeasureList<RatedAccuracy> rating_measures(const ConfidenceReport& confidence) {
  using Row = RatedAccuracy;
  const int low = confidence.ratings.front().rating;
  const int high = confidence.ratings.back().rating;
  return joined_measures<Row>(
      {{member_of<Row>("rating", &Row::rating)
            .shown("confidence",
                   [low, high](const Row& one) {
                     return std::to_string(one.rating) + (one.rating == low    ? " (guessed)"
                                                          : one.rating == high ? " (certain)"
                                                                               : "");
                   })
            .with("Trials with a response. Mean: of the own accuracies of the participants who "
                  "gave this rating, with Student's t interval; ratings that few gave compare "
                  "different people.",
                  {Source::student})},
       pooled_and_mean<Row>(&Row::accuracy, "accuracy", &Row::mean)});
}

bool is_about_people(BreakdownKind kind) {
  return kind == BreakdownKind::visit || kind == BreakdownKind::group;
}

MeasureList<GroupAccuracy> breakdown_measures(BreakdownKind kind) {
  using Row = GroupAccuracy;
  const bool of_people = is_about_people(kind);
  std::string title = name_of(kind);
  std::ranges::replace(title, '_', ' ');
  MeasureList<Row> all = joined_measures<Row>(
      {{label_of<Row>("group", title, &Row::group)},
       measures_in<Row>(&Row::accuracy, trials_measures()),
       {interval_of<Row>("wilson", of_people ? "" : "Wilson 95% (%)", share_range,
                         [](const Row& one) { return known(one.wilson, one.accuracy); })}});
  if (of_people) {
    all = joined_measures<Row>({std::move(all), measures_in<Row>(&Row::mean, mean_measures())});
    all.front().notes = {
        {"Mean of participants' own accuracies with Student's t interval: descriptive. The "
         "registered test uses the registered visits and all groups.",
         {Source::student}}};
  } else {
    all.front().notes = {
        {"All participants' trials pooled as if independent: descriptive only. Of many such rows "
         "some are extreme by chance.",
         {Source::wilson}}};
  }
  return all;
}

MeasureList<choices::PlaceUse> place_measures(const choices::AnswersByPlace& places) {
  using Row = choices::PlaceUse;
  return {
      column_of<Row>(
          "place",
          [&places](const Row& one) { return std::to_string(&one - places.places.data() + 1); }),
      count_of<Row>("named", "answers", &Row::named),
      member_of<Row>("participants", [](const Row& one) { return one.excess.mean.participants; }),
      number_of<Row>("mean", "difference (points)", points_figure,
                     [](const Row& one) { return one.excess.mean.mean; }),
      interval_of<Row>("interval", "t 95%", share_range,
                       [](const Row& one) { return one.excess.mean.known_interval(); }),
      number_of<Row>("p", "p", p_figure, [](const Row& one) { return one.excess.p; })};
}

MeasureList<ParticipantAccuracy> participant_measures(const StudyReport& report) {
  using Row = ParticipantAccuracy;
  const std::vector<std::string>& classes = report.classes;
  return joined_measures<Row>(
      {{label_of<Row>("participant", "participant", &Row::participant),
        column_of<Row>("accuracy", [](const Row& one) { return count_and_share(one.accuracy); })},
       titled(measures_in<Row>(&Row::accuracy, trials_measures()),
              {{"n", ""}, {"correct", ""}, {"p", ""}}),
       {object_in<Row>("best_matching", &Row::matching, matching_measures(classes))
            .shown("under the exchange",
                   [](const Row& one) { return share_figure(one.matching.accuracy.share()); }),
        column_of<Row>("exchange",
                       [&classes](const Row& one) { return exchange_of(one.matching, classes); })
            .with("The exchange is the one-to-one matching of textures and answers that fits the "
                  "most trials, chosen post hoc. p: sign test of the answers that agree with it "
                  "against those with the own label, times the number of exchanges of as many "
                  "labels; adjusted over all participants and methods.",
                  {Source::kuhn, Source::benjamini_hochberg}),
        number_member<Row>("consistency_bits", &Row::consistency),
        number_of<Row>("swap_p", "p", p_figure, &Row::swap_p),
        number_of<Row>("swap_p_adjusted", "p, adjusted", p_figure, &Row::swap_adjusted)}});
}

MeasureList<std::size_t> accuracy_measures(const StudyReport& report, const MethodReport& method) {
  using Row = std::size_t;
  const auto is_class = [&method](Row i) { return i < method.accuracy.size(); };
  const auto one = [&method](Row i) -> const ClassAccuracy& { return method.accuracy[i]; };
  const auto interval = [one](const char* member, Interval ClassAccuracy::*which) {
    return interval_of<Row>(member, "", share_range,
                            [one, which](Row i) { return known(one(i).*which, one(i).accuracy); });
  };
  const auto mean = [=, &method](Row i) -> const MeanEstimate& {
    return is_class(i) ? one(i).mean : method.mean;
  };
  const auto hits = [&method](Row i) {
    return i < method.unbiased.size() ? method.unbiased[i] : UnbiasedHits{};
  };
  return joined_measures<Row>(
      {{label_of<Row>("class", "texture",
                      [=, &report](Row i) { return is_class(i) ? report.classes[i] : "all"; })},
       measures_in<Row>(
           [=, &method](Row i) { return is_class(i) ? one(i).accuracy : method.overall; },
           trials_measures()),
       {interval("wilson", &ClassAccuracy::wilson),
        interval("clopper_pearson", &ClassAccuracy::clopper_pearson),
        interval("jeffreys", &ClassAccuracy::jeffreys),
        number_member<Row>("mean", [=](Row i) { return mean(i).mean; }),
        interval_of<Row>("interval", "t 95% (%)", share_range,
                         [=](Row i) { return mean(i).known_interval(); })
            .with("Counts pool all participants. t: Student's interval of the mean of "
                  "participants' own accuracies; – with one participant, or if all have the same. "
                  "Time: median and quartiles, from the moment the plane can be felt to the "
                  "answer, right or wrong.",
                  {Source::student, Source::hyndman_fan}),
        number_of<Row>("", "unbiased hits", share_figure, [=](Row i) { return hits(i).rate.mean; })
            .if_known()
            .with("Unbiased hits: hit rate times the share of a texture's answers that were right, "
                  "mean over participants; naming a texture often does not raise it. At random: "
                  "the same if answers were independent of what was presented.",
                  {Source::wagner}),
        number_of<Row>("", "at random", share_figure, [=](Row i) { return hits(i).by_chance; })
            .if_known(),
        column_of<Row>("time (s)", [&method](Row i) {
          return i < method.reaction.size() ? quartiles_figure(method.reaction[i].from_plane_on, 1)
                                            : kNoFigure;
        })}});
}

MeasureList<ChanceTest> chance_measures() {
  using Row = ChanceTest;
  return {member_of<Row>("correct", &Row::correct)
              .shown("right",
                     [](const Row& one) { return fmt::format("{}/{}", one.correct, one.trials); }),
          member_of<Row>("trials", &Row::trials),
          number_of<Row>("expected", "by chance", decimals(1), &Row::expected),
          number_of<Row>("p", "p, at least one", p_figure, &Row::p)
              .with("At least one participant: permutation over the orders that the study's design "
                    "could have dealt, one-sided; a small p says nothing about the mean.",
                    {Source::phipson_smyth}),
          member_of<Row>("exact", &Row::exact),
          member_of<Row>("deals", &Row::deals),
          member_of<Row>(
              "method",
              [](const Row& one) { return "that at least one participant can: " + how(one); }),
          member_of<Row>("references", [](const Row&) { return Json::array({"phipson2010"}); })};
}

MeasureList<MethodReport> ability_measures() {
  using Row = MethodReport;
  return joined_measures<Row>({{label_of<Row>("", "method", &Row::method)},
                               measures_in<Row>(&Row::chance, chance_measures()),
                               measures_in<Row>(&Row::prevalence, prevalence_measures())});
}

MeasureList<int> confusion_measures(const std::vector<std::string>& classes,
                                    const ConfusionMatrix& confusion) {
  const auto count = [&confusion](const std::string& title, auto of, int right) {
    return member_of<int>("", of)
        .shown(title,
               [&confusion, of, right](int i) {
                 return Cell(count_and_percentage(of(i), confusion.presented(i)), i == right);
               })
        .in_csv({title});
  };
  MeasureList<int> all{
      label_of<int>("", "presented", [&classes](int i) { return classes[i]; })
          .in_csv({"presented"})
          .with(
              "All participants' trials pooled; right answers are emphasised. The last row counts "
              "each answer, whatever was presented; it shows preferences for answers.")};
  for (int j = 0; j < confusion.classes(); ++j) {
    all.push_back(count(
        classes[j], [&confusion, j](int i) { return confusion.count(i, j); }, j));
  }
  all.push_back(count(
                    "no response", [&confusion](int i) { return confusion.no_response(i); }, -1)
                    .in_csv({"no_response"}));
  all.push_back(count_of<int>("", "n", [&confusion](int i) { return confusion.presented(i); }));
  return all;
}

std::string count_and_share(const Proportion& of) {
  return of.n == 0 ? kNoFigure
                   : fmt::format("{}/{} {}", of.correct, of.n, share_figure(of.share()));
}

std::string count_and_percentage(int count, int of) {
  if (count == 0) return "0";
  return fmt::format("{} ({}%)", count, plain_figure(percentage(count, of), 0));
}

std::vector<int> class_indices(const ConfusionMatrix& confusion) {
  std::vector<int> indices(static_cast<std::size_t>(confusion.classes()));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

MeasureList<MethodReport> overall_measures() {
  using Row = MethodReport;
  return joined_measures<Row>(
      {titled(measures_in<Row>(&Row::overall, trials_measures()), {{"correct", ""}, {"p", ""}}),
       {number_of<Row>("mean", "mean", share_figure, [](const Row& one) { return one.mean.mean; })
            .shown("mean", [](const Row& one) { return Cell(share_figure(one.mean.mean), true); }),
        interval_of<Row>("interval", "t 95% (%)", share_range,
                         [](const Row& one) { return one.mean.known_interval(); }),
        number_member<Row>("sd", [](const Row& one) { return one.mean.sd; }),
        interval_of<Row>("bootstrap", "", share_range, &Row::bootstrap)},
       method_members<Row>(
           "mean: of participants' own accuracies, each of which weighs the same however many "
           "trials it has, with Student's t interval; bootstrap: expanded percentiles of the same "
           "mean in 9,999 draws of whole participants; sd: of the accuracies as they are; spread: "
           "of participants' own probabilities of a right answer, by Paule and Mandel, with the "
           "Q-profile interval; 95 %",
           {"student1908", "davison1997", "hesterberg2015", "paule1982", "viechtbauer2007"}),
       {object_in<Row>("spread", &Row::spread, spread_measures())
            .shown("SD between (points)", [](const Row& one) { return spread_figure(one.spread); })
            .with("SD between: of participants' own probabilities of a right answer, less sampling "
                  "error, with its 95% interval.",
                  {Source::paule_mandel, Source::viechtbauer})}});
}

MeasureList<MethodReport> headline_measures(const StudyReport& report) {
  using Row = MethodReport;
  MeasureList<Row> overall = titled(overall_measures(), {{"n", "trials"}});
  overall.front().notes = {
      {fmt::format("Each participant weighs the same; a trial without a response counts as wrong; "
                   "chance is {}. t: Student's interval of the mean.",
                   share_figure(1.0 / static_cast<double>(report.classes.size()))),
       {Source::student}}};
  return joined_measures<Row>(
      {{label_of<Row>("", "method", &Row::method),
        count_of<Row>("", "participants", [](const Row& one) { return one.mean.participants; })},
       std::move(overall),
       {number_of<Row>("", "d′", decimals(2), [](const Row& one) { return one.d_prime.estimate; })
            .with("d′: of an unbiased observer of equally distant textures with this accuracy; "
                  "interval by bootstrap over participants, or, with few of them, (*) from that of "
                  "independent trials.",
                  {Source::hacker_ratcliff, Source::davison_hinkley, Source::clopper_pearson}),
        column_of<Row>("d′ 95%", bound_of),
        number_of<Row>("", "information (bit)", decimals(2),
                       [](const Row& one) { return one.information.corrected; })
            .with("Information transfer, less Miller and Madow's bias.",
                  {Source::tan_reed_durlach, Source::miller})}});
}

}  // namespace touchtrial::analysis::identification
