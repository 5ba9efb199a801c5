#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/order_effects.hpp"
#include "analysis/statistics/strata.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr double kErrorLevel = 0.05;
constexpr int kManyPeople = 40'000;  ///< of whom a truth without a formula is the mean

double covers(const analysis::Interval& interval, double truth) {
  return interval.low <= truth && truth <= interval.high ? 1.0 : 0.0;
}

Finding coverage_of(const std::string& what, const std::string& who, const Average& share,
                    double least, double most, const std::string& why) {
  return {"coverage", what, who, 0.95, share.mean, share.standard_error, least, most, why};
}

// --- Unbiased hit rate ---

double mean_hit_rate(int classes, const std::vector<analysis::Choice>& choices) {
  const analysis::ConfusionMatrix own(classes, choices);
  double sum = 0.0;
  for (int i = 0; i < classes; ++i) sum += analysis::unbiased_hit_rate(own, i).value_or(0.0);
  return sum / classes;
}

void add_hit_rates(int participants, int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = 1.5, .spread = 0.6, .bias = {0.8, 0.3, 0.0, -0.3, -0.8}};
  const std::string who = fmt::format(
      "{} participants, d' 1.5 (SD 0.6), bias 0.8 to -0.8, 25 trials each", participants);
  const auto rate_of = [&](const auto& choices, bool of_class) {
    return of_class
               ? *analysis::unbiased_hit_rate(analysis::ConfusionMatrix(people.classes, choices), 0)
               : mean_hit_rate(people.classes, choices);
  };
  for (const bool of_class : {false, true}) {
    RandomStream many(1, "hit rates, truth");
    double truth = 0.0;
    for (int i = 0; i < kManyPeople; ++i) {
      truth += rate_of(answers_of(people, drawn_d_prime(people, many), many), of_class);
    }
    truth /= kManyPeople;
    const Average share = average_of(repetitions, "hit rates" + who, [&](RandomStream& random) {
      std::vector<double> rates;
      for (const auto& choices : study_of(people, participants, random)) {
        rates.push_back(rate_of(choices, of_class));
      }
      return covers(analysis::participant_mean(rates).interval, truth);
    });
    findings.push_back(coverage_of(
        of_class ? "unbiased hit rate of the preferred class, t" : "mean unbiased hit rate, t", who,
        share, 0.925, 0.965, "of what 25 trials give on average, which is more than many would"));
  }
}

// --- Order ---

analysis::FeltBlock felt_block(const std::vector<analysis::Choice>& choices) {
  analysis::FeltBlock block;
  for (const analysis::Choice& choice : choices) {
    analysis::FeltTrial trial{choice.presented, choice.answered, !block.empty()};
    trial.place = static_cast<double>(block.size()) + 1.0;
    block.push_back(trial);
  }
  return block;
}

/// Answers of people who give the answer before once more in some trials.
void repeat_answers(double share, std::vector<analysis::Choice>& choices, RandomStream& random) {
  for (std::size_t i = 1; i < choices.size(); ++i) {
    if (random.uniform() < share) choices[i].answered = choices[i - 1].answered;
  }
}

struct OrderRejections {
  double slope = 0.0;
  double class_before = 0.0;
  double answer_before = 0.0;
};

OrderRejections order_rejections(const Population& people, double repeated, RandomStream& random) {
  constexpr int kFewDraws = 199;
  std::vector<std::vector<analysis::FeltBlock>> participants;
  for (auto& choices : study_of(people, 20, random)) {
    repeat_answers(repeated, choices, random);
    participants.push_back({felt_block(choices)});
  }
  const auto found = *analysis::order_effects(participants, {}, kFewDraws, random.bits());
  const auto rejects = [](std::optional<double> p) {
    return p.value_or(1.0) <= kErrorLevel ? 1.0 : 0.0;
  };
  return {rejects(found.slope_p), rejects(found.class_before.p), rejects(found.answer_before.p)};
}

