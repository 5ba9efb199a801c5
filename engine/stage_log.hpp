/// \file A log of the stages of a computation, for users who ask for it: what was computed, reused
/// or skipped, and why.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::engine {

enum class StageState { computed, reused, skipped };

/// The state as a word, for instance "computed".
[[nodiscard]] constexpr std::string_view name_of(StageState state) {
  if (state == StageState::computed) return "computed";
  return state == StageState::reused ? "reused" : "skipped";
}

/// One stage of one stimulus, or of the whole study.
struct Stage {
  std::string name;
  StageState state = StageState::computed;
  std::string why;
  double seconds = 0.0;     ///< 0 if reused or skipped
  std::uint64_t bytes = 0;  ///< size of the stage's result, even if it was skipped
};

/// Stages in the order in which they were added. Not thread-safe: each thread has a log of its own.
/// A function that takes a pointer to a log accepts nullptr, which costs nothing.
class StageLog {
 public:
  void add(Stage stage) { stages_.push_back(std::move(stage)); }
  void reuse(std::string name, std::string why, std::uint64_t bytes) {
    add({std::move(name), StageState::reused, std::move(why), 0.0, bytes});
  }
  void skip(std::string name, std::string why, std::uint64_t bytes) {
    add({std::move(name), StageState::skipped, std::move(why), 0.0, bytes});
  }

  [[nodiscard]] const std::vector<Stage>& stages() const noexcept { return stages_; }

 private:
  std::vector<Stage> stages_;
};

/// Measures stages that follow one another.
class StageTimer {
 public:
  /// \param log  may be nullptr; then nothing is measured
  explicit StageTimer(StageLog* log) : log_(log) {
    if (log_ != nullptr) start_ = Clock::now();
  }

  /// Adds the computed stage that began at the timer's construction or at the last call.
  void done(std::string_view name, std::string_view why, std::uint64_t bytes) {
    if (log_ == nullptr) return;
    const Clock::time_point now = Clock::now();
    log_->add({std::string(name), StageState::computed, std::string(why),
               std::chrono::duration<double>(now - start_).count(), bytes});
    start_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  StageLog* log_;
  Clock::time_point start_;
};

}  // namespace touchtrial::engine
