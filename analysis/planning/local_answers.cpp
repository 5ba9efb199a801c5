#include "analysis/planning/local_answers.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

/// Rarer answers are left as rare as they are: their slopes tell nothing of their neighbourhood.
constexpr double kRare = 1e-6;

}  // namespace

LocalAnswers::LocalAnswers(const FitCounts& counts, const FitProblem::Tangent& fitted,
                           std::vector<double> at, Bounds bounds)
    : classes_(counts.classes.size()),
      stimuli_(counts.stimuli.size()),
      at_(std::move(at)),
      changes_(std::move(bounds)) {
  for (std::size_t i = 0; i < at_.size(); ++i) {
    changes_.lower[i] -= at_[i];
    changes_.upper[i] -= at_[i];
  }
  for (std::size_t layout = 0; layout < counts.layouts.size(); ++layout) {
    auto& own = probability_.emplace_back();
    auto& slopes = log_slopes_.emplace_back();
    for (std::size_t cell = 0; cell < stimuli_ * classes_; ++cell) {
      const auto answers =
          fitted.table.answers(static_cast<int>(layout), static_cast<int>(cell / classes_));
      own.push_back(answers[cell % classes_]);
      auto& of_cell = slopes.emplace_back(at_.size(), 0.0);
      for (std::size_t i = 0; i < at_.size() && own.back() > kRare; ++i) {
        of_cell[i] = fitted.slopes[i][layout][cell] / own.back();
      }
    }
  }
}

void LocalAnswers::answers_at(std::size_t layout, std::size_t place, std::span<const double> change,
                              std::span<double> answers) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < classes_; ++c) {
    const std::size_t cell = place * classes_ + c;
    double log_change = 0.0;
    for (std::size_t i = 0; i < change.size(); ++i) {
      log_change += log_slopes_[layout][cell][i] * change[i];
    }
    answers[c] = probability_[layout][cell] * std::exp(std::clamp(log_change, -300.0, 300.0));
    sum += answers[c];
  }
  for (double& answer : answers) answer /= sum;
}

AnswerTable LocalAnswers::at(std::span<const double> numbers) const {
  std::vector<double> change(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= at_[i];
  AnswerTable table(static_cast<int>(probability_.size()), static_cast<int>(stimuli_),
                    static_cast<int>(classes_), false);
  for (std::size_t layout = 0; layout < probability_.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_; ++place) {
      answers_at(layout, place, change,
                 table.answers(static_cast<int>(layout), static_cast<int>(place)));
    }
  }
  return table;
}

double LocalAnswers::log_likelihood(const std::vector<std::vector<double>>& counts,
                                    std::span<const double> change,
                                    std::span<double> slopes) const {
  std::ranges::fill(slopes, 0.0);
  std::vector<double> answers(classes_);
  double sum = 0.0;
  for (std::size_t layout = 0; layout < counts.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_; ++place) {
      const std::size_t row = place * classes_;
      double presented = 0.0;
      for (std::size_t c = 0; c < classes_; ++c) presented += counts[layout][row + c];
      if (presented == 0.0) continue;
      answers_at(layout, place, change, answers);
      for (std::size_t c = 0; c < classes_; ++c) {
        const double count = counts[layout][row + c];
        if (count > 0.0) sum += count * std::log(std::max(answers[c], kLeastProbability));
        for (std::size_t i = 0; i < slopes.size(); ++i) {
          slopes[i] += (count - presented * answers[c]) * log_slopes_[layout][row + c][i];
        }
      }
    }
  }
  return sum;
}

std::vector<double> LocalAnswers::fitted_to(const std::vector<std::vector<double>>& counts) const {
  const SmoothFunction function = [&](std::span<const double> change, std::span<double> slopes) {
    return log_likelihood(counts, change, slopes);
  };
  std::vector<double> numbers =
      maximise(function, std::vector<double>(at_.size(), 0.0), changes_, {.tolerance = 1e-8}).at;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += at_[i];
  return numbers;
}

}  // namespace touchtrial::planning