void add_order(const Population& people, const std::string& who, int repetitions,
               std::vector<Finding>& findings) {
  const auto add = [&](const char* what, double OrderRejections::*which, double least) {
    const Average share = average_of(repetitions, "order" + who, [&](RandomStream& random) {
      return order_rejections(people, 0.0, random).*which;
    });
    findings.push_back({"type-I error", what, who, kErrorLevel, share.mean, share.standard_error,
                        least, kErrorLevel,
                        least < kErrorLevel ? "equal orders count as extreme" : ""});
  };
  add("learning, by permuted orders", &OrderRejections::slope, 0.045);
  add("wrong answers name the texture before", &OrderRejections::class_before, 0.035);
  add("wrong answers repeat the answer before", &OrderRejections::answer_before, 0.035);
}

void add_repetition(int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = 1.5, .spread = 0.6};
  const Average share = average_of(repetitions, "repeated answers", [&](RandomStream& random) {
    return order_rejections(people, 0.1, random).answer_before;
  });
  findings.push_back({"recovered", "share of studies in which repeated answers are found",
                      "20 participants, d' 1.5 (SD 0.6), one answer in ten repeats the one before",
                      1.0, share.mean, share.standard_error, 0.8, 1.0, "the power of the test"});
}

/// Somebody's right answers in 25 trials, whose probability rises by `slope` a trial.
analysis::FeltBlock learner(double middle, double slope, RandomStream& random) {
  std::vector<analysis::Choice> choices;
  for (int i = 0; i < 25; ++i) {
    const bool right = random.uniform() < middle + slope * (i - 12);
    choices.push_back({i % 5, right ? i % 5 : (i + 1) % 5});
  }
  return felt_block(choices);
}

void add_learning(int participants, int repetitions, std::vector<Finding>& findings) {
  constexpr double kSlope = 0.008;
  const std::string who = fmt::format(
      "{} participants, 30 to 70 % right, slopes of 0.008 (SD 0.004) a trial", participants);
  const Average share = average_of(repetitions, "learning" + who, [&](RandomStream& random) {
    std::vector<std::vector<analysis::FeltBlock>> people;
    for (int i = 0; i < participants; ++i) {
      const double middle = random.uniform(0.3, 0.7);
      people.push_back({learner(middle, kSlope + 0.004 * random.normal(), random)});
    }
    return covers(analysis::order_effects(people, {}, 1)->slope.interval, kSlope);
  });
  findings.push_back(coverage_of("slope of learning, t over participants", who, share, 0.94, 0.96,
                                 "an approximation"));
}

// --- Confidence ---

/// Somebody's 25 answers among two alternatives, rated from 1 to 4 by the evidence for them.
/// `insight` is the share of the evidence that the rating knows.
std::vector<analysis::RatedAnswer> rated_answers(double d_prime, double insight,
                                                 RandomStream& random) {
  std::vector<analysis::RatedAnswer> answers;
  for (int i = 0; i < 25; ++i) {
    const double evidence = d_prime + random.normal();
    const double known = insight * std::abs(evidence) + (1.0 - insight) * std::abs(random.normal());
    answers.push_back({1 + static_cast<int>(std::min(3.0, 2.0 * known)), evidence > 0.0});
  }
  return answers;
}

/// Areas of people who differ in how well they do and in how well they know it.
std::vector<double> drawn_areas(int participants, RandomStream& random) {
  std::vector<double> areas;
  for (int i = 0; i < participants; ++i) {
    const double d_prime = 0.8 + 0.4 * random.normal();
    const auto area =
        analysis::type_2_area(rated_answers(d_prime, random.uniform(0.2, 1.0), random));
    if (area) areas.push_back(*area);
  }
  return areas;
}

void add_confidence(int participants, int repetitions, std::vector<Finding>& findings) {
  RandomStream many(1, "areas, truth");
  const double truth = analysis::mean_of(drawn_areas(kManyPeople, many));
  const std::string who = fmt::format(
      "{} participants, d' 0.8 (SD 0.4), who know between a fifth and all of their "
      "evidence",
      participants);
  const Average share = average_of(repetitions, "areas" + who, [&](RandomStream& random) {
    return covers(analysis::participant_mean(drawn_areas(participants, random)).interval, truth);
  });
  findings.push_back(coverage_of("area under the type-2 ROC curve, t over participants", who, share,
                                 0.93, 0.965, "areas of few wrong answers are steps, and skewed"));
}

