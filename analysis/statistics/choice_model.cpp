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

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

bool every_class_occurs(const ConfusionMatrix& confusion) {
  for (int i = 0; i < confusion.classes(); ++i) {
    const int responses = confusion.presented(i) - confusion.no_response(i);
    if (responses == 0 || confusion.answered(i) == 0) return false;
  }
  return true;
}

/// 1 where wrong answers lead from class i to class j in any number of steps, otherwise 0.
Plane<int> reachable_classes(const ConfusionMatrix& confusion) {
  const int classes = confusion.classes();
  Plane<int> reachable(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j)
      reachable.at(i, j) = i == j || confusion.count(i, j) > 0 ? 1 : 0;
  }
  for (int via = 0; via < classes; ++via) {
    for (int i = 0; i < classes; ++i) {
      for (int j = 0; j < classes; ++j) {
        reachable.at(i, j) |= reachable.at(i, via) & reachable.at(via, j);
      }
    }
  }
  return reachable;
}

void find_groups(const ConfusionMatrix& confusion, ChoiceModel& model) {
  const Plane<int> reachable = reachable_classes(confusion);
  model.group.assign(static_cast<std::size_t>(confusion.classes()), -1);
  model.groups = 0;
  for (int i = 0; i < confusion.classes(); ++i) {
    if (model.group[i] >= 0) continue;
    for (int j = i; j < confusion.classes(); ++j) {
      if ((reachable.at(i, j) & reachable.at(j, i)) != 0) model.group[j] = model.groups;
    }
    ++model.groups;
  }
}

bool in_same_group(const ChoiceModel& model, int i, int j) {
  return i != j && model.group[i] == model.group[j];
}

/// When the iteration stops.
struct IterationLimits {
  int max_sweeps = 100'000;
  double least_change = 1e-13;
};

/// The weight of each answer against the others. Given the total of every pair of cells (i, j) and
/// (j, i), the quasi-symmetric table is Bradley and Terry's model of "j was answered, not i", whose
/// maximum exists within a group. It is found by Newman's iteration (2023, Journal of Machine
/// Learning Research 24); each step scales one class to its margins.
class Weights {
 public:
  Weights(const ConfusionMatrix& confusion, const ChoiceModel& model, const IterationLimits& limits)
      : confusion_(confusion), model_(model), weights_(model.group.size(), 1.0) {
    for (int sweep = 0; sweep < limits.max_sweeps && !converged_; ++sweep) {
      converged_ = sweep_change() < limits.least_change;
    }
  }

  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] double operator[](int i) const { return weights_[i]; }

 private:
  double sweep_change() {
    double largest = 0.0;
    for (int j = 0; j < confusion_.classes(); ++j) {
      const double scale = scale_of(j);
      weights_[j] *= scale;
      largest = std::max(largest, std::abs(scale - 1.0));
    }
    normalise();
    return largest;
  }

  /// Weighted wrong answers j, divided by weighted wrong answers to presentations of j.
  [[nodiscard]] double scale_of(int j) const {
    double chosen = 0.0;
    double rejected = 0.0;
    for (int i = 0; i < confusion_.classes(); ++i) {
      if (!in_same_group(model_, i, j)) continue;
      const double total = weights_[i] + weights_[j];
      chosen += confusion_.count(i, j) * weights_[i] / total;
      rejected += confusion_.count(j, i) * weights_[j] / total;
    }
    return rejected > 0.0 ? chosen / rejected : 1.0;
  }

  /// Only the weights' ratios matter: scales the largest of each group to 1.
  void normalise() {
    largest_.assign(static_cast<std::size_t>(model_.groups), 0.0);
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      double& group_max = largest_[model_.group[i]];
      group_max = std::max(group_max, weights_[i]);
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
void compute_expected_counts(const ConfusionMatrix& confusion, const Weights& weights,
                             ChoiceModel& model) {
  const int classes = confusion.classes();
  model.expected = Plane<double>(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) {
      const double total = confusion.count(i, j) + confusion.count(j, i);
      model.expected.at(i, j) = in_same_group(model, i, j)
                                    ? total * weights[j] / (weights[i] + weights[j])
                                    : confusion.count(i, j);
    }
  }
}

double similarity_of(const Plane<double>& expected, int i, int j) {
  if (i == j) return 1.0;
  const double right = expected.at(i, i) * expected.at(j, j);
  if (right == 0.0) return kUndefined;
  const double i_to_j = expected.at(i, j);
  const double j_to_i = expected.at(j, i);
  if ((i_to_j == 0.0) != (j_to_i == 0.0)) return kUndefined;
  return std::sqrt(i_to_j * j_to_i / right);
}

void compute_similarities(ChoiceModel& model) {
  const int classes = model.expected.height();
  model.similarity = Plane<double>(classes, classes);
  for (int i = 0; i < classes; ++i) {
    for (int j = 0; j < classes; ++j) {
      model.similarity.at(i, j) = similarity_of(model.expected, i, j);
    }
  }
}

void compute_biases(const Weights& weights, ChoiceModel& model) {
  std::vector<double> sum(static_cast<std::size_t>(model.groups));
  for (std::size_t i = 0; i < model.group.size(); ++i) {
    const auto place = static_cast<int>(i);
    const double right = model.expected.at(place, place);
    model.bias.push_back(right > 0.0 ? std::sqrt(weights[place] * right) : kUndefined);
    if (right > 0.0) sum[model.group[i]] += model.bias[i];
  }
  for (std::size_t i = 0; i < model.group.size(); ++i) model.bias[i] /= sum[model.group[i]];
}

