/// \file Two methods, one after the other: the period-adjusted test and its interval, with people
/// who differ in how good they are, in how much better one method is to them, and in what they
/// learn from one period to the next; and the margin of non-inferiority.
#include "analysis/statistics/crossover.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "recovery/finding.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr double kLevel = 0.05;
constexpr double kBlockEffect = 0.17;
constexpr double kMargin = 0.07;
constexpr int kTrials = 40;  // of each method

struct CrossedPeople {
  int participants = 20;
  double effect = 0.0;  ///< mean accuracy with the first method less that with the second
  double period = 0.0;  ///< mean accuracy in the second period less that in the first
  double lost = 0.0;    ///< probability that a participant is not analysed
  double spread = 0.1;  ///< SD of the effect between participants

  [[nodiscard]] std::string words() const {
    std::string text =
        fmt::format("{} participants, block effect {:.0f} points, ", participants, 100.0 * period);
    text +=
        fmt::format("methods differ by {:.3g} points (SD {:.0f})", 100.0 * effect, 100.0 * spread);
    return lost > 0.0 ? text + fmt::format(", {:.0f} % lost", 100.0 * lost) : text;
  }
};

/// Partners in a block of two have one order each, dealt at random.
std::vector<analysis::CrossoverPerson> crossed(const CrossedPeople& people, RandomStream& random) {
  const auto share_of = [&](double probability) {
    int right = 0;
    for (int i = 0; i < kTrials; ++i) right += random.uniform() < probability ? 1 : 0;
    return static_cast<double>(right) / kTrials;
  };
  std::vector<analysis::CrossoverPerson> all;
  bool first_method_first = false;
  for (int i = 0; i < people.participants; ++i) {
    first_method_first = i % 2 == 0 ? random.uniform() < 0.5 : !first_method_first;
    const double middle = 0.6 + 0.1 * random.normal();
    const double effect = people.effect + people.spread * random.normal();
    const double learnt = people.period + 0.05 * random.normal();
    const double later = first_method_first ? -0.5 * learnt : 0.5 * learnt;
    const double first = share_of(middle + 0.5 * effect + later);
    const double second = share_of(middle - 0.5 * effect - later);
    if (random.uniform() < people.lost) continue;
    all.push_back({first - second, first_method_first, i / 2});
  }
  return all;
}

std::vector<double> differences(const std::vector<analysis::CrossoverPerson>& people) {
  std::vector<double> all;
  for (const analysis::CrossoverPerson& one : people) all.push_back(one.difference);
  return all;
}

double within_level(const std::optional<double>& p) {
  return p && *p <= kLevel ? 1.0 : 0.0;
}

using Rejects = double (*)(const std::vector<analysis::CrossoverPerson>&);

double adjusted_rejects(const std::vector<analysis::CrossoverPerson>& people) {
  return within_level(analysis::crossover_estimate(people, 0.0, analysis::Sides::two).p);
}

double deals_reject(const std::vector<analysis::CrossoverPerson>& people) {
  const auto found = analysis::crossover_permutation(people, 0.0, analysis::Sides::two);
  return found ? within_level(found->p) : 0.0;
}

double flips_reject(const std::vector<analysis::CrossoverPerson>& people) {
  return within_level(analysis::sign_flip_p(differences(people)));
}

double found_as_good(const std::vector<analysis::CrossoverPerson>& people) {
  return within_level(analysis::crossover_estimate(people, -kMargin, analysis::Sides::one).p);
}

Finding share_of_studies(const std::string& group, const std::string& what, double nominal,
                         const CrossedPeople& people, Rejects rejects,
                         std::pair<double, double> range, const std::string& why, int repetitions) {
  const Average share =
      average_of(repetitions, "crossover" + what + people.words(),
                 [&](RandomStream& random) { return rejects(crossed(people, random)); });
  return {group,       what,         people.words(),
          nominal,     share.mean,   share.standard_error,
          range.first, range.second, why};
}

