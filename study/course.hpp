/// \file A session's course through its schedule: what is presented next, given how the earlier
/// trials ended. The runner and `verify` derive the same course from the same events.
#pragma once

#include "study/order.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace touchtrial::study {

/// A block that is presented again in a fresh order and under new trial numbers, so that nothing
/// unencrypted links two presentations of one stimulus.
struct BlockRestart {
  int block = 0;
  std::vector<Trial> trials;

  [[nodiscard]] int first_trial() const { return trials.front().place.trial; }
};

/// A queue of trials. Not thread-safe.
class Course {
 public:
  /// \param policy  what follows an interrupted trial
  /// \throws std::invalid_argument if the policy restarts blocks and the order is adaptive
  Course(std::unique_ptr<Order> order, OnInterruption policy);

  /// The session's initial schedule, followed by the restarted blocks.
  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }
  /// The trial that is running or comes next; null when all are done.
  [[nodiscard]] const Trial* current() const noexcept { return current_ ? &*current_ : nullptr; }
  /// The number of remaining trials, including the current one.
  [[nodiscard]] int remaining() const noexcept { return static_cast<int>(queue_.size()); }
  [[nodiscard]] bool is_over() const noexcept { return queue_.empty(); }
  [[nodiscard]] bool is_adaptive() const noexcept { return order_->is_adaptive(); }

  /// Marks the current trial as done.
  /// \param answer  nothing if the trial ended without one; the order is then not notified
  /// \pre there is a current trial
  void finish(const std::optional<Answer>& answer);
  /// Marks the current trial as interrupted. Depending on the policy, it is left out, waits for its
  /// block's restart, or is repeated at the end (in an adaptive order, at the end of its block).
  /// \pre there is a current trial
  void interrupt();

  /// The block that must be restarted before anything else is presented.
  [[nodiscard]] std::optional<int> block_to_restart() const noexcept { return block_to_restart_; }
  /// Draws the next restart of a block without changing the course. New trials get the next free
  /// numbers.
  [[nodiscard]] BlockRestart redrawn_block(int block) const;
  /// Replaces the block's remaining trials by the restarted block, which is presented next.
  void restart(const BlockRestart& restarted);
  /// Whether a trial's number became invalid when its block was restarted.
  [[nodiscard]] bool is_void(int trial) const;
  /// Whether the schedule has a trial of this number.
  [[nodiscard]] bool has_trial(int trial) const;

 private:
  /// Lets the order choose the next trial's planes.
  void choose_planes();
  /// The number of queued trials that precede the repetition of an interrupted trial of this block.
  [[nodiscard]] std::ptrdiff_t places_before_repeats(int block) const;

  std::unique_ptr<Order> order_;
  Schedule schedule_;
  OnInterruption policy_;
  std::deque<std::size_t> queue_;  ///< indices into the schedule, current one first
  std::optional<Trial> current_;
  std::map<int, int> restarts_;      ///< number of restarts, by block
  std::map<int, int> first_trials_;  ///< number of the first trial of the last restart, by block
  std::optional<int> block_to_restart_;
};

}  // namespace touchtrial::study
