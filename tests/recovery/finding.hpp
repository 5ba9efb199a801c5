/// \file One line of the table: a known quantity, and the value that the analysis found for it.
#pragma once

#include "core/random.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::recovery {

/// A share or a mean over many simulated studies.
struct Finding {
  std::string group;       ///< "coverage", "type-I error", "power", "bias", "recovered"
  std::string what;        ///< the statistic
  std::string population;  ///< whose studies
  double nominal = 0.0;    ///< the true or promised value
  double found = 0.0;
  double monte_carlo = 0.0;  ///< standard error of `found`
  /// Range of the expected value of `found`; nominal to nominal where it is exact.
  double least = 0.0;
  double most = 0.0;
  std::string why{};  ///< why the range is not the nominal value alone

  /// Within 4 Monte-Carlo standard errors of its range.
  [[nodiscard]] bool holds() const noexcept;
};

/// The mean of a number over simulated studies.
struct Average {
  double mean = 0.0;
  double standard_error = 0.0;
};
/// Runs `study` once for each repetition, on all cores, each with random numbers of its own, and
/// averages each of the numbers that it returns (ones and zeros for a share). The result depends
/// only on the arguments.
[[nodiscard]] std::vector<Average> averages_of(
    int repetitions, const std::string& purpose,
    const std::function<std::vector<double>(RandomStream&)>& study);

/// The same for studies that return one number.
[[nodiscard]] Average average_of(int repetitions, const std::string& purpose,
                                 const std::function<double(RandomStream&)>& study);

/// All lines of the group.
/// \param repetitions  simulated studies for each line, >= 100
[[nodiscard]] std::vector<Finding> coverage_findings(int repetitions);
[[nodiscard]] std::vector<Finding> error_findings(int repetitions);
[[nodiscard]] std::vector<Finding> estimate_findings(int repetitions);
/// Lines of several groups about the registered question.
[[nodiscard]] std::vector<Finding> registered_findings(int repetitions);
/// Of several groups, on two methods, one after the other.
[[nodiscard]] std::vector<Finding> crossover_findings(int repetitions);
/// Of every group, on observers of single cues.
[[nodiscard]] std::vector<Finding> cue_findings(int repetitions);
/// Of every group, on differences between people.
[[nodiscard]] std::vector<Finding> people_findings(int repetitions);
/// Of every group, on unbiased hit rates, order, confidence and stations.
[[nodiscard]] std::vector<Finding> measures_findings(int repetitions);

}  // namespace touchtrial::recovery
