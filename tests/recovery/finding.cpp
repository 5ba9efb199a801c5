#include "recovery/finding.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::recovery {

bool Finding::holds() const noexcept {
  const double slack = 4.0 * monte_carlo;
  return found >= least - slack && found <= most + slack;
}

namespace {

Average average(const std::vector<std::vector<double>>& results, std::size_t number) {
  const auto repetitions = static_cast<double>(results.size());
  double sum = 0.0;
  for (const auto& one : results) sum += one[number];
  const double mean = sum / repetitions;
  double squares = 0.0;
  for (const auto& one : results) squares += (one[number] - mean) * (one[number] - mean);
  // A share of 0 or 1 is not known to be exact: one study that differs is allowed for.
  const double least_error = 1.0 / repetitions;
  const double error = std::sqrt(squares / (repetitions - 1.0) / repetitions);
  return {mean, std::max(error, squares == 0.0 ? least_error : 0.0)};
}

}  // namespace

std::vector<Average> averages_of(int repetitions, const std::string& purpose,
                                 const std::function<std::vector<double>(RandomStream&)>& study) {
  std::vector<std::vector<double>> results(static_cast<std::size_t>(repetitions));
  in_parallel(0, results.size(), [&](std::size_t i) {
    RandomStream random(31875542, purpose, i);
    results[i] = study(random);
  });
  std::vector<Average> averages;
  for (std::size_t i = 0; i < results.front().size(); ++i) averages.push_back(average(results, i));
  return averages;
}

Average average_of(int repetitions, const std::string& purpose,
                   const std::function<double(RandomStream&)>& study) {
  return averages_of(repetitions, purpose,
                     [&](RandomStream& random) { return std::vector<double>{study(random)}; })[0];
}

}  // namespace touchtrial::recovery
