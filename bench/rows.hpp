/// \file The benchmark table. A row compares the engine's time for a job with the times of peers,
///   with the machine's bound, and with a goal.
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
  /// The error of the last run's outputs relative to double precision; empty if undefined.
  std::function<double()> error{};
  /// A count, for instance of steps; empty if nothing is counted.
  std::function<double()> count{};
};

/// The clock that times a job.
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
  std::string simd_target = {};  ///< target to use; "" for the best
  Clock clock = Clock::processor;
  int threads = 1;       ///< maximum for the engine
  int operations = 1;    ///< per run; times are divided by it
  bool is_slow = false;  ///< few repetitions
};

using Cases = std::vector<Case>;

/// \return a case with its own state
/// \param make_state  returns the state: inputs and outputs
/// \param run  called with the state
template <class MakeState, class Run>
[[nodiscard]] Case timed(std::string name, MakeState make_state, Run run) {
  return {std::move(name), [=] {
            const auto state = std::make_shared<decltype(make_state())>(make_state());
            return Job{[=] { run(*state); }};
          }};
}

/// The same for a case with an error.
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

/// \return a case with only a count
[[nodiscard]] inline Case counted(std::string name, std::function<double()> count) {
  return {.name = std::move(name),
          .make = [=] { return Job{.run = {}, .count = count}; },
          .clock = Clock::none};
}

/// The upper limit of one of a row's metrics.
struct Goal {
  /// "ratio" (to the first peer), "of bound", "us" or "count"; "" for no goal.
  std::string_view metric;
  double target = 0.0;
};

struct Row {
  std::string title;
  Case ours;
  Cases peers = {};  ///< the goal refers to the first; the others are for information
  /// The machine's bounds. Names of variants differ after a comma; the fastest variant counts.
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

/// Fractional filters, sub-bands and complete extractions.
[[nodiscard]] Rows extraction_rows(const Scope& scope);
/// MS-SSIM, co-occurrence statistics and TV-Gabor.
[[nodiscard]] Rows metric_rows(const Scope& scope);
/// The servo's computations in a tick: forces, kinematics, and the complete tick.
[[nodiscard]] Rows servo_rows();
/// A complete simulated study.
[[nodiscard]] Rows study_rows();

/// The side of a default stimulus.
inline constexpr int kDefaultSize_px = 500;
/// The method's default K.
inline constexpr int kDefaultRadius = 2;
/// The order of all cases with a fixed order.
inline constexpr double kFixedOrder = 0.55;

/// \return "AVX-512" for Highway's "AVX3" and its variants; other names are unchanged
[[nodiscard]] inline std::string instruction_set_of(const std::string& simd_target) {
  return simd_target.starts_with("AVX3") ? "AVX-512" : simd_target;
}

}  // namespace touchtrial::bench
