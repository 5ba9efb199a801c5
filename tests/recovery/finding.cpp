#include "recovery/finding.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::recovery {

bool Finding::holds() const noexcept {
  const double slack = 4.0 * monte_carlo;
  return found >= least - slack && found <= most + slack;
}

Average average_of(int repetitions, const std::string& purpose,
                   const std::function<double(RandomStream&)>& study) {
  std::vector<double> results(static_cast<std::size_t>(repetitions));
  in_parallel(0, results.size(), [&](std::size_t i) {
    RandomStream random(31875542, purpose, i);
    results[i] = study(random);
  });
  double sum = 0.0;
  for (const double one : results) sum += one;
  const double mean = sum / repetitions;
  double squares = 0.0;
  for (const double one : results) squares += (one - mean) * (one - mean);
  // A share of 0 or 1 is not known to be exact: one study that differs is allowed for.
  const double least_error = 1.0 / repetitions;
  const double error = std::sqrt(squares / (repetitions - 1.0) / repetitions);
  return {mean, std::max(error, squares == 0.0 ? least_error : 0.0)};
}

}  // namespace touchtrial::recovery
