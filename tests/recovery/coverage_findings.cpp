#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/statistics/proportion.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr int kDraws = 1999;  ///< of a bootstrap, fewer than in a report

double holds(const analysis::Interval& interval, double truth) {
  return interval.low <= truth && truth <= interval.high ? 1.0 : 0.0;
}

std::string described(const Population& population, int participants) {
  return fmt::format("{} participants, d' {} (SD {}), lapse {}", participants, population.d_prime,
                     population.spread, population.lapse);
}

Finding coverage(const std::string& what, const std::string& population, const Average& share,
                 double least, double most, const std::string& why) {
  return {
      "coverage", what, population, analysis::kConfidenceLevel, share.mean, share.standard_error,
      least,      most, why};
}

/// The variance of participants' own accuracies, without the part that trials add by chance.
double between_variance(const Population& population) {
  const double mean = true_accuracy(population);
  double sum = 0.0;
  double weights = 0.0;
  constexpr int kSteps = 200;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double z = 5.0 * i / kSteps;
    const double weight = std::exp(-0.5 * z * z);
    Population one = population;
    one.d_prime += z * population.spread;
    one.spread = 0.0;
    sum += weight * std::pow(true_accuracy(one) - mean, 2);
    weights += weight;
  }
  return sum / weights;
}

/// The coverage of an interval that treats pooled trials as independent.
double pooled_coverage(const Population& population) {
  const double mean = true_accuracy(population);
  const double trials = population.classes * population.repeats;
  const double between = between_variance(population);
  const double believed = mean * (1.0 - mean) / trials;
  const double actual = between + (mean * (1.0 - mean) - between) / trials;
  const boost::math::normal normal;
  const double reach = boost::math::quantile(normal, 0.975) * std::sqrt(believed / actual);
  return 2.0 * boost::math::cdf(normal, reach) - 1.0;
}

void add_group_level(const Population& population, int participants, int repetitions,
                     std::vector<Finding>& findings) {
  const double truth = true_accuracy(population);
  const std::string who = described(population, participants);
  const auto over_studies = [&](const std::string& purpose, auto interval_of) {
    return average_of(repetitions, purpose + who, [&](RandomStream& random) {
      const auto right = accuracies(study_of(population, participants, random));
      return holds(interval_of(right), truth);
    });
  };
  const Average t = over_studies(
      "t", [](const auto& right) { return analysis::participant_mean(shares(right)).interval; });
  findings.push_back(coverage("mean over participants, t", who, t, 0.93, 0.965,
                              "accuracies of 25 trials are steps of 4 %, and skewed near 100 %"));
  const Average drawn = over_studies("bootstrap", [](const auto& right) {
    return analysis::cluster_bootstrap(right, 0, kDraws).value_or(analysis::Interval{});
  });
  findings.push_back(coverage("cluster bootstrap, expanded percentiles", who, drawn, 0.925, 0.965,
                              "as t: steps of 4 %, skew; and few participants to draw from"));
  const Average pooled = over_studies("pooled", [](const auto& right) {
    analysis::Proportion all;
    for (const analysis::Proportion& one : right) all = {all.n + one.n, all.correct + one.correct};
    return analysis::wilson_interval(all);
  });
  const double narrow = pooled_coverage(population);
  findings.push_back(
      coverage("all trials pooled, Wilson", who, pooled, narrow - 0.02, narrow + 0.02,
               population.spread == 0.0
                   ? "people do not differ: trials are independent"
                   : fmt::format("pseudo-replication: {:.3f} by the design effect", narrow)));
}

