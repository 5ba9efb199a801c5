#include "analysis/statistics/choice_model.hpp"

#include "analysis/statistics/common.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>

namespace touchtrial::analysis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool every_class_occurs(const ConfusionMatrix& confusion) {
  for (int i = 0; i < confusion.classes(); ++i) {
    const int with_response = confusion.presented(i) - confusion.no_response(i);
    if (with_response == 0 || confusion.answered(i) == 0) return false;
  }
  return true;
}

/// Whether wrong answers lead from one class to another in any number of steps (1) or not (0).
Plane<int> reachable(const ConfusionMatrix& confusion) {
  const int classes = confusion.classes();
  Plane<int> ways(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) ways.at(i, j) = i == j || confusion.count(i, j) > 0 ? 1 : 0;
  }
  for (int over = 0; over < classes; ++over) {
    for (int i = 0; i < classes; ++i) {
      for (int j = 0; j < classes; ++j) {
        ways.at(i, j) |= ways.at(i, over) & ways.at(over, j);
      }
    }
  }
  return ways;
}

void find_groups(const ConfusionMatrix& confusion, ChoiceModel& model) {
  const Plane<int> ways = reachable(confusion);
  model.group.assign(static_cast<std::size_t>(confusion.classes()), -1);
  model.groups = 0;
  for (int i = 0; i < confusion.classes(); ++i) {
    if (model.group[i] >= 0) continue;
    for (int j = i; j < confusion.classes(); ++j) {
      if ((ways.at(i, j) & ways.at(j, i)) != 0) model.group[j] = model.groups;
    }
    ++model.groups;
  }
}

bool fitted_together(const ChoiceModel& model, int i, int j) {
  return i != j && model.group[i] == model.group[j];
}

/// When the iteration stops.
struct Effort {
  int max_sweeps = 100'000;
  double least_change = 1e-13;
};

/// The weight of each answer against the others. Given the total of every pair of cells (i, j) and
/// (j, i), the quasi-symmetric table is Bradley and Terry's model of "j was answered, not i", whose
/// maximum exists within a group. This is Zermelo's problem, solved by Newman's iteration (2023,
/// Journal of Machine Learning Research 24), each step of which scales one class to its margins.
class Weights {
 public:
  Weights(const ConfusionMatrix& confusion, const ChoiceModel& model, const Effort& effort)
      : confusion_(confusion), model_(model), weights_(model.group.size(), 1.0) {
    for (int sweep = 0; sweep < effort.max_sweeps && !converged_; ++sweep) {
      converged_ = change_of_sweep() < effort.least_change;
    }
  }

  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] double operator[](int i) const { return weights_[i]; }

 private:
  double change_of_sweep() {
    double largest = 0.0;
    for (int j = 0; j < confusion_.classes(); ++j) {
      const double scale = scale_of(j);
      weights_[j] *= scale;
      largest = std::max(largest, std::abs(scale - 1.0));
    }
    keep_in_range();
    return largest;
  }

  /// Wrong answers j over wrong answers to presentations of j, both weighted.
  [[nodiscard]] double scale_of(int j) const {
    double chosen = 0.0;
    double passed_over = 0.0;
    for (int i = 0; i < confusion_.classes(); ++i) {
      if (!fitted_together(model_, i, j)) continue;
      const double both = weights_[i] + weights_[j];
      chosen += confusion_.count(i, j) * weights_[i] / both;
      passed_over += confusion_.count(j, i) * weights_[j] / both;
    }
    return passed_over > 0.0 ? chosen / passed_over : 1.0;
  }

  /// Only the weights' ratios matter: scales the largest of each group to 1.
  void keep_in_range() {
    largest_.assign(static_cast<std::size_t>(model_.groups), 0.0);
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      double& so_far = largest_[model_.group[i]];
      so_far = std::max(so_far, weights_[i]);
    }
    for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] /= largest_[model_.group[i]];
  }

  const ConfusionMatrix& confusion_;
  const ChoiceModel& model_;
  std::vector<double> weights_;
  std::vector<double> largest_;  ///< of each group
  bool converged_ = false;
};

/// Fits cells on the diagonal and across groups exactly.
void expect_counts(const ConfusionMatrix& confusion, const Weights& weights, ChoiceModel& model) {
  const int classes = confusion.classes();
  model.expected = Plane<double>(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) {
      const double both = confusion.count(i, j) + confusion.count(j, i);
      model.expected.at(i, j) = fitted_together(model, i, j)
                                    ? both * weights[j] / (weights[i] + weights[j])
                                    : confusion.count(i, j);
    }
  }
}

double similarity_of(const Plane<double>& expected, int i, int j) {
  if (i == j) return 1.0;
  const double right = expected.at(i, i) * expected.at(j, j);
  if (right == 0.0) return kNone;
  const double there = expected.at(i, j);
  const double back = expected.at(j, i);
  if ((there == 0.0) != (back == 0.0)) return kNone;
  return std::sqrt(there * back / right);
}

void find_similarities(ChoiceModel& model) {
  const int classes = model.expected.height();
  model.similarity = Plane<double>(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) {
      model.similarity.at(i, j) = similarity_of(model.expected, i, j);
    }
  }
}

void find_biases(const Weights& weights, ChoiceModel& model) {
  std::vector<double> sum(static_cast<std::size_t>(model.groups));
  for (std::size_t i = 0; i < model.group.size(); ++i) {
    const auto place = static_cast<int>(i);
    const double right = model.expected.at(place, place);
    model.bias.push_back(right > 0.0 ? std::sqrt(weights[place] * right) : kNone);
    if (right > 0.0) sum[model.group[i]] += model.bias[i];
  }
  for (std::size_t i = 0; i < model.group.size(); ++i) model.bias[i] /= sum[model.group[i]];
}

