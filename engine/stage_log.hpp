/// \file What was computed, what was reused and what was skipped, and why: the work behind a
/// result, stage by stage, for people who ask.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::engine {

enum class StageState { computed, reused, skipped };

/// "computed", "reused", "skipped"
[[nodiscard]] std::string_view name_of(StageState state);

/// One stage of one stimulus, or of the whole study.
struct Stage {
  std::string name;
  StageState state = StageState::computed;
  std::string why;
  double seconds = 0.0;     ///< spent; 0 if skipped
  std::uint64_t bytes = 0;  ///< of the result: made, found again, or not made
};

/// Stages in the order in which they were met. Not thread-safe: one log for one thread's work.
/// Where nobody asks there is no log, and a null pointer costs nothing.
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

/// Measures a stage from its construction on.
class StageTimer {
 public:
  explicit StageTimer(StageLog* log) : log_(log) {
    if (log_ != nullptr) start_ = Clock::now();
  }

  /// The stage that began with the timer, or with the last one done, is computed.
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
