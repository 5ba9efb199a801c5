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

std::vector<Answers> with_response(std::span<const std::vector<Choice>> by_participant) {
  std::vector<Answers> all;
  for (const std::vector<Choice>& choices : by_participant) {
    Answers& mine = all.emplace_back();
    for (const Choice& choice : choices) {
      if (!choice.answered) continue;
      mine.presented.push_back(choice.presented);
      mine.answered.push_back(*choice.answered);
    }
  }
  return all;
}

/// \param all  with classes in range
ConfusionMatrix pooled(int classes, std::span<const Answers> all) {
  Plane<int> counts(classes, classes);
  for (const Answers& mine : all) {
    for (std::size_t i = 0; i < mine.presented.size(); ++i) {
      ++counts.at(mine.presented[i], mine.answered[i]);
    }
  }
  ConfusionMatrix confusion(classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) confusion.add({i, j}, counts.at(i, j));
  }
  return confusion;
}

double mean_of_random_deals(int classes, std::vector<Answers> all, RandomStream& random,
                            int permutations) {
  double sum = 0.0;
  for (int i = 0; i < permutations; ++i) {
    for (Answers& mine : all) shuffle(std::span(mine.answered), random);
    sum += raw_information_transfer(pooled(classes, all)).value_or(0.0);
  }
  return sum / permutations;
}

}  // namespace

std::optional<double> raw_information_transfer(const ConfusionMatrix& confusion) {
  const double n = confusion.answered();
  if (n == 0.0) return std::nullopt;
  const int classes = confusion.classes();
  std::vector<double> of_column(classes);
  for (int j = 0; j < classes; ++j) of_column[j] = confusion.answered(j);
  double bits = 0.0;
  for (int i = 0; i < classes; ++i) {
    const double of_row = confusion.presented(i) - confusion.no_response(i);
    for (int j = 0; j < classes; ++j) {
      const double here = confusion.count(i, j);
      if (here > 0.0) bits += here / n * std::log2(here * n / (of_row * of_column[j]));
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
      mean_of_random_deals(classes, with_response(by_participant), random, permutations);
  return transfer;
}

}  // namespace touchtrial::analysis
