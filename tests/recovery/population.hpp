/// \file Simulated participants whose parameters are all known, and which an analysis must recover.
#pragma once

#include "analysis/statistics/confusion.hpp"
#include "core/plane.hpp"
#include "core/random.hpp"

#include <string>
#include <vector>

namespace touchtrial::recovery {

/// People who answer by signal detection: a class gives its own picture evidence d', every picture
/// gets standard normal noise and its bias, and the picture with the most evidence is the answer;
/// sometimes the answer is a guess.
struct Population {
  double d_prime = 1.75;         ///< mean over participants
  double spread = 0.0;           ///< standard deviation of d' between participants
  double lapse = 0.0;            ///< share of answers at random
  std::vector<double> bias{};    ///< evidence added to each picture; empty: none
  bool swaps_first_two = false;  ///< the first two labels are exchanged
  int classes = 5;
  int repeats = 5;  ///< presentations of each class per participant
};

/// P(answer | class) of somebody with this d', by quadrature.
[[nodiscard]] Plane<double> answer_probabilities(const Population& population, double d_prime);

/// The population's mean proportion correct if all classes are equally frequent.
[[nodiscard]] double true_accuracy(const Population& population);

/// Information transfer in bits from an unlimited number of answers, with d' at the population's
/// mean.
[[nodiscard]] double true_information(const Population& population);

/// The d' of one participant drawn from the population.
[[nodiscard]] double drawn_d_prime(const Population& population, RandomStream& random);

/// A participant's trials, in a balanced random order.
[[nodiscard]] std::vector<analysis::Choice> answers_of(const Population& population, double d_prime,
                                                       RandomStream& random);

/// One study with this number of participants.
[[nodiscard]] std::vector<std::vector<analysis::Choice>> study_of(const Population& population,
                                                                  int participants,
                                                                  RandomStream& random);

[[nodiscard]] analysis::ConfusionMatrix confusion_of(
    int classes, const std::vector<std::vector<analysis::Choice>>& study);

/// A similarity choice model's probabilities of answers: similarities 0.3 of the first two classes,
/// else 0.1.
/// \param bias  of the five answers, > 0
[[nodiscard]] Plane<double> luce_probabilities(const std::vector<double>& bias);
/// 3 : 2 : 2 : 2 : 1.
[[nodiscard]] std::vector<double> luce_bias();

/// Adds answers with these probabilities.
/// \param of_each  presentations of each class
void add_answers(const Plane<double>& p, int of_each, RandomStream& random,
                 analysis::ConfusionMatrix& confusion);
[[nodiscard]] analysis::ConfusionMatrix answers_with(const Plane<double>& p, int of_each,
                                                     RandomStream& random);

/// Each participant's right answers.
[[nodiscard]] std::vector<analysis::Proportion> accuracies(
    const std::vector<std::vector<analysis::Choice>>& study);
[[nodiscard]] std::vector<double> shares(const std::vector<analysis::Proportion>& accuracies);

/// People whose own probability of a right answer takes one of two values.
struct TwoKinds {
  std::string name;
  double share = 0.0;  ///< of the first kind
  double first = 0.0;  ///< their probability of a right answer
  double second = 0.0;
  int trials = 25;  ///< of a participant

  [[nodiscard]] double mean() const { return share * first + (1.0 - share) * second; }
  [[nodiscard]] double spread() const;
};

/// The right answers of each participant of one study.
[[nodiscard]] std::vector<analysis::Proportion> accuracies_of(const TwoKinds& people,
                                                              int participants,
                                                              RandomStream& random);

}  // namespace touchtrial::recovery
