#include "analysis/outcomes/departures.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/measure.hpp"
#include "core/utc.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json rules_object(const std::optional<study::ExclusionRules>& rules) {
  if (!rules) return nullptr;
  Json object{{"deviations", rules->deviations},
              {"invalid_trials", figure_json(rules->invalid_trials)}};
  if (rules->missed_catch) object["missed_catch"] = *rules->missed_catch;
  return object;
}

Json standards_array(const std::vector<study::RegisteredStandard>& standards) {
  return array_json(standards, [](const study::RegisteredStandard& standard) {
    return Json{{"class", standard.label.empty() ? Json(nullptr) : Json(standard.label)},
                {"value", figure_json(standard.value)}};
  });
}

/// Members that do not apply are null.
Json registered_object(const study::Registration& registration) {
  if (!registration.analysis) return nullptr;
  const study::RegisteredAnalysis& analysis = *registration.analysis;
  const bool has_thresholds = study::is_threshold_estimand(analysis.estimand);
  const bool has_test = analysis.estimand != study::Estimand::mean_threshold;
  const std::string unit = has_thresholds ? "_db" : "";
  return {{"estimand", study::name_of(analysis.estimand)},
          {has_thresholds ? "standards" : "methods",
           has_thresholds ? standards_array(analysis.standards) : Json(analysis.methods)},
          {"test", has_test ? Json(study::name_of(analysis.test)) : Json(nullptr)},
          {"sides", has_test ? Json(analysis.one_sided ? "one" : "two") : Json(nullptr)},
          {"alpha", analysis.alpha},
          {"smallest_effect" + unit, figure_json(analysis.smallest_effect)},
          {"margin" + unit, figure_json(analysis.margin)},
          {"participants", registration.participants},
          {"looks", analysis.looks},
          {"spending", study::name_of(analysis.spending)},
          {"exclusion_rules", rules_object(analysis.exclusion_rules)}};
}

Json choice_object(const PrimaryChoice& choice) {
  Json object{{"choice", choice.name},
              {"words", choice.words},
              {"participants", choice.participants},
              {"trials", choice.trials},
              {"estimate", figure_json(choice.estimate)},
              {"interval", interval_json(choice.interval)}};
  if (!choice.pair.empty()) object["pair"] = choice.pair;
  return object;
}

Json pairs_array(const std::vector<PrimaryPair>& pairs) {
  return array_json(pairs, [](const PrimaryPair& pair) {
    return Json{{"pair", pair.words},
                {"participants", pair.participants},
                {"estimate", figure_json(pair.estimate)},
                {"interval", interval_json(pair.interval)},
                {"p", figure_json(pair.p)}};
  });
}

Json above_chance_array(const std::vector<AboveChance>& methods) {
  return array_json(methods, [](const AboveChance& method) {
    return Json{{"method", method.method},
                {"mean", figure_json(method.mean)},
                {"p", figure_json(method.p)}};
  });
}

void put_estimation(Json& object, const PrimaryResult& primary) {
  if (primary.has_thresholds()) {
    put_method(
        object,
        "estimate, interval and bounds in dB: maximum-likelihood mean of a normal distribution "
        "over participants; participants without a threshold enter by their maximum-likelihood "
        "threshold if it is within the levels, else as censored; interval: profile likelihood at "
        "interval_level (1 - alpha, or 1 - 2 alpha with a margin), which is Student's if everybody "
        "has a threshold; p only for the registered choice",
        {"student1908", "tobin1958"});
    return;
  }
  put_method(
      object,
      "estimate: unweighted mean over participants; interval: Student's t, two-sided, at "
      "interval_level (1 - alpha, or 1 - 2 alpha with a margin); bound: the one-sided test's lower "
      "limit; p only for the registered choice",
      {"student1908", "phipson2010"});
}

Json crossover_object(const PrimaryResult& primary) {
  if (!primary.crossover) return nullptr;
  const CrossoverEstimate& crossover = *primary.crossover;
  const auto& check = primary.permutation;
  return with_method(
      {{"first_first", crossover.first_first},
       {"second_first", crossover.second_first},
       {"period", figure_json(crossover.period)},
       {"period_interval", interval_json(crossover.period_interval)},
       {"permutation_p", check ? figure_json(check->p) : Json(nullptr)},
       {"least_p", check ? figure_json(check->least) : Json(nullptr)}},
      "participants by order of methods; period: accuracy in the second period minus the first; "
      "permutation: orders reassigned within their randomisation blocks; carry-over is confounded "
      "with the difference between the two groups and is not tested",
      {"hills1979", "senn2002", "phipson2010"});
}