void add_calibration(int participants, int repetitions, std::vector<Finding>& findings) {
  const auto own_share = [](RandomStream& random) {
    analysis::Proportion own;
    for (const auto& one : rated_answers(0.8 + 0.4 * random.normal(), 0.6, random)) {
      if (one.rating != 3) continue;
      ++own.n;
      own.correct += one.correct ? 1 : 0;
    }
    return own.share();
  };
  RandomStream many(1, "calibration, truth");
  std::vector<double> all;
  for (int i = 0; i < kManyPeople; ++i) {
    if (const auto share = own_share(many)) all.push_back(*share);
  }
  const double truth = analysis::mean_of(all);
  const std::string who = fmt::format("{} participants, d' 0.8 (SD 0.4)", participants);
  const Average share = average_of(repetitions, "calibration" + who, [&](RandomStream& random) {
    std::vector<double> shares;
    for (int i = 0; i < participants; ++i) {
      if (const auto one = own_share(random)) shares.push_back(*one);
    }
    return covers(analysis::participant_mean(shares).interval, truth);
  });
  findings.push_back(
      coverage_of("accuracy of the answers rated 3 of 4, t over participants", who, share, 0.895,
                  0.965, "few answers of each participant, most of them right: too narrow"));
}

// --- Stations ---

/// Accuracies of 25 trials at stations whose means are known.
std::vector<std::vector<double>> at_stations(const std::vector<double>& means, int participants,
                                             RandomStream& random) {
  std::vector<std::vector<double>> stations;
  for (const double mean : means) {
    std::vector<double>& own = stations.emplace_back();
    for (int i = 0; i < participants; ++i) {
      const double p = std::clamp(mean + 0.1 * random.normal(), 0.0, 1.0);
      int right = 0;
      for (int trial = 0; trial < 25; ++trial) right += random.uniform() < p ? 1 : 0;
      own.push_back(right / 25.0);
    }
  }
  return stations;
}

void add_stations(int repetitions, std::vector<Finding>& findings) {
  const std::vector<double> three = {0.4, 0.55, 0.7};
  const Average fixed = average_of(repetitions, "stations", [&](RandomStream& random) {
    const auto found = analysis::stratified_mean(at_stations(three, 6, random));
    return covers(*found->interval, 0.55);
  });
  findings.push_back(coverage_of("mean at these stations, stations fixed",
                                 "3 stations of 6 participants, means 0.4, 0.55 and 0.7 (SD 0.1)",
                                 fixed, 0.935, 0.965, "an approximation"));
  for (const int number : {6, 10}) {
    const std::string who =
        fmt::format("{} stations of 4 participants, means 0.55 (SD 0.1)", number);
    const auto share = [&](bool random_stations) {
      return average_of(repetitions, "stations" + who, [&](RandomStream& random) {
        std::vector<double> means;
        for (int i = 0; i < number; ++i) means.push_back(0.55 + 0.1 * random.normal());
        const auto found = analysis::stratified_mean(at_stations(means, 4, random));
        if (random_stations && !found->random) return 0.0;
        return covers(random_stations ? found->random->interval : *found->interval, 0.55);
      });
    };
    findings.push_back(coverage_of("mean over stations, stations random", who, share(true), 0.93,
                                   0.965, "an approximation"));
    findings.push_back(coverage_of("mean over stations, stations fixed", who, share(false), 0.5,
                                   0.9, "says nothing of other stations"));
  }
}

}  // namespace

std::vector<Finding> measures_findings(int repetitions) {
  std::vector<Finding> findings;
  for (const int participants : {8, 20}) {
    add_hit_rates(participants, repetitions, findings);
    add_learning(participants, repetitions, findings);
    add_confidence(participants, repetitions, findings);
    add_calibration(participants, repetitions, findings);
  }
  add_stations(repetitions, findings);
  add_order({.d_prime = 0.0, .bias = {0.8, 0.3, 0.0, -0.3, -0.8}},
            "20 participants who feel nothing and prefer some answers", repetitions, findings);
  add_order({.d_prime = 1.5, .spread = 0.6, .lapse = 0.05},
            "20 participants, d' 1.5 (SD 0.6), lapse 0.05", repetitions, findings);
  add_repetition(repetitions, findings);
  return findings;
}

}  // namespace touchtrial::recovery
