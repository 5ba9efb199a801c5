#include "recovery/population.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/trapezoidal.hpp>

namespace touchtrial::recovery {
namespace {

/// Beyond this number of standard deviations the density is negligible.
constexpr double kTail = 9.0;

double density(double z) {
  return boost::math::pdf(boost::math::normal(), z);
}

double share_below(double z) {
  return boost::math::cdf(boost::math::normal(), z);
}

/// The class whose picture gets the evidence of `presented`.
int felt_as(const Population& population, int presented) {
  return population.swaps_first_two && presented < 2 ? 1 - presented : presented;
}

/// Mean evidence of every picture.
std::vector<double> evidence(const Population& population, int presented, double d_prime) {
  std::vector<double> means = population.bias;
  means.resize(static_cast<std::size_t>(population.classes), 0.0);
  means[felt_as(population, presented)] += d_prime;
  return means;
}

/// The probability that picture `answer` has the strongest evidence.
double strongest(const std::vector<double>& means, int answer) {
  const auto others_below = [&](double noise) {
    const double own = means[answer] + noise;
    double probability = density(noise);
    for (std::size_t k = 0; k < means.size(); ++k) {
      if (static_cast<int>(k) != answer) probability *= share_below(own - means[k]);
    }
    return probability;
  };
  return boost::math::quadrature::trapezoidal(others_below, -kTail, kTail, 1e-10);
}

double accuracy_at(const Population& population, double d_prime) {
  const Plane<double> probabilities = answer_probabilities(population, d_prime);
  double sum = 0.0;
  for (int i = 0; i < population.classes; ++i) sum += probabilities.at(i, i);
  return sum / population.classes;
}

}  // namespace

Plane<double> answer_probabilities(const Population& population, double d_prime) {
  const int classes = population.classes;
  Plane<double> probabilities(classes, classes);
  for (int i = 0; i < classes; ++i) {
    const std::vector<double> means = evidence(population, i, d_prime);
    for (int j = 0; j < classes; ++j) {
      probabilities.at(i, j) =
          (1.0 - population.lapse) * strongest(means, j) + population.lapse / classes;
    }
  }
  return probabilities;
}

double true_accuracy(const Population& population) {
  if (population.spread == 0.0) return accuracy_at(population, population.d_prime);
  const auto weighted = [&](double z) {
    return density(z) * accuracy_at(population, population.d_prime + population.spread * z);
  };
  constexpr double kWide = 6.0;
  return boost::math::quadrature::trapezoidal(weighted, -kWide, kWide, 1e-6);
}

double true_information(const Population& population) {
  const Plane<double> given = answer_probabilities(population, population.d_prime);
  const int classes = population.classes;
  double bits = 0.0;
  for (int j = 0; j < classes; ++j) {
    double answered = 0.0;
    for (int i = 0; i < classes; ++i) answered += given.at(i, j) / classes;
    for (int i = 0; i < classes; ++i) {
      if (given.at(i, j) > 0.0)
        bits += given.at(i, j) / classes * std::log2(given.at(i, j) / answered);
    }
  }
  return bits;
}

double drawn_d_prime(const Population& population, RandomStream& random) {
  return population.d_prime + population.spread * random.normal();
}

std::vector<analysis::Choice> answers_of(const Population& population, double d_prime,
                                         RandomStream& random) {
  std::vector<int> order;
  for (int i = 0; i < population.classes; ++i) {
    order.insert(order.end(), static_cast<std::size_t>(population.repeats), i);
  }
  shuffle(std::span(order), random);
  std::vector<analysis::Choice> choices;
  for (const int presented : order) {
    std::vector<double> felt = evidence(population, presented, d_prime);
    for (double& one : felt) one += random.normal();
    const bool guesses = random.uniform() < population.lapse;
    const int guess = static_cast<int>(random.below(felt.size()));
    const int best = static_cast<int>(std::ranges::max_element(felt) - felt.begin());
    choices.push_back({presented, guesses ? guess : best});
  }
  return choices;
}

std::vector<std::vector<analysis::Choice>> study_of(const Population& population, int participants,
                                                    RandomStream& random) {
  std::vector<std::vector<analysis::Choice>> study;
  for (int i = 0; i < participants; ++i) {
    const double d_prime = drawn_d_prime(population, random);
    study.push_back(answers_of(population, d_prime, random));
  }
  return study;
}

analysis::ConfusionMatrix confusion_of(int classes,
                                       const std::vector<std::vector<analysis::Choice>>& study) {
  analysis::ConfusionMatrix confusion(classes);
  for (const auto& choices : study) {
    for (const analysis::Choice& choice : choices) confusion.add(choice);
  }
  return confusion;
}

std::vector<double> luce_bias() {
  return {0.3, 0.2, 0.2, 0.2, 0.1};
}

Plane<double> luce_probabilities(const std::vector<double>& bias) {
  Plane<double> p(5, 5);
  for (int i = 0; i < 5; ++i) {
    double sum = 0.0;
    for (int j = 0; j < 5; ++j) {
      const double similarity = i == j ? 1.0 : (i + j == 1 ? 0.3 : 0.1);
      p.at(i, j) = similarity * bias[j];
      sum += p.at(i, j);
    }
    for (int j = 0; j < 5; ++j) p.at(i, j) /= sum;
  }
  return p;
}

void add_answers(const Plane<double>& p, int of_each, RandomStream& random,
                 analysis::ConfusionMatrix& confusion) {
  for (int i = 0; i < confusion.classes(); ++i) {
    for (int n = 0; n < of_each; ++n) {
      double rest = random.uniform();
      int answer = 0;
      while (answer + 1 < confusion.classes() && rest >= p.at(i, answer)) {
        rest -= p.at(i, answer++);
      }
      confusion.add({i, answer});
    }
  }
}

analysis::ConfusionMatrix answers_with(const Plane<double>& p, int of_each, RandomStream& random) {
  analysis::ConfusionMatrix confusion(p.height());
  add_answers(p, of_each, random, confusion);
  return confusion;
}

std::vector<analysis::Proportion> accuracies(
    const std::vector<std::vector<analysis::Choice>>& study) {
  std::vector<analysis::Proportion> all;
  for (const auto& choices : study) {
    const auto right = std::ranges::count_if(choices, [](const analysis::Choice& choice) {
      return choice.answered == choice.presented;
    });
    all.push_back({static_cast<int>(choices.size()), static_cast<int>(right)});
  }
  return all;
}

std::vector<double> shares(const std::vector<analysis::Proportion>& accuracies) {
  std::vector<double> all;
  for (const analysis::Proportion& one : accuracies) all.push_back(one.share().value_or(0.0));
  return all;
}

double TwoKinds::spread() const {
  return std::sqrt(share * (1.0 - share)) * std::abs(first - second);
}

std::vector<analysis::Proportion> accuracies_of(const TwoKinds& people, int participants,
                                                RandomStream& random) {
  std::vector<analysis::Proportion> all;
  for (int i = 0; i < participants; ++i) {
    const double p = random.uniform() < people.share ? people.first : people.second;
    analysis::Proportion& own = all.emplace_back(analysis::Proportion{people.trials, 0});
    for (int k = 0; k < people.trials; ++k) own.correct += random.uniform() < p ? 1 : 0;
  }
  return all;
}

}  // namespace touchtrial::recovery
