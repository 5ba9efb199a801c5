#include "analysis/choices/people_report.hpp"
#include "analysis/report/bibliography.hpp"
#include "analysis/report/json_figures.hpp"
#include "protocols/identification/analysis/cues/cue_measures.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

Json pair_json(const MethodPair& pair, const StudyReport& report) {
  return with_method(
      object_of(pair, pair_measures(report)),
      "differences of participants' accuracies, first minus second: t interval, bootstrap "
      "(expanded percentiles of 9,999 samples of participants), p of the two-sided sign-flip test "
      "(exact up to 32 participants, then 99,999 random patterns); statistic: Student's t, and d_z "
      "with the interval by noncentral t; db: 10 log10 of the ratio of means; p_holm: adjusted "
      "over all pairs, with three methods or more; mcnemar_mid_p: with one pair per participant; p "
      "of classes are not adjusted",
      {"student1908", "davison1997", "hesterberg2015", "phipson2010", "holm1979", "fagerland2013",
       "cumming2001"});
}

/// The comparison in a study with two methods.
Json comparison_json(const MethodComparison& comparison) {
  return {{"difference", figure_json(comparison.difference)},
          {"interval", interval_json(comparison.known_interval())},
          {"p", figure_json(comparison.p)},
          {"db", figure_json(comparison.db)}};
}

Json all_methods_json(const AllMethodsTest& test) {
  return with_method(
      {{"q", figure_json(test.cochran.q)},
       {"degrees_of_freedom", test.cochran.degrees_of_freedom},
       {"p", figure_json(test.cochran.p)},
       {"permuted_p", figure_json(test.permuted_p)}},
      "Cochran's Q over occasions (participant, class, n-th presentation); p under chi-square "
      "treats occasions as independent; permuted_p permutes methods within participants, Monte "
      "Carlo over 9,999 deals, (b+1)/(m+1)",
      {"cochran1950", "phipson2010"});
}