/// Mean and least coverage over true proportions of 0.05 to 0.95, by adding up all outcomes.
template <typename IntervalOf>
std::pair<double, double> exact_coverage(int n, IntervalOf interval_of) {
  constexpr int kSteps = 360;
  double sum = 0.0;
  double least = 1.0;
  for (int step = 0; step <= kSteps; ++step) {
    const double p = 0.05 + 0.9 * step / kSteps;
    const boost::math::binomial binomial(n, p);
    double covered = 0.0;
    for (int correct = 0; correct <= n; ++correct) {
      covered += boost::math::pdf(binomial, correct) *
                 holds(interval_of(analysis::Proportion{n, correct}), p);
    }
    sum += covered;
    least = std::min(least, covered);
  }
  return {sum / (kSteps + 1), least};
}

template <typename IntervalOf>
void add_proportion(const std::string& name, int n, IntervalOf interval_of, double least_mean,
                    double most_mean, double least_least, const std::string& why,
                    std::vector<Finding>& findings) {
  const auto [mean, least] = exact_coverage(n, interval_of);
  const std::string who = fmt::format("{} independent trials, p 0.05 to 0.95", n);
  findings.push_back({"coverage", name + ", mean over p", who, analysis::kConfidenceLevel, mean,
                      0.0, least_mean, most_mean, why});
  findings.push_back({"coverage", name + ", least over p", who, analysis::kConfidenceLevel, least,
                      0.0, least_least, 1.0, "outcomes are whole numbers: coverage jumps with p"});
}

void add_proportions(std::vector<Finding>& findings) {
  for (const int n : {25, 100}) {
    add_proportion(
        "Wilson", n, [](analysis::Proportion p) { return analysis::wilson_interval(p); }, 0.945,
        0.96, 0.90, "close to nominal on average", findings);
    add_proportion(
        "Clopper-Pearson", n,
        [](analysis::Proportion p) { return analysis::clopper_pearson_interval(p); }, 0.95, 0.985,
        0.95, "never below nominal, so above it on average", findings);
    add_proportion(
        "Jeffreys", n, [](analysis::Proportion p) { return analysis::jeffreys_interval(p); }, 0.94,
        0.96, 0.87, "close to nominal on average", findings);
  }
}

void add_d_prime(int repetitions, std::vector<Finding>& findings) {
  const Population one{.d_prime = 1.75};
  const Average share = average_of(repetitions, "d'", [&](RandomStream& random) {
    const analysis::Proportion right = accuracies(study_of(one, 1, random)).front();
    const analysis::DPrime found = analysis::d_prime(right, one.classes);
    return (!found.low || *found.low <= one.d_prime) && (!found.high || one.d_prime <= *found.high)
               ? 1.0
               : 0.0;
  });
  findings.push_back(coverage("nominal d', Clopper-Pearson's ends", described(one, 1), share, 0.95,
                              0.99, "Clopper-Pearson is never below nominal"));
}

double odds(double p) {
  return p / (1.0 - p);
}

void add_differences(int participants, double spread, int repetitions,
                     std::vector<Finding>& findings) {
  const Population better{.d_prime = 1.75, .spread = spread};
  const Population worse{.d_prime = 1.25, .spread = spread};
  const double truth = true_accuracy(better) - true_accuracy(worse);
  const std::string who = described(better, participants) + ", against d' 1.25";
  const Average share = average_of(repetitions, "difference" + who, [&](RandomStream& random) {
    std::vector<double> differences;
    for (int i = 0; i < participants; ++i) {
      const double own = spread * random.normal();
      const auto first = accuracies({answers_of(better, better.d_prime + own, random)});
      const auto second = accuracies({answers_of(worse, worse.d_prime + own, random)});
      differences.push_back(shares(first).front() - shares(second).front());
    }
    return holds(analysis::participant_mean(differences, {-1.0, 1.0}).interval, truth);
  });
  findings.push_back(coverage("difference of two methods, t", who, share, 0.94, 0.96,
                              "differences of 25 trials are steps of 4 %"));
}