void compute_g_squared(const ConfusionMatrix& confusion, ChoiceModel& model) {
  int pairs = 0;
  for (int i = 0; i < confusion.classes(); ++i) {
    for (int j = 0; j < confusion.classes(); ++j) {
      if (!in_same_group(model, i, j)) continue;
      const double count = confusion.count(i, j);
      if (count > 0.0) model.g_squared += 2.0 * count * std::log(count / model.expected.at(i, j));
      if (i < j && confusion.count(i, j) + confusion.count(j, i) > 0) ++pairs;
    }
  }
  model.g_squared = std::max(0.0, model.g_squared);  // rounding may leave it just below 0
  model.degrees_of_freedom = pairs - (confusion.classes() - model.groups);
}

void compute_p(ChoiceModel& model) {
  if (model.degrees_of_freedom == 0) return;
  const boost::math::chi_squared_distribution<> chi_squared(model.degrees_of_freedom);
  model.p = boost::math::cdf(boost::math::complement(chi_squared, model.g_squared));
}

/// Computes groups, expected counts and G^2, but no parameters: drawn tables need only these.
/// \param model  must outlive the weights
Weights fit(const ConfusionMatrix& confusion, const IterationLimits& limits, ChoiceModel& model) {
  find_groups(confusion, model);
  Weights weights(confusion, model, limits);
  model.converged = weights.converged();
  compute_expected_counts(confusion, weights, model);
  compute_g_squared(confusion, model);
  return weights;
}

/// Draws tables from the model's probabilities, with the observed number of answers to each class.
class DrawnTables {
 public:
  explicit DrawnTables(const ChoiceModel& model)
      : limits_(model.expected.height(), model.expected.width() - 1) {
    for (int i = 0; i < limits_.height(); ++i) {
      const auto expected = model.expected.row(i);
      const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
      trials_.push_back(std::lround(total));
      for (int answer = 0; answer < limits_.width(); ++answer) {
        limits_.at(i, answer) = upper_limit(answer, expected, total);
      }
    }
  }

  [[nodiscard]] ConfusionMatrix draw(RandomStream& random) const {
    ConfusionMatrix drawn(limits_.height());
    std::vector<std::int64_t> above;  // for each answer, the number of trials with a later one
    for (int i = 0; i < limits_.height(); ++i) {
      const auto limits = limits_.row(i);
      above.assign(limits.size(), 0);
      const std::int64_t trials = trials_[static_cast<std::size_t>(i)];
      for (std::int64_t trial = 0; trial < trials; ++trial) {
        const double uniform = random.uniform();
        for (std::size_t k = 0; k < limits.size(); ++k) above[k] += uniform >= limits[k] ? 1 : 0;
      }
      std::int64_t remaining = trials;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        drawn.add({i, static_cast<int>(k)}, static_cast<int>(remaining - above[k]));
        remaining = above[k];
      }
      drawn.add({i, limits_.width()}, static_cast<int>(remaining));
    }
    return drawn;
  }

 private:
  /// The answer that a uniform number draws; non-decreasing.
  static int draw_answer(double uniform, std::span<const double> expected, double total) {
    double remaining = uniform * total;
    int answer = 0;
    while (answer + 1 < std::ssize(expected) && remaining >= expected[answer])
      remaining -= expected[answer++];
    return answer;
  }

  /// The smallest uniform number that draws a later answer, by bisection; 1 if there is none.
  static double upper_limit(int answer, std::span<const double> expected, double total) {
    constexpr std::int64_t kUniforms = std::int64_t{1}
                                       << 53U;  // RandomStream draws multiples of 2^-53
    const auto uniform = [](std::int64_t number) {
      return static_cast<double>(number) / static_cast<double>(kUniforms);
    };
    std::int64_t low = 0;
    std::int64_t high = kUniforms;
    while (low < high) {
      const std::int64_t middle = std::midpoint(low, high);
      if (draw_answer(uniform(middle), expected, total) > answer) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return uniform(high);
  }

  Plane<double> limits_;              ///< upper_limit by class and answer, without the last answer
  std::vector<std::int64_t> trials_;  ///< by class
};

}  // namespace

std::optional<ChoiceModel> choice_model(const ConfusionMatrix& confusion) {
  if (!every_class_occurs(confusion)) return std::nullopt;
  ChoiceModel model;
  const Weights weights = fit(confusion, {}, model);
  compute_similarities(model);
  compute_biases(weights, model);
  compute_p(model);
  return model;
}

std::optional<double> choice_model_p(const ChoiceModel& model, int draws, std::uint64_t index) {
  if (draws < 1) throw std::invalid_argument("a bootstrap needs at least one draw");
  if (model.degrees_of_freedom == 0) return std::nullopt;
  constexpr IterationLimits kDrawLimits{.max_sweeps = 500, .least_change = 1e-7};
  constexpr double kTie = 1e-9;
  const DrawnTables tables(model);
  RandomStream random(0, "choice model", index);
  int as_extreme = 0;
  for (int draw = 0; draw < draws; ++draw) {
    ChoiceModel drawn_model;
    static_cast<void>(fit(tables.draw(random), kDrawLimits, drawn_model));
    if (drawn_model.g_squared >= model.g_squared - kTie) ++as_extreme;
  }
  return p_of_draws(as_extreme, draws);
}

}  // namespace touchtrial::analysis
