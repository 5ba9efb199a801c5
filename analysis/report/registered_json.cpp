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
  return array_json(standards, [](const study::RegisteredStandard& one) {
    return Json{{"class", one.label.empty() ? Json(nullptr) : Json(one.label)},
                {"value", figure_json(one.value)}};
  });
}

/// A registration about thresholds; members that do not apply are null.
Json registered_thresholds(const study::Registration& registration) {
  const study::RegisteredAnalysis& analysis = *registration.analysis;
  const bool tested = analysis.estimand != study::Estimand::mean_threshold;
  return {{"estimand", study::name_of(analysis.estimand)},
          {"standards", standards_array(analysis.standards)},
          {"test", tested ? Json(study::name_of(analysis.test)) : Json(nullptr)},
          {"sides", tested ? Json(analysis.one_sided ? "one" : "two") : Json(nullptr)},
          {"alpha", analysis.alpha},
          {"smallest_effect_db", figure_json(analysis.smallest_effect)},
          {"margin_db", figure_json(analysis.margin)},
          {"participants", registration.participants},
          {"looks", analysis.looks},
          {"spending", study::name_of(analysis.spending)},
          {"exclusion_rules", rules_object(analysis.exclusion_rules)}};
}

Json registered_object(const study::Registration& registration) {
  if (!registration.analysis) return nullptr;
  const study::RegisteredAnalysis& analysis = *registration.analysis;
  if (study::is_of_thresholds(analysis.estimand)) return registered_thresholds(registration);
  return {{"estimand", study::name_of(analysis.estimand)},
          {"methods", analysis.methods},
          {"test", study::name_of(analysis.test)},
          {"sides", analysis.one_sided ? "one" : "two"},
          {"alpha", analysis.alpha},
          {"smallest_effect", figure_json(analysis.smallest_effect)},
          {"margin", figure_json(analysis.margin)},
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
  return array_json(methods, [](const AboveChance& one) {
    return Json{{"method", one.method}, {"mean", figure_json(one.mean)}, {"p", figure_json(one.p)}};
  });
}

void put_estimation(Json& object, const PrimaryResult& primary) {
  if (study::is_of_thresholds(primary.estimand)) {
    put_method(object,
               "estimate, interval and bounds in dB: mean of the normal distribution over "
               "participants that is most likely for everybody; who has no threshold enters by the "
               "likeliest one if that lies inside the levels, else by its side; interval: profile "
               "likelihood at "
               "interval_level (1 - alpha, or 1 - 2 alpha with a margin), which is Student's if "
               "everybody has a threshold; p of the registered choice alone",
               {"student1908", "tobin1958"});
    return;
  }
  put_method(
      object,
      "estimate: mean over participants, each of whom weighs the same; interval: Student's "
      "t, two-sided, at interval_level (1 - alpha, or 1 - 2 alpha with a margin); bound: the "
      "one-sided test's lower limit; p of the registered choice alone",
      {"student1908", "phipson2010"});
}

Json crossover_object(const PrimaryResult& primary) {
  if (!primary.crossover) return nullptr;
  const CrossoverEstimate& crossover = *primary.crossover;
  const auto& check = primary.permutation;
  Json object{{"first_first", crossover.first_first},
              {"second_first", crossover.second_first},
              {"period", figure_json(crossover.period)},
              {"period_interval", interval_json(crossover.period_interval)},
              {"permutation_p", check ? figure_json(check->p) : Json(nullptr)},
              {"least_p", check ? figure_json(check->least) : Json(nullptr)}};
  put_method(object,
             "participants by order of methods; period: accuracy in the second period less the "
             "first; permutation: orders dealt anew within the blocks in which they were dealt; "
             "carry-over cannot be told from a difference between the two groups and is not tested",
             {"hills1979", "senn2002", "phipson2010"});
  return object;
}

Json stations_object(const std::optional<StratifiedMean>& stations) {
  if (!stations) return nullptr;
  Json random = nullptr;
  if (stations->random) {
    random = {{"estimate", figure_json(stations->random->mean)},
              {"interval", interval_json(stations->random->interval)},
              {"spread", figure_json(stations->random->spread)}};
  }
  Json object{{"stations", stations->strata},
              {"estimate", figure_json(stations->mean)},
              {"interval", interval_json(stations->interval)},
              {"random", std::move(random)}};
  put_method(object,
             "the registered choice at 1 - alpha; interval: for these stations, Student's t from "
             "the spread within them; random, from six stations on: stations as a sample of "
             "others, spread between them by Paule and Mandel, interval by Hartung, Knapp, Sidik "
             "and Jonkman",
             {"student1908", "paule1982", "inthout2014"});
  return object;
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
              {"because", primary.because},
              {"planned", head.course.planned},
              {"completed", head.course.completed},
              {"excluded_after_outcomes", head.course.excluded_afterwards},
              {"choices", Json::array()}};
  for (const PrimaryChoice& choice : primary.choices) {
    object["choices"].push_back(choice_object(choice));
  }
  if (study::is_of_thresholds(primary.estimand)) object["unit"] = "dB";
  if (!primary.pairs.empty()) object["pairs"] = pairs_array(primary.pairs);
  if (!primary.above_chance.empty()) {
    object["above_chance"] = above_chance_array(primary.above_chance);
  }
  put_estimation(object, primary);
  object["stations"] = stations_object(primary.stations);
  return object;
}

Json looks_array(const std::vector<Look>& looks, bool is_public) {
  Json all = Json::array();
  for (const Look& look : looks) {
    Json one{{"at", utc_text(look.at)},
             {"participants", look.participants},
             {"reason", look.reason},
             {"kind", name_of(look.kind)}};
    if (!look.participant.empty() && !is_public) one["participant"] = look.participant;
    if (look.station > 0) one["station"] = look.station;
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

MeasureList<Prevalence> prevalence_measures() {
  using Row = Prevalence;
  return {
      number_of<Row>("estimate", "would pass", share_figure, &Row::estimate)
          .with(
              "Would pass: the share of people who would pass their own test in as many trials, a "
              "lower bound of those who can; posterior mode and 95% highest posterior density. "
              "By chance alone: the mean level that participants' tests attain.",
              {Source::ince}),
      interval_of<Row>("interval", "95% (%)", share_range, &Row::interval),
      member_of<Row>("passed", &Row::passed)
          .shown("passed individually",
                 [](const Row& one) { return fmt::format("{}/{}", one.passed, one.participants); }),
      member_of<Row>("participants", &Row::participants),
      number_of<Row>("level", "by chance alone", share_figure, &Row::level),
      member_of<Row>(
          "method",
          [](const Row&) {
            return "a lower bound of the share of people who can: those who would pass "
                   "their own test against chance in as many trials; posterior mode and "
                   "95 % highest posterior density under a uniform prior; level: the mean "
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
