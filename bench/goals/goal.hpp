/// \file The goals: how fast and how exact the engine is to be, and how it does.
#pragma once

#include "bench/case.hpp"
#include "bench/measure/effort.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// What a goal's target is the upper limit of.
enum class Limit {
  ratio,    ///< our time / the peer's time
  time_us,  ///< our time
  error,    ///< our error against double, in `error_unit`
  count     ///< of what `count_unit` says
};

struct GoalResult {
  std::string goal;
  std::string peer;  ///< "" if there is none
  double ours_us = kNotTaken;
  double peer_us = kNotTaken;
  double ratio = kNotTaken;
  double error = kNotTaken;
  std::string error_unit;
  double count = kNotTaken;
  std::string count_unit;
  Limit limit = Limit::ratio;
  double target = kNotTaken;  ///< kNotTaken: no goal, said for the record
};

/// The figure that the target limits.
[[nodiscard]] double limited_figure(const GoalResult& result) noexcept;
/// Whether there is a target at all.
[[nodiscard]] bool has_target(const GoalResult& result) noexcept;
/// Whether the figure was taken and keeps to the target.
[[nodiscard]] bool is_met(const GoalResult& result) noexcept;

/// One goal, or a few that come from the same work.
using Goal = std::function<std::vector<GoalResult>(const Effort& effort)>;

/// Every kernel beside its peer.
/// \param targets  this machine's SIMD targets, best first
[[nodiscard]] std::vector<Goal> kernel_goals(const std::vector<std::string>& targets);
/// How exact textures and MS-SSIM are, on every one of the targets.
[[nodiscard]] std::vector<Goal> error_goals(const std::vector<std::string>& targets);

/// How soon TV-Gabor is close to its texture.
[[nodiscard]] std::vector<Goal> tv_gabor_goals();
/// The time of a simulated study, and what its database takes.
[[nodiscard]] std::vector<Goal> study_goals();
/// What a start of the program costs, and a short command.
[[nodiscard]] std::vector<Goal> start_goals();

/// The table as it is printed and as it stands in the documentation (Markdown, columns aligned).
[[nodiscard]] std::string goals_table(const std::vector<GoalResult>& results);

}  // namespace touchtrial::bench