/// Computes G^2 and its degrees of freedom.
void find_distance(const ConfusionMatrix& confusion, ChoiceModel& model) {
  int pairs = 0;
  for (int i = 0; i < confusion.classes(); ++i) {
    for (int j = 0; j < confusion.classes(); ++j) {
      if (!fitted_together(model, i, j)) continue;
      const double count = confusion.count(i, j);
      if (count > 0.0) model.g_squared += 2.0 * count * std::log(count / model.expected.at(i, j));
      if (i < j && confusion.count(i, j) + confusion.count(j, i) > 0) ++pairs;
    }
  }
  model.g_squared = std::max(0.0, model.g_squared);  // rounding may leave it just below 0
  model.degrees_of_freedom = pairs - (confusion.classes() - model.groups);
}

void judge_fit(ChoiceModel& model) {
  if (model.degrees_of_freedom == 0) return;
  const boost::math::chi_squared_distribution<> chi_squared(model.degrees_of_freedom);
  model.p = boost::math::cdf(boost::math::complement(chi_squared, model.g_squared));
}

/// Computes groups, expected counts and G^2, which is all that a drawn table needs.
/// \param model  outlives the weights
Weights fit(const ConfusionMatrix& confusion, const Effort& effort, ChoiceModel& model) {
  find_groups(confusion, model);
  Weights weights(confusion, model, effort);
  model.converged = weights.converged();
  expect_counts(confusion, weights, model);
  find_distance(confusion, model);
  return weights;
}

/// Draws tables from the model's probabilities, with the observed number of answers to each class.
class DrawnTables {
 public:
  explicit DrawnTables(const ChoiceModel& model)
      : min_(model.expected.height(), model.expected.width() - 1) {
    for (int i = 0; i < min_.height(); ++i) {
      const auto expected = model.expected.row(i);
      const double all = std::accumulate(expected.begin(), expected.end(), 0.0);
      trials_.push_back(std::lround(all));
      for (int answer = 0; answer < min_.width(); ++answer) {
        min_.at(i, answer) = min_above(answer, expected, all);
      }
    }
  }

  [[nodiscard]] ConfusionMatrix draw(RandomStream& random) const {
    ConfusionMatrix drawn(min_.height());
    std::vector<std::int64_t> later;  // answers than each
    for (int i = 0; i < min_.height(); ++i) {
      const auto least = min_.row(i);
      later.assign(least.size(), 0);
      const std::int64_t trials = trials_[static_cast<std::size_t>(i)];
      for (std::int64_t trial = 0; trial < trials; ++trial) {
        const double uniform = random.uniform();
        for (std::size_t k = 0; k < least.size(); ++k) later[k] += uniform >= least[k] ? 1 : 0;
      }
      std::int64_t left = trials;
      for (std::size_t k = 0; k < least.size(); ++k) {
        drawn.add({i, static_cast<int>(k)}, static_cast<int>(left - later[k]));
        left = later[k];
      }
      drawn.add({i, min_.width()}, static_cast<int>(left));
    }
    return drawn;
  }

 private:
  /// The answer for a uniform number; does not decrease with it.
  static int answer_of(double uniform, std::span<const double> expected, double all) {
    double left = uniform * all;
    int answer = 0;
    while (answer + 1 < std::ssize(expected) && left >= expected[answer])
      left -= expected[answer++];
    return answer;
  }

  /// The smallest uniform number with a later answer, by bisection; 1 if there is none.
  static double min_above(int answer, std::span<const double> expected, double all) {
    constexpr std::int64_t kUniforms = std::int64_t{1} << 53U;  // those of RandomStream, in order
    const auto uniform = [](std::int64_t number) {
      return static_cast<double>(number) / static_cast<double>(kUniforms);
    };
    std::int64_t low = 0;
    std::int64_t high = kUniforms;
    while (low < high) {
      const std::int64_t middle = std::midpoint(low, high);
      if (answer_of(uniform(middle), expected, all) > answer) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return uniform(high);
  }

  Plane<double> min_;                 ///< of each class and each answer but the last
  std::vector<std::int64_t> trials_;  ///< of each class
};

}  // namespace

std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion) {
  if (!every_class_occurs(confusion)) return std::nullopt;
  ChoiceModel model;
  const Weights weights = fit(confusion, {}, model);
  find_similarities(model);
  find_biases(weights, model);
  judge_fit(model);
  return model;
}

std::optional<double> choice_model_p(const ChoiceModel& model, int draws, std::uint64_t index) {
  if (draws < 1) throw std::invalid_argument("a bootstrap needs at least one draw");
  if (model.degrees_of_freedom == 0) return std::nullopt;
  constexpr Effort kOfDraws{.max_sweeps = 500, .least_change = 1e-7};
  constexpr double kTie = 1e-9;
  const DrawnTables tables(model);
  RandomStream random(0, "choice model", index);
  int as_bad = 0;
  for (int draw = 0; draw < draws; ++draw) {
    ChoiceModel one;
    static_cast<void>(fit(tables.draw(random), kOfDraws, one));
    if (one.g_squared >= model.g_squared - kTie) ++as_bad;
  }
  return p_of_draws(as_bad, draws);
}

}  // namespace touchtrial::analysis