void add_odds_ratio(int participants, int repetitions, std::vector<Finding>& findings) {
  const Population better{.d_prime = 1.75};
  const Population worse{.d_prime = 1.25};
  const double truth = odds(true_accuracy(better)) / odds(true_accuracy(worse));
  const std::string who = described(better, participants) + ", against d' 1.25";
  const Average share = average_of(repetitions, "odds" + who, [&](RandomStream& random) {
    const auto first = accuracies(study_of(better, participants, random));
    const auto second = accuracies(study_of(worse, participants, random));
    std::vector<std::pair<analysis::Proportion, analysis::Proportion>> strata;
    for (std::size_t i = 0; i < first.size(); ++i) strata.emplace_back(first[i], second[i]);
    const auto ratio = analysis::mantel_haenszel(strata);
    return ratio ? holds(ratio->interval, truth) : 0.0;
  });
  findings.push_back(coverage("odds ratio, Mantel-Haenszel", who, share, 0.945, 0.96,
                              "a normal approximation on the logarithm"));
}

/// People whose log odds with two methods are normal, with as many trials of each.
struct TwoMethods {
  double effect = 0.7;  ///< of the first method on the log odds
  double spread = 0.8;  ///< SD between people of the log odds with both
  double slope = 0.0;   ///< SD between people of the effect
};

std::pair<double, double> drawn_chances(const TwoMethods& two, RandomStream& random) {
  const double own = 1.0 + two.spread * random.normal();
  const double effect = two.effect + two.slope * random.normal();
  const auto chance = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  return {chance(own + 0.5 * effect), chance(own - 0.5 * effect)};
}

/// The common odds ratio of an unlimited number of people.
double true_odds_ratio(const TwoMethods& two) {
  constexpr int kPeople = 400'000;
  RandomStream random(1, "odds ratio of many people");
  double above = 0.0;
  double below = 0.0;
  for (int i = 0; i < kPeople; ++i) {
    const auto [first, second] = drawn_chances(two, random);
    above += first * (1.0 - second);
    below += (1.0 - first) * second;
  }
  return above / below;
}

int right_of(double chance, RandomStream& random) {
  int right = 0;
  for (int i = 0; i < 25; ++i) right += random.uniform() < chance ? 1 : 0;
  return right;
}

void add_odds_ratio_of_people(double slope, int participants, int repetitions,
                              std::vector<Finding>& findings) {
  const TwoMethods two{.slope = slope};
  const double truth = true_odds_ratio(two);
  const std::string who =
      fmt::format("{} participants, log odds of SD {}, their difference 0.7 of SD {}", participants,
                  two.spread, slope);
  const auto share = [&](auto interval_of) {
    return average_of(repetitions, "odds of people" + who, [&](RandomStream& random) {
      std::vector<std::pair<analysis::Proportion, analysis::Proportion>> strata;
      for (int i = 0; i < participants; ++i) {
        const auto [first, second] = drawn_chances(two, random);
        const int right = right_of(first, random);
        strata.emplace_back(analysis::Proportion{25, right},
                            analysis::Proportion{25, right_of(second, random)});
      }
      const std::optional<analysis::Interval> interval = interval_of(strata);
      return interval ? holds(*interval, truth) : 0.0;
    });
  };
  const Average drawn =
      share([](const auto& strata) { return analysis::odds_ratio_bootstrap(strata, 0, kDraws); });
  findings.push_back(coverage("odds ratio, bootstrap over participants", who, drawn, 0.925, 0.965,
                              "as the cluster bootstrap of a mean"));
  const Average trials = share([](const auto& strata) {
    const auto ratio = analysis::mantel_haenszel(strata);
    return ratio ? std::optional(ratio->interval) : std::nullopt;
  });
  findings.push_back(coverage(
      "odds ratio, Mantel-Haenszel", who, trials, slope > 0.0 ? 0.6 : 0.94,
      slope > 0.0 ? 0.85 : 0.965,
      slope > 0.0 ? "pseudo-replication: trials as if independent" : "all have one odds ratio"));
}

/// The d' at an accuracy.
double d_prime_at(double accuracy, int classes) {
  constexpr int kMany = 100'000'000;
  const auto right = static_cast<int>(std::lround(kMany * accuracy));
  return analysis::d_prime({kMany, right}, classes).estimate.value_or(0.0);
}

