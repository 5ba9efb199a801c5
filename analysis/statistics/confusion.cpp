#include "analysis/statistics/confusion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace touchtrial::analysis {
namespace {

int checked_classes(int classes) {
  if (classes < 1) throw std::invalid_argument("a confusion matrix needs at least one class");
  return classes;
}

/// Solves an assignment problem by the Hungarian method with shortest augmenting paths, adding one
/// row after another. Rows and columns count from 1; 0 means none.
class Assignment {
 public:
  explicit Assignment(const Plane<std::int64_t>& cost)
      : cost_(cost),
        size_(cost.height()),
        row_potential_(size_ + 1),
        column_potential_(size_ + 1),
        row_of_column_(size_ + 1) {
    for (int row = 1; row <= size_; ++row) add(row);
  }

  [[nodiscard]] std::vector<int> column_of_row() const {
    std::vector<int> columns(size_);
    for (int column = 1; column <= size_; ++column)
      columns[row_of_column_[column] - 1] = column - 1;
    return columns;
  }

 private:
  void add(int row) {
    row_of_column_[0] = row;
    shortest_.assign(size_ + 1, std::numeric_limits<std::int64_t>::max());
    settled_.assign(size_ + 1, false);
    previous_.assign(size_ + 1, 0);
    int column = 0;
    while (row_of_column_[column] != 0) column = advance(column);
    for (; column != 0; column = previous_[column]) {
      row_of_column_[column] = row_of_column_[previous_[column]];
    }
  }

  /// Settles `column`, shortens the paths over its row and updates the potentials.
  /// \return the nearest unsettled column
  int advance(int column) {
    settled_[column] = true;
    const int row = row_of_column_[column];
    int nearest = 0;
    for (int j = 1; j <= size_; ++j) {
      if (settled_[j]) continue;
      const std::int64_t reduced_cost =
          cost_.at(row - 1, j - 1) - row_potential_[row] - column_potential_[j];
      if (reduced_cost < shortest_[j]) {
        shortest_[j] = reduced_cost;
        previous_[j] = column;
      }
      if (nearest == 0 || shortest_[j] < shortest_[nearest]) nearest = j;
    }
    move_potentials(shortest_[nearest]);
    return nearest;
  }

  void move_potentials(std::int64_t step) {
    for (int j = 0; j <= size_; ++j) {
      if (settled_[j]) {
        row_potential_[row_of_column_[j]] += step;
        column_potential_[j] -= step;
      } else {
        shortest_[j] -= step;
      }
    }
  }

  const Plane<std::int64_t>& cost_;
  int size_;
  std::vector<std::int64_t> row_potential_, column_potential_, shortest_;
  std::vector<int> row_of_column_, previous_;
  std::vector<bool> settled_;
};

}  // namespace

ConfusionMatrix::ConfusionMatrix(int classes, std::span<const Choice> choices)
    : counts_(checked_classes(classes), classes), no_response_(classes) {
  for (const Choice& choice : choices) add(choice);
}

void ConfusionMatrix::add(const Choice& choice, int times) {
  const auto is_in_range = [this](int index) { return index >= 0 && index < classes(); };
  if (!is_in_range(choice.presented) || (choice.answered && !is_in_range(*choice.answered))) {
    throw std::invalid_argument("a confusion matrix has no such class");
  }
  if (choice.answered) {
    counts_.at(choice.presented, *choice.answered) += times;
  } else {
    no_response_[choice.presented] += times;
  }
}

int ConfusionMatrix::presented(int presented) const noexcept {
  const auto row = counts_.row(presented);
  return std::accumulate(row.begin(), row.end(), no_response_[presented]);
}

int ConfusionMatrix::answered(int answered) const noexcept {
  int trials = 0;
  for (int i = 0; i < classes(); ++i) trials += count(i, answered);
  return trials;
}

int ConfusionMatrix::answered() const noexcept {
  const auto counts = counts_.samples();
  return std::accumulate(counts.begin(), counts.end(), 0);
}

Proportion ConfusionMatrix::accuracy(int presented) const noexcept {
  return {this->presented(presented), count(presented, presented)};
}

Proportion ConfusionMatrix::accuracy() const noexcept {
  Proportion total;
  for (int i = 0; i < classes(); ++i) total += accuracy(i);
  return total;
}

std::optional<double> unbiased_hit_rate(const ConfusionMatrix& confusion, int class_index) {
  const int presented = confusion.presented(class_index);
  const int right = confusion.count(class_index, class_index);
  if (presented == 0) return std::nullopt;
  if (right == 0) return 0.0;
  return static_cast<double>(right) / presented * right / confusion.answered(class_index);
}

std::optional<double> unbiased_hit_rate_by_chance(const ConfusionMatrix& confusion,
                                                  int class_index) {
  const double presented = confusion.presented(class_index);
  const double answered = confusion.answered(class_index);
  const double n = confusion.accuracy().n;
  if (presented == 0.0) return std::nullopt;
  if (answered == 0.0) return 0.0;
  // The number of right answers is hypergeometric; this is its mean square over both margins.
  const double mean = presented * answered / n;
  const double variance = n > 1.0 ? mean * (n - presented) / n * (n - answered) / (n - 1.0) : 0.0;
  return (mean * mean + variance) / (presented * answered);
}

std::optional<double> percentage(int part, int whole) noexcept {
  if (whole == 0) return std::nullopt;
  return 100.0 * part / whole;
}

LabelMatching best_label_matching(const ConfusionMatrix& confusion) {
  const int classes = confusion.classes();
  Plane<std::int64_t> cost(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) {
      // One trial outweighs all unchanged labels together, so labels only break ties.
      cost.at(i, j) = -(std::int64_t{confusion.count(i, j)} * (classes + 1) + (i == j ? 1 : 0));
    }
  }
  LabelMatching best;
  best.answer_of = Assignment(cost).column_of_row();
  best.accuracy.n = confusion.accuracy().n;
  for (int i = 0; i < classes; ++i) best.accuracy.correct += confusion.count(i, best.answer_of[i]);
  return best;
}

double label_swap_p(const ConfusionMatrix& confusion, const LabelMatching& best) {
  int relabelled = 0;
  int own_label = 0;
  int matched_label = 0;
  for (int i = 0; i < confusion.classes(); ++i) {
    if (best.answer_of[i] == i) continue;
    ++relabelled;
    own_label += confusion.count(i, i);
    matched_label += confusion.count(i, best.answer_of[i]);
  }
  if (matched_label == 0) return 1.0;
  double derangements = 1.0;  // of `relabelled` labels
  for (int k = 1; k <= relabelled; ++k) derangements = k * derangements + (k % 2 == 0 ? 1.0 : -1.0);
  const boost::math::binomial_distribution<> fair_coin(own_label + matched_label, 0.5);
  const double tail = boost::math::cdf(boost::math::complement(fair_coin, matched_label - 1));
  return std::min(1.0, derangements * tail);
}

}  // namespace touchtrial::analysis
