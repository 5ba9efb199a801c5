#include "protocols/identification/analysis/cues/cue_statistics.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <array>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

using analysis::identification::AnswerShares;
using analysis::identification::CueStatistics;
using analysis::identification::ParticipantAnswers;

constexpr int kClasses = 5;

AnswerShares row_of(const Plane<double>& p, int row) {
  const auto values = p.row(row);
  return {values.begin(), values.end()};
}

/// The probabilities of answers, averaged over people.
Plane<double> mean_probabilities(const Population& people) {
  constexpr int kPeople = 400;
  Plane<double> mean(kClasses, kClasses);
  RandomStream random(1, "mean probabilities");
  for (int k = 0; k < kPeople; ++k) {
    const Plane<double> own = answer_probabilities(people, drawn_d_prime(people, random));
    for (int i = 0; i < kClasses; ++i) {
      for (int j = 0; j < kClasses; ++j) mean.at(i, j) += own.at(i, j) / kPeople;
    }
  }
  return mean;
}

/// Every error of a class is the next one's, with this share of errors as they are in `p`.
Plane<double> erring_to(const Plane<double>& p, int steps) {
  constexpr double kKept = 0.5;
  Plane<double> moved = p;
  for (int i = 0; i < kClasses; ++i) {
    for (int j = 0; j < kClasses; ++j) {
      if (i == j) continue;
      moved.at(i, j) -= (1.0 - kKept) * p.at(i, j);
      moved.at(i, (i + steps) % kClasses) += (1.0 - kKept) * p.at(i, j);
    }
  }
  return moved;
}

/// The numbers of one study, with observers whose probabilities of answers are known.
CueStatistics study_with(const Population& people, int participants,
                         const std::array<Plane<double>, 3>& observers, RandomStream& random) {
  std::vector<ParticipantAnswers> all;
  for (const auto& choices : study_of(people, participants, random)) {
    ParticipantAnswers& one = all.emplace_back("P" + std::to_string(all.size()), kClasses);
    for (const analysis::Choice& choice : choices) {
      std::array<AnswerShares, 3> shares;
      for (std::size_t k = 0; k < shares.size(); ++k) {
        shares[k] = row_of(observers[k], choice.presented);
      }
      one.add({choice.presented, choice.answered, shares, shares});
    }
  }
  return analysis::identification::cue_divergences(all);
}

double divergence_of(const Plane<double>& a, const Plane<double>& b) {
  return analysis::identification::answer_divergence(a.samples(), b.samples(), kClasses)
      .value_or(0.0);
}

std::string described(const Population& people, int participants, const std::string& observer) {
  return fmt::format("{} participants, d' {} (SD {}), {}", participants, people.d_prime,
                     people.spread, observer);
}

void add_divergence(const Population& people, int participants, bool alike, int repetitions,
                    std::vector<Finding>& findings) {
  const Plane<double> mean = mean_probabilities(people);
  const Plane<double> observer = alike ? mean : erring_to(mean, 1);
  const double truth = divergence_of(mean, observer);
  const std::string who =
      described(people, participants,
                alike ? "an observer who confuses alike" : "an observer with other confusions");
  const auto averages = averages_of(repetitions, "divergence" + who, [&](RandomStream& random) {
    const analysis::identification::CueFigure found =
        study_with(people, participants, {observer, observer, observer}, random).divergence[0];
    const bool is_covered =
        found.interval && found.interval->low <= truth && truth <= found.interval->high;
    return std::vector<double>{is_covered ? 1.0 : 0.0, found.value.value_or(0.0)};
  });
  const Average& covered = averages[0];
  const Average& value = averages[1];
  findings.push_back({"coverage", "divergence of confusions, jackknife", who, 0.95, covered.mean,
                      covered.standard_error, 0.92, alike ? 1.0 : 0.975,
                      alike ? "0 is the least possible divergence, and in the interval"
                            : "few answers to each class"});
  findings.push_back({"bias", "divergence of confusions, jackknife, bit", who, 0.0,
                      value.mean - truth, value.standard_error, -0.01, alike ? 0.012 : 0.005,
                      alike ? "cut at 0" : "to the first order"});
}

void add_told_apart(const Population& people, int participants, int repetitions,
                    std::vector<Finding>& findings) {
  const Plane<double> mean = mean_probabilities(people);
  const std::array<Plane<double>, 3> observers{erring_to(mean, 1), erring_to(mean, 2),
                                               Plane<double>(kClasses, kClasses, 0.2)};
  const std::string who =
      described(people, participants, "two observers as far from them, one farther");
  const Average share = average_of(repetitions, "told apart" + who, [&](RandomStream& random) {
    const auto match = study_with(people, participants, observers, random).match;
    return match && match->is_distinct ? 1.0 : 0.0;
  });
  findings.push_back({"type-I error", "observers told apart, jackknife", who, 0.05, share.mean,
                      share.standard_error, 0.02, 0.07, "an approximation"});
}

}  // namespace

std::vector<Finding> cue_findings(int repetitions) {
  std::vector<Finding> findings;
  for (const int participants : {8, 20}) {
    for (const double spread : {0.0, 0.6}) {
      const Population people{.d_prime = 1.5, .spread = spread};
      add_divergence(people, participants, true, repetitions / 4, findings);
      add_divergence(people, participants, false, repetitions / 4, findings);
      add_told_apart(people, participants, repetitions / 4, findings);
    }
  }
  return findings;
}

}  // namespace touchtrial::recovery