void add_pooled_d_prime(int participants, int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = 1.5, .spread = 0.6};
  const double truth = d_prime_at(true_accuracy(people), people.classes);
  const std::string who = described(people, participants);
  const auto share = [&](bool over_participants) {
    return average_of(repetitions, "pooled d'" + who, [&](RandomStream& random) {
      const auto right = accuracies(study_of(people, participants, random));
      analysis::Proportion all;
      for (const auto& one : right) all = {all.n + one.n, all.correct + one.correct};
      const auto limits = over_participants ? analysis::cluster_bootstrap(right, 0, kDraws).value()
                                            : analysis::clopper_pearson_interval(all);
      const analysis::DPrime found = analysis::d_prime(all, people.classes, limits);
      return holds({found.low.value_or(-9.0), found.high.value_or(9.0)}, truth);
    });
  };
  findings.push_back(coverage("nominal d' of the mean accuracy, bootstrap over participants", who,
                              share(true), 0.925, 0.965, "as the bootstrap of the accuracy"));
  findings.push_back(coverage("nominal d' of the mean accuracy, Clopper-Pearson's ends", who,
                              share(false), 0.6, 0.75, "pseudo-replication"));
}

void add_class(const Population& people, int participants, int repetitions,
               std::vector<Finding>& findings) {
  const std::string who = described(people, participants) + ", one class of 5 trials each";
  // All classes are equally hard without a bias.
  const double truth = true_accuracy(people);
  const auto share = [&](auto interval_of) {
    return average_of(repetitions, "class" + who, [&](RandomStream& random) {
      std::vector<analysis::Proportion> own;
      for (const auto& choices : study_of(people, participants, random)) {
        own.push_back(analysis::ConfusionMatrix(people.classes, choices).accuracy(0));
      }
      return holds(interval_of(own), truth);
    });
  };
  const Average t =
      share([](const auto& own) { return analysis::participant_mean(shares(own)).interval; });
  findings.push_back(coverage("accuracy with a class, t over participants", who, t, 0.925, 0.965,
                              "accuracies of 5 trials are steps of 20 %"));
  const Average wilson = share([](const auto& own) {
    analysis::Proportion all;
    for (const auto& one : own) all = {all.n + one.n, all.correct + one.correct};
    return analysis::wilson_interval(all);
  });
  findings.push_back(coverage(
      "accuracy with a class, Wilson of pooled trials", who, wilson,
      people.spread > 0.0 ? 0.8 : 0.93, people.spread > 0.0 ? 0.94 : 0.965,
      people.spread > 0.0 ? "pseudo-replication, of 5 trials each" : "people do not differ"));
}

}  // namespace

std::vector<Finding> coverage_findings(int repetitions) {
  std::vector<Finding> findings;
  for (const double spread : {0.0, 0.4, 0.6}) {
    for (const int participants : {8, 20}) {
      add_group_level({.d_prime = 1.5, .spread = spread}, participants, repetitions, findings);
    }
  }
  add_group_level({.d_prime = 2.0, .spread = 0.4, .lapse = 0.1}, 12, repetitions, findings);
  add_proportions(findings);
  add_d_prime(repetitions, findings);
  for (const int participants : {8, 20}) {
    add_differences(participants, 0.5, repetitions, findings);
  }
  add_odds_ratio(20, repetitions, findings);
  for (const int participants : {8, 20}) {
    add_odds_ratio_of_people(0.0, participants, repetitions, findings);
    add_odds_ratio_of_people(0.8, participants, repetitions, findings);
    add_pooled_d_prime(participants, repetitions, findings);
    add_class({.d_prime = 1.5, .spread = 0.0}, participants, repetitions, findings);
    add_class({.d_prime = 1.5, .spread = 0.6}, participants, repetitions, findings);
  }
  return findings;
}

}  // namespace touchtrial::recovery
