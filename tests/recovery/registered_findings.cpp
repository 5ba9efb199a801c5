/// \file The registered question: the t test against chance, looks at outcomes, the spread between
/// participants and the prevalence.
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/group_sequential.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/statistics/prevalence.hpp"
#include "analysis/statistics/spread.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <span>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr double kLevel = 0.05;
constexpr double kChance = 0.2;

std::vector<TwoKinds> populations_at_chance() {
  return {{"guess", 1.0, kChance, kChance},
          {"guess, but one in ten is right in 65 % (15 % of the others)", 0.1, 0.65, 0.15},
          {"guess 25 %, but one in five is never right", 0.2, 0.0, 0.25}};
}

double rejects(double p) {
  return p <= kLevel ? 1.0 : 0.0;
}

std::string who(int participants, const TwoKinds& people) {
  return fmt::format("{} participants who {}", participants, people.name);
}

Finding error(const std::string& what, const std::string& population, const Average& share,
              double least, double most, const std::string& why) {
  return {"type-I error",       what,  population, kLevel, share.mean,
          share.standard_error, least, most,       why};
}

/// \param ranges  of the error with 3, 8 and 20 participants
void add_mean_test(const TwoKinds& people, std::span<const std::pair<double, double>> ranges,
                   const std::string& why, int repetitions, std::vector<Finding>& findings) {
  const int sizes[] = {3, 8, 20};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::string population = who(sizes[i], people);
    const Average share =
        average_of(repetitions, "mean test" + population, [&](RandomStream& random) {
          const auto accuracy = shares(accuracies_of(people, sizes[i], random));
          return rejects(*analysis::t_test_p(accuracy, kChance, analysis::Sides::one));
        });
    findings.push_back(error("mean against chance, t, one-sided", population, share,
                             ranges[i].first, ranges[i].second, why));
  }
}

void add_mean_tests(int repetitions, std::vector<Finding>& findings) {
  const auto people = populations_at_chance();
  using Ranges = std::vector<std::pair<double, double>>;
  add_mean_test(people[0], Ranges{{0.03, 0.05}, {0.03, 0.05}, {0.036, 0.05}},
                "shares of 25 trials are steps of 4 % and a little skewed", repetitions, findings);
  add_mean_test(people[1], Ranges{{0.0, 0.05}, {0.0, 0.05}, {0.0, 0.05}},
                "skewed to the right: a few good people raise the SD as well", repetitions,
                findings);
  add_mean_test(people[2], Ranges{{0.06, 0.10}, {0.05, 0.09}, {0.045, 0.07}},
                "skewed to the left: above its level with few people", repetitions, findings);
}

/// Sign flips of the distances from chance, which assume symmetry.
void add_flips_about_chance(int repetitions, std::vector<Finding>& findings) {
  const TwoKinds people = populations_at_chance()[1];
  const std::string population = who(20, people);
  const Average share = average_of(repetitions, "flips" + population, [&](RandomStream& random) {
    std::vector<double> distances = shares(accuracies_of(people, 20, random));
    for (double& one : distances) one -= kChance;
    return rejects(*analysis::sign_flip_p(distances, analysis::Sides::one));
  });
  findings.push_back(error("mean against chance, sign flips (not used)", population, share, 0.0,
                           0.03, "accuracies are not symmetric about chance"));
}

/// One study that is looked at; rejects at the first look whose p is within its level.
double rejects_at_any(std::span<const int> looks, std::span<const double> levels,
                      RandomStream& random) {
  const TwoKinds guessing = populations_at_chance()[0];
  const auto accuracy = shares(accuracies_of(guessing, looks.back(), random));
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const auto so_far = std::span(accuracy).first(static_cast<std::size_t>(looks[i]));
    if (*analysis::t_test_p(so_far, kChance, analysis::Sides::one) <= levels[i]) return 1.0;
  }
  return 0.0;
}

void add_looks(int repetitions, std::vector<Finding>& findings) {
  const std::vector<int> looks = {8, 14, 20};
  const std::vector<double> shares = {0.4, 0.7, 1.0};
  const auto add = [&](const std::string& what, const std::vector<double>& levels, double least,
                       double most, const std::string& why) {
    const Average share = average_of(repetitions, "looks" + what, [&](RandomStream& random) {
      return rejects_at_any(looks, levels, random);
    });
    findings.push_back(error("mean against chance, looks at 8, 14 and 20, " + what,
                             "20 participants who guess", share, least, most, why));
  };
  add("unadjusted", {kLevel, kLevel, kLevel}, 0.07, 0.11, "every look may reject");
  using enum analysis::AlphaSpending;
  add("O'Brien and Fleming's spending",
      analysis::nominal_levels(kLevel, analysis::Sides::one, obrien_fleming, shares), 0.033, 0.05,
      "as the t test without looks");
  add("Pocock's spending", analysis::nominal_levels(kLevel, analysis::Sides::one, pocock, shares),
      0.03, 0.05, "as the t test without looks");
}