Json stations_object(const std::optional<StratifiedMean>& stations) {
  if (!stations) return nullptr;
  Json random = nullptr;
  if (stations->random) {
    random = {{"estimate", figure_json(stations->random->mean)},
              {"interval", interval_json(stations->random->interval)},
              {"spread", figure_json(stations->random->spread)}};
  }
  return with_method(
      {{"stations", stations->strata},
       {"estimate", figure_json(stations->mean)},
       {"interval", interval_json(stations->interval)},
       {"random", std::move(random)}},
      "the registered choice at 1 - alpha; interval: for these stations, Student's t from the "
      "spread within them; random, with at least six stations: stations as a random sample, "
      "Paule-Mandel spread, Hartung-Knapp-Sidik-Jonkman interval",
      {"student1908", "paule1982", "inthout2014"});
}

Json primary_object(const StudyHead& head) {
  if (!head.primary) return nullptr;
  const PrimaryResult& primary = *head.primary;
  const std::string unadjusted = unadjusted_words(head.looks);
  Json object{{"estimand", study::name_of(primary.estimand)},
              {"words", primary.words},
              {"estimate", figure_json(primary.registered().estimate)},
              {"interval", interval_json(primary.registered().interval)},
              {"interval_level", primary.interval_level},
              {"bound", figure_json(primary.bound)},
              {"test", primary.test},
              {"null", figure_json(primary.null)},
              {"p", figure_json(primary.p)},
              {"statistic", statistic_json(primary.statistic)},
              {"p_note", unadjusted.empty() ? Json(nullptr) : Json(unadjusted)},
              {"alpha", primary.alpha},
              {"level", primary.level},
              {"smallest_effect", figure_json(primary.smallest_effect)},
              {"margin", figure_json(primary.margin)},
              {"crossover", crossover_object(primary)},
              {"verdict", name_of(primary.verdict)},
              {"because", primary.reason},
              {"planned", head.course.planned},
              {"completed", head.course.completed},
              {"excluded_after_outcomes", head.course.excluded_afterwards},
              {"choices", array_json(primary.choices, choice_object)}};
  if (primary.has_thresholds()) object["unit"] = "dB";
  if (!primary.pairs.empty()) object["pairs"] = pairs_array(primary.pairs);
  if (!primary.above_chance.empty()) {
    object["above_chance"] = above_chance_array(primary.above_chance);
  }
  put_estimation(object, primary);
  object["stations"] = stations_object(primary.stations);
  return object;
}

Json looks_array(const std::vector<Look>& looks, bool is_public) {
  return array_json(looks, [is_public](const Look& look) {
    Json object{{"at", utc_text(look.at)},
                {"participants", look.participants},
                {"reason", look.reason},
                {"kind", name_of(look.kind)}};
    if (!look.participant.empty() && !is_public) object["participant"] = look.participant;
    if (look.station > 0) object["station"] = look.station;
    return object;
  });
}

}  // namespace

MeasureList<Prevalence> prevalence_measures() {
  using Row = Prevalence;
  return {number_of<Row>("estimate", "would pass", share_figure, &Row::estimate)
              .with_note(
                  "Would pass: the share of people who would pass an individual test with as many "
                  "trials, a lower bound on the share who can do the task; posterior mode and 95% "
                  "highest posterior density. By chance: the mean attained level of these tests.",
                  {Source::ince}),
          interval_of<Row>("interval", "95% (%)", share_range, &Row::interval),
          member_of<Row>("passed", &Row::passed)
              .with_cells("passed individually",
                          [](const Row& row) {
                            return fmt::format("{}/{}", row.passed, row.participants);
                          }),
          member_of<Row>("participants", &Row::participants),
          number_of<Row>("level", "by chance", share_figure, &Row::level),
          member_of<Row>(
              "method",
              [](const Row&) {
                return "a lower bound on the share of people who can do the task: those who would "
                       "pass an individual test against chance with as many trials; posterior mode "
                       "and 95% highest posterior density under a uniform prior; level: the mean "
                       "probability of passing by chance";
              }),
          member_of<Row>("references", [](const Row&) { return Json::array({"ince2021"}); })};
}

void put_registered(nlohmann::ordered_json& object, const StudyHead& head) {
  object["registered"] = registered_object(head.registration);
  object["primary"] = primary_object(head);
  object["prevalence"] =
      head.prevalence ? object_of(*head.prevalence, prevalence_measures()) : Json(nullptr);
  object["looks"] = looks_array(head.looks, head.collection.is_public);
  object["departures"] = head.departures;
}

}  // namespace touchtrial::analysis
