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

/// The limits of d' over participants, or, with a mark, the limits from independent trials.
std::string d_prime_limits(const MethodReport& method) {
  const auto& people_d_prime = method.d_prime_over_participants;
  const DPrime& d_prime = people_d_prime ? *people_d_prime : method.d_prime;
  const std::string mark = people_d_prime ? "" : " *";
  if (!d_prime.estimate && !d_prime.low && !d_prime.high) return kNoFigure + mark;
  if (!d_prime.low) return "up to " + plain_figure(d_prime.high, 2) + mark;
  if (!d_prime.high) return "at least " + plain_figure(d_prime.low, 2) + mark;
  return plain_range(Interval{*d_prime.low, *d_prime.high}, 2) + mark;
}

/// How the numbers of an object were computed.
/// \param references  keys of references_object
template <typename Row>
MeasureList<Row> method_members(const std::string& method,
                                const std::vector<std::string>& references) {
  return {member_of<Row>("method", [method](const Row&) { return method; }),
          member_of<Row>("references", [references](const Row&) { return references; })};
}

/// The labels that the best matching exchanges: "pebbles → brick, brick → pebbles".
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

std::string chance_method(const ChanceTest& test) {
  if (test.exact) return "one-sided, exact, over the orders that the study could have had";
  return fmt::format("one-sided, Monte Carlo over {} orders made by the study's rule, (b+1)/(m+1)",
                     test.deals);
}

const char* words_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames = std::to_array<Named<TrialSubset>>(
      {{"as counted (a missing response is wrong)", counted},
       {"without trials that have no response", answered},
       {"without trials that break the validity rule", valid},
       {"with excluded participants' sessions", with_excluded_sessions}});
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
                               {member_of<Row>("answer_of", [&classes](const Row& row) {
                                 return array_json(row.answer_of,
                                                   [&](int answer) { return classes[answer]; });
                               })}});
}

