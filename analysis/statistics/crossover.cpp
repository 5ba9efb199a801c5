#include "analysis/statistics/crossover.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {
namespace {

/// Differences by group: the first method less the second in both.
struct OrderGroups {
  std::vector<double> first_first;
  std::vector<double> second_first;

  [[nodiscard]] bool has_both() const noexcept {
    return !first_first.empty() && !second_first.empty();
  }
};

OrderGroups groups_of(std::span<const CrossoverPerson> people) {
  OrderGroups groups;
  for (const CrossoverPerson& one : people) {
    (one.first_method_first ? groups.first_first : groups.second_first).push_back(one.difference);
  }
  return groups;
}

void require_finite_people(std::span<const CrossoverPerson> people, double null) {
  for (const CrossoverPerson& one : people) {
    require_finite(std::span(&one.difference, 1), "a crossover");
  }
  require_finite(std::span(&null, 1), "a crossover");
}

double squares_about(const std::vector<double>& values, double mean) {
  const double sd = standard_deviation(values, mean, 1.0);
  return sd * sd;
}

/// The standard error of half a sum, or half a difference, of the two groups' means.
double standard_error(const OrderGroups& groups, double freedom) {
  const auto n_first = static_cast<double>(groups.first_first.size());
  const auto n_second = static_cast<double>(groups.second_first.size());
  const double squares = squares_about(groups.first_first, mean_of(groups.first_first)) +
                         squares_about(groups.second_first, mean_of(groups.second_first));
  return without_noise(0.5 * std::sqrt(squares / freedom * (1.0 / n_first + 1.0 / n_second)));
}

Interval interval_around(double estimate, double half_width) {
  return {std::clamp(estimate - half_width, -1.0, 1.0),
          std::clamp(estimate + half_width, -1.0, 1.0)};
}

/// For each block, the term that changes sign when the block's orders are exchanged. The sum of the
/// terms is proportional to the groups' difference in period differences.
std::vector<double> sign_flip_terms(std::span<const CrossoverPerson> people, double null) {
  const auto period_difference = [null](const CrossoverPerson& one) {
    return one.first_method_first ? one.difference - null : null - one.difference;
  };
  double mean = 0.0;
  std::map<int, std::vector<const CrossoverPerson*>> blocks;
  std::vector<const CrossoverPerson*> unpaired;
  for (const CrossoverPerson& one : people) {
    mean += period_difference(one) / static_cast<double>(people.size());
    if (one.block >= 0) {
      blocks[one.block].push_back(&one);
    } else {
      unpaired.push_back(&one);
    }
  }
  std::vector<double> terms;
  for (const auto& [block, partners] : blocks) {
    if (partners.size() == 2 &&
        partners[0]->first_method_first != partners[1]->first_method_first) {
      terms.push_back(
          without_noise(partners[0]->difference + partners[1]->difference - 2.0 * null));
    } else {
      unpaired.insert(unpaired.end(), partners.begin(), partners.end());
    }
  }
  for (const CrossoverPerson* one : unpaired) {
    const double distance = period_difference(*one) - mean;
    terms.push_back(without_noise(one->first_method_first ? distance : -distance));
  }
  return terms;
}

}  // namespace

CrossoverEstimate crossover_estimate(std::span<const CrossoverPerson> people, double null,
                                     Sides sides, double level) {
  require_finite_people(people, null);
  require_level(level);
  const OrderGroups groups = groups_of(people);
  CrossoverEstimate estimate{.first_first = static_cast<int>(groups.first_first.size()),
                             .second_first = static_cast<int>(groups.second_first.size())};
  if (!groups.has_both()) return estimate;
  const double first = mean_of(groups.first_first);
  const double second = mean_of(groups.second_first);
  estimate.effect = without_noise(0.5 * (first + second));
  estimate.period = without_noise(0.5 * (second - first));
  if (people.size() < 3) return estimate;
  const auto freedom = static_cast<double>(people.size() - 2);
  const double error = standard_error(groups, freedom);
  const boost::math::students_t_distribution<> distribution(freedom);
  if (error == 0.0) {
    estimate.p = crossover_permutation(people, null, sides)->p;
    return estimate;
  }
  const double half_width = error * quantile(complement(distribution, 0.5 * (1.0 - level)));
  estimate.interval = interval_around(*estimate.effect, half_width);
  estimate.period_interval = interval_around(*estimate.period, half_width);
  const double t = (*estimate.effect - null) / error;
  estimate.p = sides == Sides::one
                   ? cdf(complement(distribution, t))
                   : std::min(1.0, 2.0 * cdf(complement(distribution, std::abs(t))));
  return estimate;
}

std::optional<CrossoverPermutation> crossover_permutation(std::span<const CrossoverPerson> people,
                                                          double null, Sides sides) {
  require_finite_people(people, null);
  if (!groups_of(people).has_both()) return std::nullopt;
  const std::vector<double> terms = sign_flip_terms(people, null);
  return CrossoverPermutation{*sign_flip_p(terms, sides), sign_flip_min_p(terms, sides)};
}

}  // namespace touchtrial::analysis
