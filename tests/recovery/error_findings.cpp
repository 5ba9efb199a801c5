#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr double kLevel = 0.05;
constexpr int kDeals =
    399;  ///< of a Monte Carlo, fewer than in a report; level * (deals + 1) whole

double rejected(double p) {
  return p <= kLevel ? 1.0 : 0.0;
}

Finding error(const std::string& what, const std::string& population, const Average& share,
              double least, double most, const std::string& why) {
  return {"type-I error",       what,  population, kLevel, share.mean,
          share.standard_error, least, most,       why};
}

std::vector<analysis::AnsweredBlock> blocks_of(
    const std::vector<std::vector<analysis::Choice>>& study) {
  std::vector<analysis::AnsweredBlock> blocks;
  for (const auto& choices : study) {
    analysis::AnsweredBlock block;
    for (const analysis::Choice& choice : choices) {
      block.presented.push_back(choice.presented);
      block.answered.push_back(choice.answered);
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

void add_chance(int participants, double least, int repetitions, std::vector<Finding>& findings) {
  const Population guessing{.d_prime = 0.0, .bias = {0.8, 0.3, 0.0, -0.3, -0.8}};
  const std::string who =
      fmt::format("{} participants who feel nothing and prefer some answers", participants);
  const Average share = average_of(repetitions, "chance" + who, [&](RandomStream& random) {
    const auto blocks = blocks_of(study_of(guessing, participants, random));
    return rejected(
        analysis::chance_test(guessing.classes, blocks, analysis::OrderRule::permuted)->p);
  });
  findings.push_back(error("above chance, exact over balanced orders", who, share, least, kLevel,
                           "an exact test of whole numbers stays below its level"));
}

/// Differences between two equal methods, in people who differ.
std::vector<double> equal_methods(int participants, RandomStream& random) {
  const Population people{.d_prime = 1.5, .spread = 0.5};
  std::vector<double> differences;
  for (int i = 0; i < participants; ++i) {
    const double own = drawn_d_prime(people, random);
    const auto first = shares(accuracies({answers_of(people, own, random)}));
    const auto second = shares(accuracies({answers_of(people, own, random)}));
    differences.push_back(first.front() - second.front());
  }
  return differences;
}

void add_sign_flip(int participants, double least, double most, const std::string& why,
                   int repetitions, std::vector<Finding>& findings) {
  const std::string who = fmt::format("{} participants, two methods alike", participants);
  const Average share = average_of(repetitions, "sign flip" + who, [&](RandomStream& random) {
    return rejected(analysis::sign_flip_p(equal_methods(participants, random)).value_or(1.0));
  });
  findings.push_back(error("sign flips over participants", who, share, least, most, why));
}

void add_mcnemar(int repetitions, std::vector<Finding>& findings) {
  constexpr int kPairs = 60;
  const Average share = average_of(repetitions, "McNemar", [&](RandomStream& random) {
    std::array<int, 2> only{};
    for (int i = 0; i < kPairs; ++i) {
      const double p =
          0.5 + 0.3 * random.uniform();  // people differ, but their two trials have one p
      const bool first = random.uniform() < p;
      const bool second = random.uniform() < p;
      if (first != second) ++only[first ? 0 : 1];
    }
    return rejected(analysis::mcnemar_mid_p(only[0], only[1]));
  });
  findings.push_back(error("McNemar, mid-p", fmt::format("{} people, one pair each", kPairs), share,
                           0.035, 0.055, "mid-p may exceed its level slightly; whole numbers"));
}

using Occasions = std::vector<std::vector<bool>>;

/// Three methods that are equally good on average.
/// \param taste  SD between participants of the accuracy with each method
Occasions occasions_of(double taste, RandomStream& random) {
  constexpr int kOccasions = 25;
  std::array<double, 3> p{};
  for (double& one : p) one = std::clamp(0.6 + taste * random.normal(), 0.05, 0.95);
  Occasions occasions;
  for (int i = 0; i < kOccasions; ++i) {
    occasions.push_back(
        {random.uniform() < p[0], random.uniform() < p[1], random.uniform() < p[2]});
  }
  return occasions;
}

void add_cochran(double taste, double least, double most, const std::string& why, int repetitions,
                 std::vector<Finding>& findings) {
  constexpr int kParticipants = 12;
  const std::string who =
      fmt::format("{} participants, three methods alike on average, own likings of SD {}",
                  kParticipants, taste);
  const auto study = [&](RandomStream& random) {
    std::vector<Occasions> all;
    for (int i = 0; i < kParticipants; ++i) all.push_back(occasions_of(taste, random));
    return all;
  };
  const Average share = average_of(repetitions, "Cochran" + who, [&](RandomStream& random) {
    Occasions together;
    for (const Occasions& mine : study(random))
      together.insert(together.end(), mine.begin(), mine.end());
    const auto q = analysis::cochran_q(together);
    return q ? rejected(q->p) : 0.0;
  });
  findings.push_back(error("Cochran's Q, chi-square", who, share, least, most, why));
  const Average permuted = average_of(repetitions / 4, "permuted" + who, [&](RandomStream& random) {
    return rejected(analysis::cochran_q_permuted_p(study(random), kDeals).value_or(1.0));
  });
  findings.push_back(error("Cochran's Q, methods exchanged within participants", who, permuted,
                           0.04, kLevel, "equal statistics count as extreme"));
}

void add_holm(int repetitions, std::vector<Finding>& findings) {
  constexpr int kParticipants = 12;
  const std::string who = fmt::format("{} participants, three methods alike", kParticipants);
  const Average share = average_of(repetitions, "Holm", [&](RandomStream& random) {
    std::array<std::vector<double>, 3> accuracy;
    const Population people{.d_prime = 1.5, .spread = 0.5};
    for (int i = 0; i < kParticipants; ++i) {
      const double own = drawn_d_prime(people, random);
      for (auto& method : accuracy) {
        method.push_back(shares(accuracies({answers_of(people, own, random)})).front());
      }
    }
    std::vector<double> p;
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      std::vector<double> differences;
      for (int i = 0; i < kParticipants; ++i)
        differences.push_back(accuracy[a][i] - accuracy[b][i]);
      p.push_back(analysis::sign_flip_p(differences).value_or(1.0));
    }
    return rejected(std::ranges::min(analysis::holm_adjusted(p)));
  });
  findings.push_back(error("any of three pairs, Holm", who, share, 0.03, kLevel,
                           "pairs share participants: Holm is on the safe side"));
}

/// Groups of classes that feel alike; the rest is answered right, but for 5 % at random.
Plane<double> alike_within(const std::vector<std::vector<int>>& groups) {
  constexpr double kRandom = 0.05;
  Plane<double> p(5, 5, kRandom / 5.0);
  for (const auto& group : groups) {
    for (const int i : group) {
      for (const int j : group) p.at(i, j) += (1.0 - kRandom) / static_cast<double>(group.size());
    }
  }
  return p;
}

/// A study of 20 people who answer 5 presentations of each of 5 classes with these probabilities.
double any_swap(const Plane<double>& p, RandomStream& random) {
  std::vector<double> p_values;
  for (int person = 0; person < 20; ++person) {
    const analysis::ConfusionMatrix own = answers_with(p, 5, random);
    p_values.push_back(analysis::label_swap_p(own, analysis::best_label_matching(own)));
  }
  return rejected(std::ranges::min(analysis::benjamini_hochberg_adjusted(p_values)));
}

void add_swaps(int repetitions, std::vector<Finding>& findings) {
  const auto add = [&](const std::string& who, const Plane<double>& p) {
    const Average share = average_of(repetitions, "swaps" + who,
                                     [&](RandomStream& random) { return any_swap(p, random); });
    findings.push_back(error("labels said to be swapped, by anybody", who, share, 0.0, kLevel,
                             "whole numbers, and a correction for the choice of the exchange"));
  };
  add("20 guessers", Plane<double>(5, 5, 0.2));
  add("20 people to whom two classes feel alike", alike_within({{0, 1}, {2}, {3}, {4}}));
  add("20 people to whom two pairs of classes feel alike", alike_within({{0, 1}, {2, 3}, {4}}));
  add("20 people to whom three classes feel alike", alike_within({{0, 1, 2}, {3}, {4}}));
  add("20 people to whom four classes feel alike", alike_within({{0, 1, 2, 3}, {4}}));
}

}  // namespace

std::vector<Finding> error_findings(int repetitions) {
  std::vector<Finding> findings;
  add_chance(1, 0.015, repetitions, findings);
  add_chance(20, 0.035, repetitions, findings);
  add_sign_flip(5, 0.0, 0.0, "with 5 participants p is never below 0.0625", repetitions, findings);
  add_sign_flip(8, 0.03, kLevel, "equal differences count as extreme", repetitions, findings);
  add_sign_flip(20, 0.04, kLevel, "equal differences count as extreme", repetitions, findings);
  add_mcnemar(repetitions, findings);
  add_cochran(0.0, 0.04, 0.055, "an approximation", repetitions, findings);
  add_cochran(0.15, 0.10, 0.45, "people like methods differently: occasions are not independent",
              repetitions, findings);
  add_holm(repetitions, findings);
  add_swaps(repetitions, findings);
  return findings;
}

}  // namespace touchtrial::recovery