MeasureList<SubsetAccuracy> subset_measures() {
  using Row = SubsetAccuracy;
  return joined_measures<Row>(
      {{member_of<Row>("trials", [](const Row& row) { return name_of(row.subset); })
            .with_cells("trials", [](const Row& row) { return words_of(row.subset); })
            .with_note(
                "Mean over participants with Student's t interval. If a row's conclusion differs "
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
            .with_cells("confidence",
                        [low, high](const Row& row) {
                          return std::to_string(row.rating) + (row.rating == low    ? " (guessed)"
                                                               : row.rating == high ? " (certain)"
                                                                                    : "");
                        })
            .with_note(
                "Trials with a response. Mean: over the participants who gave this rating, with "
                "Student's t interval; ratings that few gave compare different people.",
                {Source::student})},
       pooled_and_mean<Row>(&Row::accuracy, "accuracy", &Row::mean)});
}

bool is_between_people(BreakdownKind kind) {
  return kind == BreakdownKind::visit || kind == BreakdownKind::group;
}

MeasureList<GroupAccuracy> breakdown_measures(BreakdownKind kind) {
  using Row = GroupAccuracy;
  const bool between_people = is_between_people(kind);
  std::string title = name_of(kind);
  std::ranges::replace(title, '_', ' ');
  MeasureList<Row> all =
      joined_measures<Row>({{label_of<Row>("group", title, &Row::group)},
                            measures_in<Row>(&Row::accuracy, trials_measures()),
                            {interval_of<Row>("wilson", between_people ? "" : "Wilson 95% (%)",
                                              share_range, [](const Row& row) {
                                                return known_interval(row.wilson, row.accuracy);
                                              })}});
  if (between_people) {
    all = joined_measures<Row>({std::move(all), measures_in<Row>(&Row::mean, mean_measures())});
    all.front().notes = {
        {"Mean over participants with Student's t interval: descriptive. The "
         "registered test uses the registered visits and all groups.",
         {Source::student}}};
  } else {
    all.front().notes = {
        {"All participants' trials pooled as if independent: descriptive only. Among many rows "
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
          [&places](const Row& row) { return std::to_string(&row - places.places.data() + 1); }),
      count_of<Row>("named", "answers", &Row::named_count),
      member_of<Row>("participants", [](const Row& row) { return row.excess.mean.participants; }),
      number_of<Row>("mean", "difference (points)", points_figure,
                     [](const Row& row) { return row.excess.mean.mean; }),
      interval_of<Row>("interval", "t 95%", share_range,
                       [](const Row& row) { return row.excess.mean.known_interval(); }),
      number_of<Row>("p", "p", p_figure, [](const Row& row) { return row.excess.p; })};
}

MeasureList<ParticipantAccuracy> participant_measures(const StudyReport& report) {
  using Row = ParticipantAccuracy;
  const std::vector<std::string>& classes = report.classes;
  return joined_measures<Row>(
      {{label_of<Row>("participant", "participant", &Row::participant),
        column_of<Row>("accuracy", [](const Row& row) { return count_and_share(row.accuracy); })},
       titled(measures_in<Row>(&Row::accuracy, trials_measures()),
              {{"n", ""}, {"correct", ""}, {"p", ""}}),
       {object_in<Row>("best_matching", &Row::matching, matching_measures(classes))
            .with_cells("under the exchange",
                        [](const Row& row) { return share_figure(row.matching.accuracy.share()); }),
        column_of<Row>("exchange",
                       [&classes](const Row& row) { return exchange_of(row.matching, classes); })
            .with_note(
                "The exchange is the one-to-one matching of textures and answers that fits the "
                "most trials, chosen post hoc. p: sign test of answers that agree with the "
                "exchange against correct answers, times the number of exchanges of as many "
                "labels; adjusted over all participants and methods.",
                {Source::kuhn, Source::benjamini_hochberg}),
        number_member<Row>("consistency_bits", &Row::consistency),
        number_of<Row>("swap_p", "p", p_figure, &Row::swap_p),
        number_of<Row>("swap_p_adjusted", "p, adjusted", p_figure, &Row::swap_p_adjusted)}});
}

MeasureList<std::size_t> accuracy_measures(const StudyReport& report, const MethodReport& method) {
  using Row = std::size_t;
  const auto is_class = [&method](Row i) { return i < method.accuracy.size(); };
  const auto class_accuracy = [&method](Row i) -> const ClassAccuracy& {
    return method.accuracy[i];
  };
  const auto interval = [class_accuracy](const char* member,
                                         Interval ClassAccuracy::*interval_member) {
    return interval_of<Row>(member, "", share_range, [class_accuracy, interval_member](Row i) {
      return known_interval(class_accuracy(i).*interval_member, class_accuracy(i).accuracy);
    });
  };
  const auto mean = [=, &method](Row i) -> const MeanEstimate& {
    return is_class(i) ? class_accuracy(i).mean : method.mean;
  };
  const auto hits = [&method](Row i) {
    return i < method.unbiased_hits.size() ? method.unbiased_hits[i] : UnbiasedHits{};
  };
  return joined_measures<Row>(
      {{label_of<Row>("class", "texture",
                      [=, &report](Row i) { return is_class(i) ? report.classes[i] : "all"; })},
       measures_in<Row>(
           [=, &method](Row i) {
             return is_class(i) ? class_accuracy(i).accuracy : method.overall;
           },
           trials_measures()),
       {interval("wilson", &ClassAccuracy::wilson),
        interval("clopper_pearson", &ClassAccuracy::clopper_pearson),
        interval("jeffreys", &ClassAccuracy::jeffreys),
        number_member<Row>("mean", [=](Row i) { return mean(i).mean; }),
        interval_of<Row>("interval", "t 95% (%)", share_range,
                         [=](Row i) { return mean(i).known_interval(); })
            .with_note(
                "Counts pool all participants. t: Student's interval of the mean over "
                "participants; – with one participant, or if all are equal. Time: median and "
                "quartiles, from rendering of the plane to the answer, right or wrong.",
                {Source::student, Source::hyndman_fan}),
        number_of<Row>("", "unbiased hits", share_figure, [=](Row i) { return hits(i).rate.mean; })
            .hidden_if_unknown()
            .with_note(
                "Unbiased hits: hit rate times the share of a texture's answers that were right, "
                "mean over participants; naming a texture often does not raise it. At random: "
                "expected if answers were independent of the presented texture.",
                {Source::wagner}),
        number_of<Row>("", "at random", share_figure, [=](Row i) { return hits(i).chance_rate; })
            .hidden_if_unknown(),
        column_of<Row>("time (s)", [&method](Row i) {
          return i < method.reaction_times.size()
                     ? quartiles_figure(method.reaction_times[i].from_plane_on, 1)
                     : kNoFigure;
        })}});
}

MeasureList<ChanceTest> chance_measures() {
  using Row = ChanceTest;
  return {
      member_of<Row>("correct", &Row::correct)
          .with_cells("right",
                      [](const Row& row) { return fmt::format("{}/{}", row.correct, row.trials); }),
      member_of<Row>("trials", &Row::trials),
      number_of<Row>("expected", "by chance", decimals(1), &Row::expected),
      number_of<Row>("p", "p, at least one", p_figure, &Row::p)
          .with_note(
              "At least one participant: permutation over the orders that the study's design "
              "could have produced, one-sided; a small p does not concern the mean.",
              {Source::phipson_smyth}),
      member_of<Row>("exact", &Row::exact),
      member_of<Row>("deals", &Row::deals),
      member_of<Row>("method",
                     [](const Row& row) {
                       return "that at least one participant can: " + chance_method(row);
                     }),
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
  const auto count = [&confusion](const std::string& title, auto number, int right) {
    return member_of<int>("", number)
        .with_cells(title,
                    [&confusion, number, right](int i) {
                      return Cell(count_and_percentage(number(i), confusion.presented(i)),
                                  i == right);
                    })
        .in_csv({title});
  };
  MeasureList<int> all{
      label_of<int>("", "presented", [&classes](int i) { return classes[i]; })
          .in_csv({"presented"})
          .with_note(
              "All participants' trials pooled; right answers are emphasised. The last row counts "
              "each answer, regardless of the texture; it shows preferences for answers.")};
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

std::string count_and_share(const Proportion& trials) {
  if (trials.n == 0) return kNoFigure;
  return fmt::format("{}/{} {}", trials.correct, trials.n, share_figure(trials.share()));
}

std::string count_and_percentage(int count, int total) {
  if (count == 0) return "0";
  return fmt::format("{} ({}%)", count, plain_figure(percentage(count, total), 0));
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
       {number_of<Row>("mean", "mean", share_figure, [](const Row& row) { return row.mean.mean; })
            .with_cells("mean",
                        [](const Row& row) { return Cell(share_figure(row.mean.mean), true); }),
        interval_of<Row>("interval", "t 95% (%)", share_range,
                         [](const Row& row) { return row.mean.known_interval(); }),
        number_member<Row>("sd", [](const Row& row) { return row.mean.sd; }),
        interval_of<Row>("bootstrap", "", share_range, &Row::bootstrap)},
       method_members<Row>(
           "mean: unweighted over participants' accuracies, with Student's t interval; bootstrap: "
           "expanded percentiles of the same mean in 9,999 bootstrap samples of participants; sd: "
           "of these accuracies; spread: of participants' probabilities of a right answer, by "
           "Paule and Mandel, with the Q-profile interval; 95 %",
           {"student1908", "davison1997", "hesterberg2015", "paule1982", "viechtbauer2007"}),
       {object_in<Row, Spread>(
            "spread", &Row::spread,
            {number_member<Spread>("estimate", &Spread::estimate),
             interval_of<Spread>("interval", "", share_range, &Spread::interval)})
            .with_cells("SD between (points)",
                        [](const Row& row) { return spread_figure(row.spread); })
            .with_note(
                "SD between: of participants' probabilities of a right answer, without sampling "
                "error, with its 95% interval.",
                {Source::paule_mandel, Source::viechtbauer})}});
}

MeasureList<MethodReport> headline_measures(const StudyReport& report) {
  using Row = MethodReport;
  MeasureList<Row> overall = titled(overall_measures(), {{"n", "trials"}});
  overall.front().notes = {
      {fmt::format("Each participant has the same weight; a trial without a response counts as "
                   "wrong; chance is {}. t: Student's interval of the mean.",
                   share_figure(1.0 / static_cast<double>(report.classes.size()))),
       {Source::student}}};
  return joined_measures<Row>(
      {{label_of<Row>("", "method", &Row::method),
        count_of<Row>("", "participants", [](const Row& row) { return row.mean.participants; })},
       std::move(overall),
       {number_of<Row>("", "d′", decimals(2), [](const Row& row) { return row.d_prime.estimate; })
            .with_note(
                "d′: of an unbiased observer of equally distant textures with this accuracy; "
                "interval by bootstrap over participants, or with few of them (*) from independent "
                "trials.",
                {Source::hacker_ratcliff, Source::davison_hinkley, Source::clopper_pearson}),
        column_of<Row>("d′ 95%", d_prime_limits),
        number_of<Row>("", "information (bit)", decimals(2),
                       [](const Row& row) { return row.information.corrected; })
            .with_note("Information transfer, with Miller and Madow's bias correction.",
                       {Source::tan_reed_durlach, Source::miller})}});
}

}  // namespace touchtrial::analysis::identification