std::vector<int> indices_below(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

Json rows_json(const Plane<double>& values) {
  return array_json(indices_below(values.height()),
                    [&](int i) { return array_json(values.row(i), figure_json); });
}

Json counts_json(const ConfusionMatrix& confusion) {
  const std::vector<int> classes = indices_below(confusion.classes());
  return array_json(classes, [&](int i) {
    return array_json(classes, [&](int j) { return confusion.count(i, j); });
  });
}

Json marginals_json(const ConfusionMatrix& confusion) {
  const std::vector<int> classes = indices_below(confusion.classes());
  return {{"presented", array_json(classes, [&](int i) { return confusion.presented(i); })},
          {"answered", array_json(classes, [&](int i) { return confusion.answered(i); })}};
}

Json classes_json(const StudyReport& report, const MethodReport& method) {
  std::vector<std::size_t> classes(report.classes.size());
  std::iota(classes.begin(), classes.end(), 0U);
  return objects_of(classes, accuracy_measures(report, method));
}

Json d_prime_json(const MethodReport& method) {
  const DPrime limits = method.d_prime_over_participants.value_or(DPrime{});
  return with_method(
      {{"estimate", figure_json(method.d_prime.estimate)},
       {"low", figure_json(limits.low)},
       {"high", figure_json(limits.high)},
       {"of_trials",
        {{"low", figure_json(method.d_prime.low)}, {"high", figure_json(method.d_prime.high)}}}},
      "nominal, from the pooled accuracy, as if all classes were equally distant and no answer "
      "preferred; low and high from the bootstrap interval over participants; of_trials: from the "
      "Clopper-Pearson interval, which treats trials as independent",
      {"green1966", "hacker1979", "davison1997"});
}

Json information_json(const InformationTransfer& information) {
  return with_method(
      {{"raw", figure_json(information.raw)},
       {"corrected", figure_json(information.corrected)},
       {"null_mean", figure_json(information.null_mean)}},
      fmt::format("bits, over trials with a response; corrected by Miller and Madow; "
                  "null_mean: of {} deals, answers permuted within participants",
                  information.deals),
      {"tan2010", "miller1955"});
}

Json choice_json(const ChoiceModel& model) {
  return with_method(
      {{"similarity", rows_json(model.similarity)},
       {"bias", array_json(model.bias, figure_json)},
       {"group", model.group},
       {"expected", rows_json(model.expected)},
       {"g_squared", figure_json(model.g_squared)},
       {"degrees_of_freedom", model.degrees_of_freedom},
       {"p", figure_json(model.p)},
       {"converged", model.converged},
       {"bootstrap_p", figure_json(model.drawn_p)},
       {"draws", model.draws}},
      "similarity choice model, maximum likelihood; biases sum to 1 within a group of classes that "
      "answers connect in both directions; p of G squared under chi-square against the saturated "
      "model; bootstrap_p (to quote) from tables drawn from the model, (b+1)/(m+1)",
      {"luce1963", "townsend1982"});
}

Json hits_json(const UnbiasedHits& hits) {
  Json object;
  put_mean(object, hits.rate);
  object["by_chance"] = figure_json(hits.chance_rate);
  return object;
}

Json dependence_json(const SerialDependence& dependence) {
  return {{"wrong", dependence.wrong},
          {"same", dependence.same},
          {"expected", figure_json(dependence.expected)},
          {"p", figure_json(dependence.p)}};
}

Json unbiased_object(const MethodReport& method, const std::vector<std::string>& classes) {
  if (method.unbiased_hits.empty()) return nullptr;
  Json object = hits_json(method.unbiased_hits.back());
  put_method(object,
             "mean over participants of their unbiased hit rates (hit rate times the share of a "
             "class's answers that were right, averaged over classes) with Student's t interval; "
             "by_chance: its mean over all orders of each participant's presentations, with the "
             "same answers",
             {"wagner1993", "student1908"});
  object["classes"] = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Json entry{{"class", classes[i]}};
    entry.update(hits_json(method.unbiased_hits[i]));
    object["classes"].push_back(std::move(entry));
  }
  return object;
}

Json order_object(const std::optional<OrderEffects>& order) {
  if (!order) return nullptr;
  return with_method(
      {{"slope",
        {{"mean", figure_json(order->slope.mean)},
         {"interval", interval_json(order->slope.known_interval())},
         {"p", figure_json(order->slope_p)}}},
       {"class_before", dependence_json(order->class_before)},
       {"answer_before", dependence_json(order->answer_before)},
       {"draws", order->draws}},
      fmt::format(
          "slope: of right answers on trial number within blocks, least squares, per trial, mean "
          "over participants with Student's t interval; class_before and answer_before: wrong "
          "answers that name the previous class or answer; p: two-sided, from {} orders that the "
          "design could have produced, in which each answer stays with its presentation: twice the "
          "smaller tail, each (b+1)/(m+1)",
          order->draws),
      {"student1908", "fischer2014", "phipson2010"});
}

Json confidence_object(const std::optional<ConfidenceReport>& confidence) {
  if (!confidence) return nullptr;
  Json ratings = confidence->ratings.empty()
                     ? Json::array()
                     : objects_of(confidence->ratings, rating_measures(*confidence));
  Json area = object_of(confidence->area, mean_measures());
  area["without"] = confidence->without_area;
  return with_method(
      {{"ratings", std::move(ratings)}, {"type_2_area", std::move(area)}},
      "over answers with a rating; means over the participants who gave it, with Student's t "
      "interval; type_2_area: mean over participants of the probability that a right answer was "
      "rated higher than a wrong one, equal ratings counting half",
      {"student1908", "fleming2014"});
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
  for (const Breakdown& breakdown : breakdowns) {
    object[name_of(breakdown.kind)] =
        objects_of(breakdown.groups, breakdown_measures(breakdown.kind));
  }
  return object;
}

