#include "analysis/statistics/information_transfer.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

/// Presented and answered classes of one participant's trials that have a response.
struct Answers {
  std::vector<int> presented;
  std::vector<int> answered;
};

std::vector<Answers> answers_with_response(std::span<const std::vector<Choice>> by_participant) {
  std::vector<Answers> people;
  for (const std::vector<Choice>& choices : by_participant) {
    Answers& person_answers = people.emplace_back();
    for (const Choice& choice : choices) {
      if (!choice.answered) continue;
      person_answers.presented.push_back(choice.presented);
      person_answers.answered.push_back(*choice.answered);
    }
  }
  return people;
}

/// \param people  with classes in range
ConfusionMatrix pool_answers(int classes, std::span<const Answers> people) {
  Plane<int> counts(classes, classes);
  for (const Answers& person_answers : people) {
    for (std::size_t i = 0; i < person_answers.presented.size(); ++i) {
      ++counts.at(person_answers.presented[i], person_answers.answered[i]);
    }
  }
  ConfusionMatrix confusion(classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) confusion.add({i, j}, counts.at(i, j));
  }
  return confusion;
}

double mean_of_permutations(int classes, std::vector<Answers> people, RandomStream& random,
                            int permutations) {
  double sum = 0.0;
  for (int i = 0; i < permutations; ++i) {
    for (Answers& person_answers : people) shuffle(std::span(person_answers.answered), random);
    sum += raw_information_transfer(pool_answers(classes, people)).value_or(0.0);
  }
  return sum / permutations;
}

}  // namespace

std::optional<double> raw_information_transfer(const ConfusionMatrix& confusion) {
  const double n = confusion.answered();
  if (n == 0.0) return std::nullopt;
  const int classes = confusion.classes();
  std::vector<double> column_total(classes);
  for (int j = 0; j < classes; ++j) column_total[j] = confusion.answered(j);
  double bits = 0.0;
  for (int i = 0; i < classes; ++i) {
    const double row_total = confusion.presented(i) - confusion.no_response(i);
    for (int j = 0; j < classes; ++j) {
      const double count = confusion.count(i, j);
      if (count > 0.0) bits += count / n * std::log2(count * n / (row_total * column_total[j]));
    }
  }
  return std::max(0.0, bits);  // rounding may leave it just below 0
}

InformationTransfer information_transfer(int classes,
                                         std::span<const std::vector<Choice>> by_participant,
                                         std::uint64_t index, int permutations) {
  if (permutations < 1) throw std::invalid_argument("a null mean needs at least one permutation");
  ConfusionMatrix confusion(classes);
  for (const std::vector<Choice>& choices : by_participant) {
    for (const Choice& choice : choices) {
      if (choice.answered) confusion.add(choice);
    }
  }
  InformationTransfer transfer;
  transfer.raw = raw_information_transfer(confusion);
  if (!transfer.raw) return transfer;
  transfer.deals = permutations;
  const double freedom = static_cast<double>(classes - 1) * (classes - 1);
  transfer.corrected = *transfer.raw - freedom / (2.0 * confusion.answered() * std::numbers::ln2);
  RandomStream random(0, "information transfer null", index);
  transfer.null_mean =
      mean_of_permutations(classes, answers_with_response(by_participant), random, permutations);
  return transfer;
}

}  // namespace touchtrial::analysis
