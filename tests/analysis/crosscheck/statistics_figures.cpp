/// \file Prints the results of analysis/statistics for given cases, so that they can be compared
///   with those of an independent package (scripts/crosscheck-statistics).
///
/// Reads one JSON array of cases from standard input; each is an object whose "statistic" names one
/// of the functions below and whose other members are its arguments. Writes an array of the same
/// length: each element an array of numbers, null where a number does not exist.
#include "analysis/confusion_of_counts.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/choice_model.hpp"
#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/crossover.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/group_sequential.hpp"
#include "analysis/statistics/information_transfer.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/order_effects.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/statistics/prevalence.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/spread.hpp"
#include "analysis/statistics/strata.hpp"

#include <cmath>
#include <exception>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;
using Numbers = std::vector<std::optional<double>>;

Numbers both(const analysis::Interval& interval) {
  return {interval.low, interval.high};
}

Numbers both(const std::optional<analysis::Interval>& interval) {
  return interval ? both(*interval) : Numbers{std::nullopt, std::nullopt};
}

/// [correct, n]
analysis::Proportion proportion(const json& value) {
  return {value.at(1).get<int>(), value.at(0).get<int>()};
}

std::vector<double> numbers(const json& value) {
  return value.get<std::vector<double>>();
}

/// \param rows  of counts
analysis::ConfusionMatrix confusion(const json& rows) {
  return confusion_of_counts(rows.get<std::vector<std::vector<int>>>());
}

Numbers wilson(const json& c) {
  return both(analysis::wilson_interval(proportion(c.at("of")), c.at("level")));
}

Numbers clopper_pearson(const json& c) {
  return both(analysis::clopper_pearson_interval(proportion(c.at("of")), c.at("level")));
}

Numbers jeffreys(const json& c) {
  return both(analysis::jeffreys_interval(proportion(c.at("of")), c.at("level")));
}

Numbers t_interval(const json& c) {
  const analysis::MeanEstimate estimate =
      analysis::participant_mean(numbers(c.at("values")), {-1e9, 1e9}, c.at("level"));
  return {estimate.mean, estimate.sd, estimate.interval.low, estimate.interval.high};
}

Numbers sign_flip(const json& c) {
  return {analysis::sign_flip_p(numbers(c.at("values")))};
}

analysis::Sides sides(const json& c) {
  return c.at("sides") == "one" ? analysis::Sides::one : analysis::Sides::two;
}

Numbers t_test(const json& c) {
  return {analysis::t_test_p(numbers(c.at("values")), c.at("null"), sides(c))};
}

Numbers crossover(const json& c) {
  std::vector<analysis::CrossoverPerson> people;
  for (const json& one : c.at("people")) people.push_back({one[0], one[1], one[2]});
  const auto found = analysis::crossover_estimate(people, c.at("null"), sides(c), c.at("level"));
  const auto deals = analysis::crossover_permutation(people, c.at("null"), sides(c));
  Numbers all{found.effect, found.period, found.p};
  for (const auto& interval : {found.interval, found.period_interval}) {
    all.push_back(interval ? std::optional(interval->low) : std::nullopt);
    all.push_back(interval ? std::optional(interval->high) : std::nullopt);
  }
  all.push_back(deals ? std::optional(deals->p) : std::nullopt);
  all.push_back(deals ? std::optional(deals->least) : std::nullopt);
  return all;
}

Numbers sequential(const json& c) {
  const auto spending = c.at("spending") == "pocock" ? analysis::AlphaSpending::pocock
                                                     : analysis::AlphaSpending::obrien_fleming;
  const std::vector<double> levels =
      analysis::nominal_levels(c.at("alpha"), sides(c), spending, numbers(c.at("shares")));
  return {levels.begin(), levels.end()};
}

Numbers spread(const json& c) {
  std::vector<analysis::Proportion> participants;
  for (const json& one : c.at("participants")) participants.push_back(proportion(one));
  const std::optional<analysis::Spread> result = analysis::spread_of(participants, c.at("level"));
  if (!result) return {std::nullopt, std::nullopt, std::nullopt};
  return {result->estimate, result->interval.low, result->interval.high};
}

Numbers prevalence(const json& c) {
  const std::optional<analysis::Prevalence> result =
      analysis::prevalence_of(proportion(c.at("of")), c.at("chance"), c.at("level"));
  if (!result) return {std::nullopt, std::nullopt, std::nullopt};
  return {result->estimate, result->interval.low, result->interval.high};
}

Numbers mcnemar(const json& c) {
  return {analysis::mcnemar_mid_p(c.at("first_only"), c.at("second_only"))};
}