bool covers(const analysis::Interval& interval, double truth) {
  return interval.low <= truth + 1e-12 && truth <= interval.high + 1e-12;
}

/// \param least,most  of the coverage
void add_spread(const TwoKinds& people, int participants, double least, double most,
                const std::string& why, int repetitions, std::vector<Finding>& findings) {
  const double truth = people.spread();
  const std::string population = who(participants, people);
  const Average share = average_of(repetitions, "spread" + population, [&](RandomStream& random) {
    const auto found = analysis::spread_of(accuracies_of(people, participants, random));
    return found && covers(found->interval, truth) ? 1.0 : 0.0;
  });
  findings.push_back({"coverage", "SD between participants, Q profile", population, 0.95,
                      share.mean, share.standard_error, least, most, why});
}

void add_spreads(int repetitions, std::vector<Finding>& findings) {
  const TwoKinds alike{"are right in 60 %", 1.0, 0.6, 0.6};
  const TwoKinds even{"are right in 70 % or 50 %, half each", 0.5, 0.7, 0.5};
  const TwoKinds some{"are right in 90 %, or in two of three cases 20 %", 1.0 / 3.0, 0.9, 0.2};
  const TwoKinds few{"guess, but one in ten is always right", 0.1, 1.0, 0.2};
  for (const int participants : {8, 20}) {
    add_spread(alike, participants, 0.94, 1.0, "0 is at the end of the scale", repetitions,
               findings);
    add_spread(even, participants, 0.94, 1.0, "accuracies with short tails", repetitions, findings);
    add_spread(some, participants, 0.93, 1.0, "accuracies with short tails", repetitions, findings);
  }
  add_spread(few, 20, 0.6, 0.9, "a few outliers: chi-square does not hold", repetitions, findings);
}

/// Uneven trials: the mean and its interval weigh every participant the same.
void add_uneven_trials(int repetitions, std::vector<Finding>& findings) {
  const TwoKinds able{"are right in 90 %, with 10 trials, or 30 %, with 40", 1.0, 0.9, 0.9, 10};
  const TwoKinds unable{"", 1.0, 0.3, 0.3, 40};
  const double truth = 0.6;
  const Average share = average_of(repetitions, "uneven", [&](RandomStream& random) {
    std::vector<analysis::Proportion> all;
    for (int i = 0; i < 20; ++i) {
      const bool first = random.uniform() < 0.5;
      all.push_back(accuracies_of(first ? able : unable, 1, random).front());
    }
    return covers(analysis::participant_mean(shares(all)).interval, truth) ? 1.0 : 0.0;
  });
  findings.push_back({"coverage", "mean over participants, t, uneven trials", who(20, able), 0.95,
                      share.mean, share.standard_error, 0.93, 0.965,
                      "two values are far from normal"});
}

/// \param share  of people who are right in 90 % of 25 trials; the others guess
void add_prevalence(double share, double least, double most, const std::string& why,
                    int repetitions, std::vector<Finding>& findings) {
  constexpr int kParticipants = 20;
  const Population able{.d_prime = 4.0};
  const Population unable{.d_prime = 0.0};
  const std::string population =
      fmt::format("{} participants, {} % of people can", kParticipants, 100.0 * share);
  const Average covered =
      average_of(repetitions, "prevalence" + population, [&](RandomStream& random) {
        analysis::Proportion passed;
        double level = 0.0;
        for (int i = 0; i < kParticipants; ++i) {
          const Population& one = random.uniform() < share ? able : unable;
          analysis::AnsweredBlock block;
          for (const analysis::Choice& choice : answers_of(one, one.d_prime, random)) {
            block.presented.push_back(choice.presented);
            block.answered.push_back(choice.answered);
          }
          const auto test = analysis::chance_test(one.classes, std::span(&block, 1),
                                                  analysis::OrderRule::permuted);
          ++passed.n;
          if (test->p <= kLevel) ++passed.correct;
          level += test->attainable / kParticipants;
        }
        return covers(analysis::prevalence_of(passed, level)->interval, share) ? 1.0 : 0.0;
      });
  findings.push_back({"coverage", "prevalence, highest posterior density", population, 0.95,
                      covered.mean, covered.standard_error, least, most, why});
}

}  // namespace

std::vector<Finding> registered_findings(int repetitions) {
  std::vector<Finding> findings;
  add_mean_tests(repetitions, findings);
  add_flips_about_chance(repetitions, findings);
  add_looks(repetitions, findings);
  add_spreads(repetitions, findings);
  add_uneven_trials(repetitions, findings);
  for (const double share : {0.1, 0.5, 0.9}) {
    add_prevalence(share, 0.92, 1.0, "passes are whole numbers: coverage jumps with the share",
                   repetitions / 4, findings);
  }
  return findings;
}

}  // namespace touchtrial::recovery