Json method_object(const StudyReport& report, const MethodReport& method) {
  const std::vector<std::string>& classes = report.classes;
  Json object{
      {"method", method.method},
      {"confusion", counts_json(method.confusion)},
      {"no_response", array_json(indices_below(method.confusion.classes()),
                                 [&](int i) { return method.confusion.no_response(i); })},
      {"accuracy", classes_json(report, method)},
      {"overall", object_of(method, overall_measures())},
      {"information_transfer", information_json(method.information)},
      {"per_participant", objects_of(method.per_participant, participant_measures(report))},
      {"marginals", marginals_json(method.confusion)},
      {"chance", method.chance ? object_of(*method.chance, chance_measures()) : Json(nullptr)},
      {"d_prime", d_prime_json(method)}};
  object["best_matching"] = object_of(method.matching, matching_measures(classes));
  put_method(
      object["best_matching"],
      "accuracy under the exchange of labels that fits the answers best; biased upward; "
      "participants' swap_p: sign test of answers that agree with the exchange against correct "
      "answers, times the number of such exchanges; swap_p_adjusted: false discovery rate over all "
      "participants and methods",
      {"kuhn1955", "benjamini1995"});
  object["choice_model"] = method.choice ? choice_json(*method.choice) : Json(nullptr);
  object["reaction_time_s"] = reaction_array(method.reaction_times, classes);
  object["breakdowns"] = breakdowns_object(method.breakdowns);
  object["robustness"] = objects_of(method.robustness, subset_measures());
  object["unbiased_hits"] = unbiased_object(method, classes);
  object["order"] = order_object(method.order);
  object["confidence"] = confidence_object(method.confidence);
  return object;
}

Json places_object(const StudyReport& report) {
  if (!report.places) return nullptr;
  const choices::AnswersByPlace& places = *report.places;
  return with_method(
      {{"places", objects_of(places.places, place_measures(places))},
       {"p", figure_json(places.p)},
       {"deals", places.deals},
       {"preferences", Json::parse(choices::preferences_json(places.preferences, report.classes))}},
      "counted answers of all methods by place on the screen, whose pictures were drawn for each "
      "participant; places: mean over participants of the share of answers minus 1/K, with "
      "Student's t interval and p (sign flips if all are equal); p: that participants together "
      "prefer no place, from redrawn layouts, (b+1)/(m+1); preferences: from wrong answers that "
      "confuse two pictures, with names permuted among participants",
      {"student1908", "holm1979", "phipson2010"});
}

}  // namespace

std::string report_json(const StudyReport& report) {
  Json object = head_object(report);
  object["classes"] = report.classes;
  object["methods"] = array_json(
      report.methods, [&](const MethodReport& method) { return method_object(report, method); });
  if (report.comparison) object["comparison"] = comparison_json(*report.comparison);
  object["warnings"] = report.warnings;
  object["pairs"] =
      array_json(report.pairs, [&](const MethodPair& pair) { return pair_json(pair, report); });
  if (report.all_methods) object["together"] = all_methods_json(*report.all_methods);
  object["accuracy_intervals"] = with_method(
      {},
      "wilson, clopper_pearson and jeffreys: 95%, all participants' trials pooled as if "
      "independent; p is correct / n, with trials without a response as wrong; mean and interval: "
      "over participants, by Student's t",
      {"wilson1927", "clopper1934", "brown2001", "student1908"});
  object["reaction_times"] =
      with_method({}, "quartiles by definition 7, over trials with a response", {"hyndman1996"});
  object["registration"] = registration_object(report.registration);
  object["collection"] = collection_object(report.collection);
  object["places"] = places_object(report);
  if (report.cues) object["cues"] = cues_object(*report.cues);
  object["references"] = references_object();
  put_registered(object, report);
  put_people(object, report);
  return json_text(object);
}

}  // namespace touchtrial::analysis::identification
