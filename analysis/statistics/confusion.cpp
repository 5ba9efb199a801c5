#include "analysis/statistics/confusion.hpp"

#include <numeric>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

int checked_classes(int classes) {
  if (classes < 1) throw std::invalid_argument("a confusion matrix needs at least one class");
  return classes;
}

}  // namespace

ConfusionMatrix::ConfusionMatrix(int classes)
    : counts_(checked_classes(classes), classes), no_response_(classes) {}

void ConfusionMatrix::add(const Choice& choice) {
  const auto known = [this](int index) { return index >= 0 && index < classes(); };
  if (!known(choice.presented) || (choice.answered && !known(*choice.answered))) {
    throw std::invalid_argument("a confusion matrix has no such class");
  }
  if (choice.answered) {
    ++counts_.at(choice.presented, *choice.answered);
  } else {
    ++no_response_[choice.presented];
  }
}

int ConfusionMatrix::presented(int presented) const noexcept {
  const auto row = counts_.row(presented);
  return std::accumulate(row.begin(), row.end(), no_response_[presented]);
}

int ConfusionMatrix::answered() const noexcept {
  const auto all = counts_.samples();
  return std::accumulate(all.begin(), all.end(), 0);
}

Proportion ConfusionMatrix::accuracy(int presented) const noexcept {
  return {this->presented(presented), count(presented, presented)};
}

Proportion ConfusionMatrix::accuracy() const noexcept {
  Proportion all;
  for (int i = 0; i < classes(); ++i) {
    const Proportion one = accuracy(i);
    all.n += one.n;
    all.correct += one.correct;
  }
  return all;
}

std::optional<double> percentage(int part, int whole) noexcept {
  if (whole == 0) return std::nullopt;
  return 100.0 * part / whole;
}

}  // namespace touchtrial::analysis