Numbers cochran(const json& c) {
  const std::optional<analysis::CochranQ> result =
      analysis::cochran_q(c.at("occasions").get<std::vector<std::vector<bool>>>());
  if (!result) return {std::nullopt, std::nullopt};
  return {result->q, result->p};
}

Numbers holm(const json& c) {
  const std::vector<double> adjusted = analysis::holm_adjusted(numbers(c.at("p")));
  return {adjusted.begin(), adjusted.end()};
}

Numbers odds_ratio(const json& c) {
  std::vector<std::pair<analysis::Proportion, analysis::Proportion>> participants;
  for (const json& one : c.at("participants")) {
    participants.emplace_back(proportion(one.at(0)), proportion(one.at(1)));
  }
  const std::optional<analysis::OddsRatio> result =
      analysis::mantel_haenszel(participants, c.at("level"));
  if (!result) return {std::nullopt, std::nullopt, std::nullopt};
  return {result->estimate, result->interval.low, result->interval.high};
}

Numbers nominal_d_prime(const json& c) {
  const analysis::DPrime result =
      analysis::d_prime(proportion(c.at("of")), c.at("alternatives"), c.at("level"));
  return {result.estimate, result.low, result.high};
}

Numbers transfer(const json& c) {
  const analysis::ConfusionMatrix matrix = confusion(c.at("counts"));
  std::vector<std::vector<analysis::Choice>> choices(1);
  for (int i = 0; i < matrix.classes(); ++i) {
    for (int j = 0; j < matrix.classes(); ++j) {
      choices[0].insert(choices[0].end(), matrix.count(i, j), analysis::Choice{i, j});
    }
  }
  const analysis::InformationTransfer result =
      analysis::information_transfer(matrix.classes(), choices, 0, 1);
  return {result.raw, result.corrected};
}

Numbers chance(const json& c) {
  std::vector<analysis::AnsweredBlock> blocks;
  for (const json& one : c.at("blocks")) {
    analysis::AnsweredBlock& block = blocks.emplace_back();
    block.presented = one.at("presented").get<std::vector<int>>();
    for (const json& answer : one.at("answered")) {
      block.answered.push_back(answer.is_null() ? std::nullopt : std::optional(answer.get<int>()));
    }
  }
  const analysis::OrderRule order = c.at("order") == "permuted" ? analysis::OrderRule::permuted
                                                                : analysis::OrderRule::independent;
  const std::optional<analysis::ChanceTest> test =
      analysis::chance_test(c.at("classes"), blocks, order);
  if (!test) return {std::nullopt, std::nullopt};
  return {test->p, test->expected};
}

/// Expected counts by row, G squared, degrees of freedom.
Numbers choices(const json& c) {
  const std::optional<analysis::ChoiceModel> model =
      analysis::choice_model(confusion(c.at("counts")));
  if (!model) return {};
  Numbers numbers(model->expected.samples().begin(), model->expected.samples().end());
  numbers.emplace_back(model->g_squared);
  numbers.emplace_back(model->degrees_of_freedom);
  return numbers;
}

Numbers matching(const json& c) {
  return {analysis::best_label_matching(confusion(c.at("counts"))).accuracy.correct};
}

Numbers three_quartiles(const json& c) {
  const analysis::Quartiles result = analysis::quartiles(numbers(c.at("values")));
  return {result.lower, result.median, result.upper};
}

Numbers bootstrap(const json& c) {
  std::vector<analysis::Proportion> participants;
  for (const json& one : c.at("participants")) participants.push_back(proportion(one));
  return both(analysis::cluster_bootstrap(participants, 0, c.at("draws"), c.at("level")));
}

Numbers ratio_bootstrap(const json& c) {
  std::vector<analysis::Ratio> parts;
  for (const json& one : c.at("parts")) parts.push_back({one.at(0), one.at(1)});
  return both(analysis::bootstrap_ratio(parts, 0, c.at("draws"), c.at("level")));
}

/// Of the variance with divisor n, which the jackknife makes unbiased.
Numbers jackknifed_variance(const json& c) {
  const std::vector<double> values = numbers(c.at("values"));
  const auto variance = [](const std::vector<double>& of) {
    const double sd =
        analysis::standard_deviation(of, analysis::mean_of(of), static_cast<double>(of.size()));
    return sd * sd;
  };
  std::vector<double> without;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> others = values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    without.push_back(variance(others));
  }
  const analysis::JackknifeEstimate found =
      analysis::jackknife(variance(values), without, {-1e9, 1e9}, c.at("level"));
  return {found.value, found.interval.low, found.interval.high};
}

