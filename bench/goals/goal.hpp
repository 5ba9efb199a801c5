/// \file The goals: how fast and how accurate the engine should be, and what it achieves.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/timing.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::bench {

/// The quantity that a target limits from above.
enum class Limit {
  ratio,     ///< our time / the peer's time
  of_bound,  ///< our time / the machine's bound
  time_us,   ///< our time
  error,     ///< our error against double, in `error_unit`
  count      ///< `count`, in `count_unit`
};

struct GoalResult {
  std::string goal;
  std::string peer;  ///< "" if there is none
  double ours_us = kNotTaken;
  double peer_us = kNotTaken;
  double ratio = kNotTaken;
  std::string bound;  ///< what the machine cannot do faster; "" if none was measured
  double bound_us = kNotTaken;
  double of_bound = kNotTaken;  ///< ours / bound
  double error = kNotTaken;
  std::string error_unit;
  double count = kNotTaken;
  std::string count_unit;
  Limit limit = Limit::ratio;
  double target = kNotTaken;  ///< kNotTaken: not a goal, listed for the record
};

/// The number that the target limits.
[[nodiscard]] double limited_number(const GoalResult& result) noexcept;
/// Whether there is a target at all.
[[nodiscard]] bool has_target(const GoalResult& result) noexcept;
/// Whether the number was taken and does not exceed the target.
[[nodiscard]] bool is_met(const GoalResult& result) noexcept;

/// Measures one goal, or several that share their work.
using Goal = std::function<std::vector<GoalResult>(const Effort& effort)>;

/// The time of every kernel compared with its peer, and how soon TV-Gabor comes close to its
/// texture.
/// \param targets  this machine's SIMD targets, best first
[[nodiscard]] std::vector<Goal> kernel_goals(const std::vector<std::string>& targets);
/// The accuracy of textures and MS-SSIM on every target.
[[nodiscard]] std::vector<Goal> error_goals(const std::vector<std::string>& targets);

/// The time and database size of a simulated study, and the cost of a start and a short command.
[[nodiscard]] std::vector<Goal> program_goals();

/// Compares with committed results, by what does not depend on a machine's speed: the ratios to
/// peer and bound.
/// \param committed  of results_json()
/// \return a line for each ratio that is more than a tenth larger than the committed one
/// \throws Error if the committed results are not such JSON
[[nodiscard]] std::vector<std::string> slower_than_committed(const std::vector<GoalResult>& results,
                                                             std::string_view committed);

/// The table for the terminal and the documentation: Markdown with aligned columns.
[[nodiscard]] std::string goals_table(const std::vector<GoalResult>& results);

}  // namespace touchtrial::bench
