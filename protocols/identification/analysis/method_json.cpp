#include "protocols/identification/analysis/method_json.hpp"

#include "analysis/report/json_figures.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

Json rows_json(const Plane<double>& values) {
  Json rows = Json::array();
  for (int i = 0; i < values.height(); ++i) {
    Json row = Json::array();
    for (const double value : values.row(i)) row.push_back(figure_json(value));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json counts_json(const ConfusionMatrix& confusion) {
  Json rows = Json::array();
  for (int i = 0; i < confusion.classes(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < confusion.classes(); ++j) row.push_back(confusion.count(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json no_response_json(const ConfusionMatrix& confusion) {
  Json column = Json::array();
  for (int i = 0; i < confusion.classes(); ++i) column.push_back(confusion.no_response(i));
  return column;
}

/// The row and column sums. The bias shows in how often a class was answered, compared with how
/// often it was presented.
Json marginals_json(const ConfusionMatrix& confusion) {
  Json presented = Json::array();
  Json answered = Json::array();
  for (int i = 0; i < confusion.classes(); ++i) {
    presented.push_back(confusion.presented(i));
    answered.push_back(confusion.answered(i));
  }
  return {{"presented", std::move(presented)}, {"answered", std::move(answered)}};
}

Json classes_json(const MethodReport& method, const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const ClassAccuracy& one = method.accuracy[i];
    Json entry{{"class", classes[i]}};
    put_proportion(entry, one.accuracy);
    entry["wilson"] = interval_json(known(one.wilson, one.accuracy));
    entry["clopper_pearson"] = interval_json(known(one.clopper_pearson, one.accuracy));
    entry["jeffreys"] = interval_json(known(one.jeffreys, one.accuracy));
    entry["mean"] = figure_json(one.mean.mean);
    entry["interval"] = interval_json(one.mean.known_interval());
    all.push_back(std::move(entry));
  }
  return all;
}

Json matching_json(const LabelMatching& matching, const std::vector<std::string>& classes) {
  Json object;
  put_proportion(object, matching.accuracy);
  object["answer_of"] = Json::array();
  for (const int answer : matching.answer_of) object["answer_of"].push_back(classes[answer]);
  return object;
}

Json participants_json(const MethodReport& method, const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (const ParticipantAccuracy& one : method.per_participant) {
    Json entry{{"participant", one.participant}};
    put_proportion(entry, one.accuracy);
    entry["best_matching"] = matching_json(one.matching, classes);
    entry["consistency_bits"] = figure_json(one.consistency);
    entry["swap_p"] = figure_json(one.swap_p);
    entry["swap_p_adjusted"] = figure_json(one.swap_adjusted);
    all.push_back(std::move(entry));
  }
  return all;
}

Json spread_json(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"estimate", figure_json(spread->estimate)},
          {"interval", interval_json(spread->interval)}};
}

Json overall_json(const MethodReport& method) {
  Json overall;
  put_proportion(overall, method.overall);
  overall["mean"] = figure_json(method.mean.mean);
  overall["interval"] = interval_json(method.mean.known_interval());
  overall["sd"] = figure_json(method.mean.sd);
  overall["bootstrap"] = interval_json(method.bootstrap);
  put_method(overall,
             "mean: of participants' own accuracies, each of which weighs the same however many "
             "trials it has, with Student's t interval; bootstrap: expanded percentiles of the "
             "same mean in 9,999 draws of whole participants; sd: of the accuracies as they are; "
             "spread: of participants' own probabilities of a right answer, by Paule and Mandel, "
             "with the Q-profile interval; 95 %",
             {"student1908", "davison1997", "hesterberg2015", "paule1982", "viechtbauer2007"});
  overall["spread"] = spread_json(method.spread);
  return overall;
}

std::string how(const ChanceTest& test) {
  if (test.exact) return "one-sided, exact, over the orders that the study could have had";
  return fmt::format("one-sided, Monte Carlo over {} orders made by the study's rule, (b+1)/(m+1)",
                     test.deals);
}

Json chance_json(const std::optional<ChanceTest>& test) {
  if (!test) return nullptr;
  Json object{{"correct", test->correct},
              {"trials", test->trials},
              {"expected", figure_json(test->expected)},
              {"p", figure_json(test->p)},
              {"exact", test->exact},
              {"deals", test->deals}};
  put_method(object, "that at least one participant can: " + how(*test), {"phipson2010"});
  return object;
}

Json d_prime_json(const MethodReport& method) {
  const DPrime limits = method.d_prime_over_participants.value_or(DPrime{});
  Json object{
      {"estimate", figure_json(method.d_prime.estimate)},
      {"low", figure_json(limits.low)},
      {"high", figure_json(limits.high)},
      {"of_trials",
       {{"low", figure_json(method.d_prime.low)}, {"high", figure_json(method.d_prime.high)}}}};
  put_method(object,
             "nominal, of the pooled share, as if all classes were equally distant and no answer "
             "preferred; low and high of the share's bootstrap interval over participants; "
             "of_trials: of the Clopper-Pearson interval, which takes trials as independent",
             {"green1966", "hacker1979", "davison1997"});
  return object;
}

Json information_json(const InformationTransfer& information) {
  Json object{{"raw", figure_json(information.raw)},
              {"corrected", figure_json(information.corrected)},
              {"null_mean", figure_json(information.null_mean)}};
  put_method(object,
             fmt::format("bits, over trials with a response; corrected by Miller and Madow; "
                         "null_mean: of {} deals, answers permuted within participants",
                         information.deals),
             {"tan2010", "miller1955"});
  return object;
}

Json choice_json(const ChoiceModel& model) {
  Json bias = Json::array();
  for (const double value : model.bias) bias.push_back(figure_json(value));
  Json object{{"similarity", rows_json(model.similarity)},
              {"bias", std::move(bias)},
              {"group", model.group},
              {"expected", rows_json(model.expected)},
              {"g_squared", figure_json(model.g_squared)},
              {"degrees_of_freedom", model.degrees_of_freedom},
              {"p", figure_json(model.p)},
              {"converged", model.converged},
              {"bootstrap_p", figure_json(model.drawn_p)},
              {"draws", model.draws}};
  put_method(object,
             "similarity choice model, maximum likelihood; biases sum to 1 within a group of "
             "classes that answers connect in both directions; p of G squared under chi-square "
             "against the saturated model, and bootstrap_p, to quote, of tables drawn from the "
             "model, (b+1)/(m+1)",
             {"luce1963", "townsend1982"});
  return object;
}

void put_mean(Json& object, const MeanEstimate& mean) {
  object["participants"] = mean.participants;
  object["mean"] = figure_json(mean.mean);
  object["interval"] = interval_json(mean.known_interval());
}

Json hits_json(const UnbiasedHits& hits) {
  return {{"mean", figure_json(hits.rate.mean)},
          {"interval", interval_json(hits.rate.known_interval())},
          {"by_chance", figure_json(hits.by_chance)}};
}

Json dependence_json(const SerialDependence& dependence) {
  return {{"wrong", dependence.wrong},
          {"same", dependence.same},
          {"expected", figure_json(dependence.expected)},
          {"p", figure_json(dependence.p)}};
}

Json groups_json(const Breakdown& breakdown) {
  Json groups = Json::array();
  for (const GroupAccuracy& one : breakdown.groups) {
    Json entry{{"group", one.group}};
    put_proportion(entry, one.accuracy);
    entry["wilson"] = interval_json(known(one.wilson, one.accuracy));
    if (one.mean) put_mean(entry, *one.mean);
    groups.push_back(std::move(entry));
  }
  return groups;
}

Json unbiased_object(const MethodReport& method, const std::vector<std::string>& classes) {
  if (method.unbiased.empty()) return nullptr;
  Json object = hits_json(method.unbiased.back());
  put_method(object,
             "mean over participants of their unbiased hit rates, the share of a class's "
             "presentations that were answered right times the share of its answers that were "
             "right, averaged over classes, with Student's t interval; by_chance: its mean over "
             "all orders of each participant's presentations, with the same answers",
             {"wagner1993", "student1908"});
  object["classes"] = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Json entry{{"class", classes[i]}};
    entry.update(hits_json(method.unbiased[i]));
    object["classes"].push_back(std::move(entry));
  }
  return object;
}

Json order_object(const std::optional<OrderEffects>& order) {
  if (!order) return nullptr;
  Json object{{"slope",
               {{"mean", figure_json(order->slope.mean)},
                {"interval", interval_json(order->slope.known_interval())},
                {"p", figure_json(order->slope_p)}}},
              {"class_before", dependence_json(order->class_before)},
              {"answer_before", dependence_json(order->answer_before)},
              {"draws", order->draws}};
  put_method(object,
             fmt::format("slope: of right answers on a trial's number within blocks, least "
                         "squares, per trial, mean over participants with Student's t interval; "
                         "class_before and answer_before: wrong answers that name the class "
                         "presented, or the answer given, just before; p two-sided, of {} orders "
                         "that the design could have produced, in which each answer stays with "
                         "its presentation: twice the smaller tail, each (b+1)/(m+1)",
                         order->draws),
             {"student1908", "fischer2014", "phipson2010"});
  return object;
}

Json confidence_object(const std::optional<ConfidenceReport>& confidence) {
  if (!confidence) return nullptr;
  Json ratings = Json::array();
  for (const RatedAccuracy& one : confidence->ratings) {
    Json entry{{"rating", one.rating}};
    put_proportion(entry, one.accuracy);
    put_mean(entry, one.mean);
    ratings.push_back(std::move(entry));
  }
  Json object{{"ratings", std::move(ratings)},
              {"type_2_area",
               {{"participants", confidence->area.participants},
                {"mean", figure_json(confidence->area.mean)},
                {"interval", interval_json(confidence->area.known_interval())},
                {"without", confidence->without_area}}}};
  put_method(object,
             "over answers with a rating; means over the participants who gave it, with Student's "
             "t interval; type_2_area: of participants' own areas, the probability that a right "
             "answer was rated higher than a wrong one, equal ratings counting half",
             {"student1908", "fleming2014"});
  return object;
}

Json reaction_array(const std::vector<ReactionTimes>& reaction,
                    const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (std::size_t i = 0; i < reaction.size(); ++i) {
    const bool is_class = i < classes.size();
    all.push_back({{"class", is_class ? Json(classes[i]) : Json(nullptr)},
                   {"paused", reaction[i].paused},
                   {"from_plane_on", quartiles_json(reaction[i].from_plane_on)},
                   {"from_contact", quartiles_json(reaction[i].from_contact)}});
  }
  return all;
}

Json breakdowns_object(const std::vector<Breakdown>& breakdowns) {
  Json object = Json::object();
  for (const Breakdown& one : breakdowns) object[name_of(one.kind)] = groups_json(one);
  return object;
}

Json robustness_array(const std::vector<SubsetAccuracy>& subsets) {
  Json all = Json::array();
  for (const SubsetAccuracy& one : subsets) {
    Json entry{{"trials", name_of(one.subset)}};
    put_proportion(entry, one.pooled);
    put_mean(entry, one.mean);
    all.push_back(std::move(entry));
  }
  return all;
}

}  // namespace

nlohmann::ordered_json method_object(const MethodReport& method,
                                     const std::vector<std::string>& classes) {
  Json object{{"method", method.method},
              {"confusion", counts_json(method.confusion)},
              {"no_response", no_response_json(method.confusion)},
              {"accuracy", classes_json(method, classes)},
              {"overall", overall_json(method)},
              {"information_transfer", information_json(method.information)},
              {"per_participant", participants_json(method, classes)},
              {"marginals", marginals_json(method.confusion)},
              {"chance", chance_json(method.chance)},
              {"d_prime", d_prime_json(method)}};
  object["best_matching"] = matching_json(method.matching, classes);
  put_method(object["best_matching"],
             "accuracy under the exchange of labels that suits the answers best; biased upward; "
             "participants' swap_p: sign test of answers that agree with the exchange against "
             "those with the own label, times the number of such exchanges; swap_p_adjusted: false "
             "discovery rate over all participants and methods",
             {"kuhn1955", "benjamini1995"});
  object["choice_model"] = method.choice ? choice_json(*method.choice) : Json(nullptr);
  object["reaction_time_s"] = reaction_array(method.reaction, classes);
  object["breakdowns"] = breakdowns_object(method.breakdowns);
  object["robustness"] = robustness_array(method.robustness);
  object["unbiased_hits"] = unbiased_object(method, classes);
  object["order"] = order_object(method.order);
  object["confidence"] = confidence_object(method.confidence);
  return object;
}

}  // namespace touchtrial::analysis::identification