Numbers label_swap(const json& c) {
  const analysis::ConfusionMatrix matrix = confusion(c.at("counts"));
  return {analysis::label_swap_p(matrix, analysis::best_label_matching(matrix))};
}

Numbers discovery(const json& c) {
  const std::vector<double> adjusted = analysis::benjamini_hochberg_adjusted(numbers(c.at("p")));
  return {adjusted.begin(), adjusted.end()};
}

Numbers mean_bootstrap(const json& c) {
  return both(analysis::bootstrap_mean(numbers(c.at("values")), 0, c.at("draws"), c.at("level")));
}

/// Of each class, the rate and its mean by chance.
Numbers unbiased_hits(const json& c) {
  const analysis::ConfusionMatrix matrix = confusion(c.at("counts"));
  Numbers rates;
  for (int i = 0; i < matrix.classes(); ++i) {
    rates.push_back(analysis::unbiased_hit_rate(matrix, i));
    rates.push_back(analysis::unbiased_hit_rate_by_chance(matrix, i));
  }
  return rates;
}

Numbers type_2(const json& c) {
  std::vector<analysis::RatedAnswer> answers;
  for (std::size_t i = 0; i < c.at("ratings").size(); ++i) {
    answers.push_back({c.at("ratings")[i], c.at("correct")[i]});
  }
  return {analysis::type_2_area(answers)};
}

Numbers slope_of_places(const json& c) {
  analysis::FeltBlock block;
  for (const json& right : c.at("correct")) {
    analysis::FeltTrial trial{0, right.get<int>() == 1 ? 0 : 1};
    trial.place = static_cast<double>(block.size()) + 1.0;
    block.push_back(trial);
  }
  const std::vector<std::vector<analysis::FeltBlock>> one = {{block}};
  return {analysis::order_effects(one, {}, 1)->slope.mean};
}

Numbers stratified(const json& c) {
  std::vector<std::vector<double>> strata;
  for (const json& own : c.at("strata")) strata.push_back(numbers(own));
  const auto found = analysis::stratified_mean(strata, {-1e9, 1e9}, c.at("level")).value();
  Numbers all{found.mean};
  for (const auto& end : both(found.interval)) all.push_back(end);
  if (!found.random) {
    all.resize(7);
    return all;
  }
  all.emplace_back(found.random->mean);
  for (const auto& end : both(found.random->interval)) all.push_back(end);
  all.emplace_back(found.random->spread);
  return all;
}

Numbers numbers_of(const json& one) {
  static const std::map<std::string, Numbers (*)(const json&)> kStatistics{
      {"wilson", wilson},
      {"clopper_pearson", clopper_pearson},
      {"jeffreys", jeffreys},
      {"t_interval", t_interval},
      {"sign_flip", sign_flip},
      {"t_test", t_test},
      {"crossover", crossover},
      {"nominal_levels", sequential},
      {"spread", spread},
      {"prevalence", prevalence},
      {"mcnemar", mcnemar},
      {"cochran_q", cochran},
      {"holm", holm},
      {"odds_ratio", odds_ratio},
      {"d_prime", nominal_d_prime},
      {"information_transfer", transfer},
      {"chance_test", chance},
      {"choice_model", choices},
      {"unbiased_hits", unbiased_hits},
      {"type_2_area", type_2},
      {"slope", slope_of_places},
      {"strata", stratified},
      {"label_matching", matching},
      {"label_swap", label_swap},
      {"discovery", discovery},
      {"jackknife", jackknifed_variance},
      {"bootstrap_ratio", ratio_bootstrap},
      {"quartiles", three_quartiles},
      {"cluster_bootstrap", bootstrap},
      {"bootstrap_mean", mean_bootstrap}};
  const std::string name = one.at("statistic");
  const auto found = kStatistics.find(name);
  if (found == kStatistics.end()) throw std::invalid_argument("no statistic is called " + name);
  return found->second(one);
}

json as_json(const Numbers& numbers) {
  json list = json::array();
  for (const std::optional<double>& number : numbers) {
    list.push_back(number && std::isfinite(*number) ? json(*number) : json());
  }
  return list;
}

void answer_all(std::istream& cases, std::ostream& answers) {
  json list = json::array();
  for (const json& one : json::parse(cases)) list.push_back(as_json(numbers_of(one)));
  answers << list << '\n';
}

}  // namespace
}  // namespace touchtrial

int main() {
  try {
    touchtrial::answer_all(std::cin, std::cout);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "statistics_figures: " << error.what() << "; see the top of its source\n";
    return 1;
  }
}
