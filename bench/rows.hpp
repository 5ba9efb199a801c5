/// \file The benchmark's table. A row compares a job of the engine with the same job by peers, with
/// the machine's bound, and with the goal.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::bench {

/// A job with its inputs and outputs, which can be run repeatedly.
struct Job {
  std::function<void()> run;  ///< overwrites the previous outputs; allocates no planes
  /// The error of the last run's outputs against double precision; empty if not defined.
  std::function<double()> error{};
  /// A count, for instance of steps; empty if nothing is counted.
  std::function<double()> count{};
};

/// How a job is timed.
enum class Clock {
  processor,  ///< of the process, in all threads
  wall,       ///< for work that includes the disk
  none        ///< not timed: the job only has an error or a count
};

/// A job that is created on demand, so that its inputs are in memory only while it is measured.
struct Case {
  std::string name;  ///< "touchtrial", or for instance "OpenCV filter2D, f32"
  std::function<Job()> make;
  /// A larger error means that the case does not compute the same result.
  double tolerance = std::numeric_limits<double>::infinity();
  std::string simd_target = {};  ///< to run on; "" for the best
  Clock clock = Clock::processor;
  int threads = 1;       ///< that the engine may use
  int operations = 1;    ///< in one run; times are divided by it
  bool is_slow = false;  ///< few repetitions
};

using Cases = std::vector<Case>;

/// A case with its own state.
/// \param make_state  returns the state: its inputs and outputs
/// \param run  called with the state
template <class MakeState, class Run>
[[nodiscard]] Case timed(std::string name, MakeState make_state, Run run) {
  return {std::move(name), [=] {
            const auto state = std::make_shared<decltype(make_state())>(make_state());
            return Job{[=] { run(*state); }};
          }};
}

/// The same with an error.
/// \param error  called with the state after a run
template <class MakeState, class Run, class Error>
[[nodiscard]] Case timed(std::string name, MakeState make_state, Run run, Error error,
                         double tolerance) {
  return {std::move(name),
          [=] {
            const auto state = std::make_shared<decltype(make_state())>(make_state());
            return Job{.run = [=] { run(*state); }, .error = [=] { return error(*state); }};
          },
          tolerance};
}

/// A case that is only counted.
[[nodiscard]] inline Case counted(std::string name, std::function<double()> count) {
  return {.name = std::move(name),
          .make = [=] { return Job{.run = {}, .count = count}; },
          .clock = Clock::none};
}

/// A number of a row, and what limits it from above.
struct Goal {
  /// "ratio" (to the first peer), "of bound", "us" or "count"; "" for none.
  std::string_view limits;
  double target = 0.0;
};

struct Row {
  std::string what;
  Case ours;
  Cases peers = {};  ///< the first one is the goal's, the others are for the record
  /// The machine's bounds by name. Variants of one bound differ after a comma, and the fastest
  /// counts.
  Cases bounds = {};
  Goal goal = {};
  std::string error_unit = {};
  std::string count_unit = {};
};

using Rows = std::vector<Row>;

/// The options of the run.
struct Scope {
  std::vector<std::string> simd_targets;  ///< of this machine, best first
  bool quick = false;                     ///< few repetitions and pictures
};

/// Fractional filters, sub-bands and whole extractions.
[[nodiscard]] Rows extraction_rows(const Scope& scope);
/// MS-SSIM, co-occurrence statistics and TV-Gabor.
[[nodiscard]] Rows metric_rows(const Scope& scope);
/// The servo's computations in a tick: forces, kinematics, and the whole tick.
[[nodiscard]] Rows servo_rows();
/// A whole simulated study.
[[nodiscard]] Rows study_rows();

/// The side of a default stimulus.
inline constexpr int kDefaultSize_px = 500;
/// The method's default K.
inline constexpr int kDefaultRadius = 2;
/// The order of all cases with a fixed order.
inline constexpr double kFixedOrder = 0.55;

/// "AVX-512" for Highway's "AVX3" and its relatives; other names are unchanged.
[[nodiscard]] inline std::string instruction_set_of(const std::string& simd_target) {
  return simd_target.starts_with("AVX3") ? "AVX-512" : simd_target;
}

}  // namespace touchtrial::bench
