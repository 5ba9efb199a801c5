#include "analysis/planning/fit_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

std::vector<std::vector<double>> zeros(std::size_t layouts, const AnswerTable& table) {
  const auto cells = static_cast<std::size_t>(table.stimuli()) * table.classes();
  return {layouts, std::vector<double>(cells, 0.0)};
}

double believed(double probability) noexcept {
  return std::clamp(probability, kLeastProbability, 1.0);
}

}  // namespace

CountsEvidence::CountsEvidence(const FitCounts& counts, std::span<const CountedPerson> people)
    : counts_(counts), sums_(by_layout(counts, people)) {}

double CountsEvidence::log_likelihood(const AnswerTable& table,
                                      std::vector<std::vector<double>>* slopes) const {
  const auto classes = static_cast<std::size_t>(table.classes());
  if (slopes != nullptr) *slopes = zeros(sums_.size(), table);
  double sum = 0.0;
  for (std::size_t layout = 0; layout < sums_.size(); ++layout) {
    for (std::size_t cell = 0; cell < sums_[layout].size(); ++cell) {
      const double count = sums_[layout][cell];
      if (count == 0.0) continue;
      const auto answers =
          table.answers(static_cast<int>(layout), static_cast<int>(cell / classes));
      const double probability = believed(answers[cell % classes]);
      sum += count * std::log(probability);
      if (slopes != nullptr) (*slopes)[layout][cell] = count / probability;
    }
  }
  return sum;
}

std::vector<double> CountsEvidence::information(const AnswerTable& table,
                                                const CellSlopes& slopes) const {
  const auto classes = static_cast<std::size_t>(table.classes());
  std::vector<double> information(slopes.size() * slopes.size(), 0.0);
  for (std::size_t layout = 0; layout < sums_.size(); ++layout) {
    for (std::size_t cell = 0; cell < sums_[layout].size(); ++cell) {
      const std::size_t row = cell - cell % classes;
      double presented = 0.0;
      for (std::size_t c = 0; c < classes; ++c) presented += sums_[layout][row + c];
      const auto answers =
          table.answers(static_cast<int>(layout), static_cast<int>(cell / classes));
      const double weight = presented / believed(answers[cell % classes]);
      for (std::size_t i = 0; i < slopes.size(); ++i) {
        for (std::size_t j = 0; j < slopes.size(); ++j) {
          information[i * slopes.size() + j] +=
              weight * slopes[i][layout][cell] * slopes[j][layout][cell];
        }
      }
    }
  }
  return information;
}

AccuracyEvidence::AccuracyEvidence(std::vector<double> accuracies, double trials_a_class,
                                   std::vector<PictureLayout> layouts,
                                   std::vector<design::StimulusIndex> stimuli)
    : accuracies_(std::move(accuracies)),
      trials_(trials_a_class),
      layouts_(std::move(layouts)),
      stimuli_(std::move(stimuli)),
      stimuli_of_class_(accuracies_.size(), 0) {
  for (const design::StimulusIndex& stimulus : stimuli_) ++stimuli_of_class_[stimulus.class_index];
}

double AccuracyEvidence::share_of(const design::StimulusIndex& stimulus) const noexcept {
  return 1.0 / (static_cast<double>(layouts_.size()) * stimuli_of_class_[stimulus.class_index]);
}

std::vector<double> AccuracyEvidence::accuracies_of(const AnswerTable& table) const {
  std::vector<double> right(accuracies_.size(), 0.0);
  for (std::size_t layout = 0; layout < layouts_.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_.size(); ++place) {
      const int own = stimuli_[place].class_index;
      right[own] += share_of(stimuli_[place]) *
                    table.answers(static_cast<int>(layout), static_cast<int>(place))[own];
    }
  }
  return right;
}

double AccuracyEvidence::log_likelihood(const AnswerTable& table,
                                        std::vector<std::vector<double>>* slopes) const {
  const std::vector<double> right = accuracies_of(table);
  double sum = 0.0;
  std::vector<double> slope(right.size());
  for (std::size_t c = 0; c < right.size(); ++c) {
    const double correct = believed(right[c]);
    const double wrong = believed(1.0 - right[c]);
    sum +=
        trials_ * (accuracies_[c] * std::log(correct) + (1.0 - accuracies_[c]) * std::log(wrong));
    slope[c] = trials_ * (accuracies_[c] / correct - (1.0 - accuracies_[c]) / wrong);
  }
  if (slopes == nullptr) return sum;
  *slopes = zeros(layouts_.size(), table);
  for (std::vector<double>& cells : *slopes) {
    for (std::size_t place = 0; place < stimuli_.size(); ++place) {
      const int own = stimuli_[place].class_index;
      cells[place * right.size() + own] = slope[own] * share_of(stimuli_[place]);
    }
  }
  return sum;
}

std::vector<double> AccuracyEvidence::information(const AnswerTable& table,
                                                  const CellSlopes& slopes) const {
  const std::vector<double> right = accuracies_of(table);
  std::vector<double> information(slopes.size() * slopes.size(), 0.0);
  // By parameter and class, the derivative of the accuracy.
  std::vector<std::vector<double>> slope(slopes.size(), std::vector<double>(right.size(), 0.0));
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    for (const std::vector<double>& cells : slopes[i]) {
      for (std::size_t place = 0; place < stimuli_.size(); ++place) {
        const int own = stimuli_[place].class_index;
        slope[i][own] += share_of(stimuli_[place]) * cells[place * right.size() + own];
      }
    }
  }
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      for (std::size_t c = 0; c < right.size(); ++c) {
        const double variance = believed(right[c]) * believed(1.0 - right[c]);
        information[i * slopes.size() + j] += trials_ * slope[i][c] * slope[j][c] / variance;
      }
    }
  }
  return information;
}

}  // namespace touchtrial::planning