void add_errors(int repetitions, std::vector<Finding>& findings) {
  const std::string steps = "shares of 40 trials are steps of 2.5 %";
  const auto add = [&](const std::string& what, const CrossedPeople& people, Rejects rejects,
                       std::pair<double, double> range, const std::string& why) {
    findings.push_back(
        share_of_studies("type-I error", what, kLevel, people, rejects, range, why, repetitions));
  };
  for (const CrossedPeople& people :
       {CrossedPeople{.participants = 8}, CrossedPeople{.participants = 8, .period = kBlockEffect},
        CrossedPeople{.participants = 20, .period = kBlockEffect},
        CrossedPeople{.participants = 20, .period = kBlockEffect, .lost = 0.25}}) {
    add("two methods in blocks, period-adjusted t", people, adjusted_rejects, {0.042, 0.056},
        steps);
  }
  const std::string counted = "deals are counted: .031 with 6 blocks, below .05 with more";
  for (const CrossedPeople& people :
       {CrossedPeople{.participants = 12, .period = kBlockEffect},
        CrossedPeople{.participants = 20, .period = kBlockEffect},
        CrossedPeople{.participants = 20, .period = kBlockEffect, .lost = 0.25}}) {
    add("two methods in blocks, orders dealt anew", people, deals_reject, {0.02, 0.05}, counted);
  }
  add("two methods in blocks, sign flips (not used)", {.participants = 20, .period = kBlockEffect},
      flips_reject, {0.0, 0.04},
      "the block effect is in the error, but balanced orders take it out of the mean");
  findings.push_back(
      share_of_studies("type-I error", "as good by a margin of 7 points, period-adjusted t", kLevel,
                       {.participants = 20, .effect = -kMargin, .period = kBlockEffect},
                       found_as_good, {0.042, 0.056}, steps, repetitions));
}

void add_powers(int repetitions, std::vector<Finding>& findings) {
  const auto add = [&](const std::string& what, double nominal, const CrossedPeople& people,
                       Rejects rejects, std::pair<double, double> range, const std::string& why) {
    findings.push_back(
        share_of_studies("power", what, nominal, people, rejects, range, why, repetitions));
  };
  const CrossedPeople still{.participants = 20, .effect = 0.085, .spread = 0.05};
  CrossedPeople learning = still;
  learning.period = kBlockEffect;
  add("two methods in blocks, period-adjusted t", 0.8, still, adjusted_rejects, {0.7, 0.9},
      "without a block effect");
  add("two methods in blocks, period-adjusted t", 0.8, learning, adjusted_rejects, {0.7, 0.9},
      "as without the block effect");
  add("two methods in blocks, orders dealt anew", 0.8, learning, deals_reject, {0.6, 0.85},
      "a little less than the t test");
  add("two methods in blocks, sign flips (not used)", 0.8, learning, flips_reject, {0.25, 0.45},
      "the block effect is in the error and takes more than half of the power");
}

void add_coverage(const CrossedPeople& people, double level, int repetitions,
                  std::vector<Finding>& findings) {
  const std::string what =
      fmt::format("two methods in blocks, period-adjusted t, {:.0f} %", 100.0 * level);
  const Average share =
      average_of(repetitions, "coverage" + what + people.words(), [&](RandomStream& random) {
        const auto found =
            analysis::crossover_estimate(crossed(people, random), 0.0, analysis::Sides::two, level);
        const analysis::Interval interval = found.interval.value();
        return interval.low <= people.effect && people.effect <= interval.high ? 1.0 : 0.0;
      });
  findings.push_back({"coverage", what, people.words(), level, share.mean, share.standard_error,
                      level - 0.01, level + 0.01, "shares of 40 trials are steps of 2.5 %"});
}

}  // namespace

std::vector<Finding> crossover_findings(int repetitions) {
  std::vector<Finding> findings;
  add_errors(repetitions, findings);
  add_powers(repetitions, findings);
  for (const int participants : {8, 20}) {
    add_coverage({.participants = participants, .effect = 0.05, .period = kBlockEffect}, 0.95,
                 repetitions, findings);
  }
  add_coverage({.participants = 20, .effect = -kMargin, .period = kBlockEffect}, 0.9, repetitions,
               findings);
  return findings;
}

}  // namespace touchtrial::recovery
