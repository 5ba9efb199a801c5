/// \file The plan of a power run, and texts that the power reports of all protocols share. Source:
/// docs/planning.md.
#pragma once

#include "analysis/statistics/proportion.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::planning {

inline constexpr int kMaxPowerRuns = 100'000;
inline constexpr int kMaxPowerParticipants = 10'000;
inline constexpr std::size_t kMaxPowerSizes = 64;
/// The maximum total number of runs over all sizes.
inline constexpr std::int64_t kMaxTotalPowerRuns = 1'000'000;

struct PowerPlan {
  std::vector<int> participants;  ///< sizes, rising, each once
  int runs = 1000;                ///< simulated studies of each size and hypothesis
  std::uint64_t seed = 1;
  int explorations = 1000;  ///< per stimulus; trials draw from them
  int trainings = 16;       ///< number of trained subjects that studies draw from
  double level = 0.05;      ///< of the primary test
  double margin = 0.0;      ///< of the primary test; 0: none
};

/// Sorts the sizes and validates the plan.
/// \throws UsageError if a size appears twice or a number is out of range
void validate_plan(PowerPlan& plan);

/// Parses a comma-separated list of whole numbers: "8,12,16".
/// \param option  for the message
/// \param what  the meaning of a number, for the message: "a number of participants"
/// \throws UsageError if a part is not a whole number >= 0
[[nodiscard]] std::vector<int> parse_numbers(std::string_view text, const std::string& option,
                                             const std::string& what);

/// \return a subject model on one line: its file, its main numbers, and a digest of all of them
[[nodiscard]] std::string words_of(const simulation::SubjectModel& subject);

/// \return a share in per cent: "84.3"
[[nodiscard]] std::string power_per_cent(double share);
/// \return an interval of shares in per cent: "[80.9, 87.3]"
[[nodiscard]] std::string power_range(const analysis::Interval& interval);

}  // namespace touchtrial::planning
