/// \file A session's course through its schedule, which decides what is presented next, given how
/// the earlier presentations ended. The runner and `verify` follow the same course over the same
/// events.
#pragma once

#include "study/adaptive_order.hpp"
#include "study/schedule.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace touchtrial::study {

/// A block that is presented again in a fresh order and under new trial numbers, so that nothing in
/// clear links two presentations of one stimulus.
struct BlockRestart {
  int block = 0;
  std::vector<Presentation> presentations;

  [[nodiscard]] int first_trial() const { return presentations.front().trial; }
};

/// A queue of presentations. Not thread-safe.
class Course {
 public:
  /// Draws a block's presentations again, as restarted_block does for a study and an enrolment.
  using DrawBlock =
      std::function<std::vector<Presentation>(int block, int restarts_before, int first_trial)>;

  /// \param policy  what follows an interrupted presentation
  /// \param draw  needed only if the policy restarts blocks
  /// \param order  chooses each presentation when it becomes the current one; null: the schedule
  ///   says all
  /// \throws std::invalid_argument if `draw` is needed and missing, or the policy restarts blocks
  ///   whose presentations an order chooses
  Course(Schedule schedule, OnInterruption policy, DrawBlock draw = {},
         std::unique_ptr<AdaptiveOrder> order = nullptr);

  /// The schedule with which the session began, followed by the restarted blocks.
  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }
  /// The presentation that is under way or is next; null when all are done.
  [[nodiscard]] const Presentation* current() const noexcept;
  /// The number of remaining presentations, including the current one.
  [[nodiscard]] int left() const noexcept { return static_cast<int>(queue_.size()); }
  [[nodiscard]] bool is_over() const noexcept { return queue_.empty(); }
  /// Whether the answers decide what comes next.
  [[nodiscard]] bool is_adaptive() const noexcept { return order_ != nullptr; }

  /// Marks the current presentation as done.
  /// \param position  of the answer, in the schedule's layout; nothing: it ended without one, and
  ///   an adaptive order hears nothing of it
  /// \pre there is a current presentation; the layout has the position
  void finish(std::optional<int> position);
  /// Marks the current presentation as interrupted. Depending on the policy, it is repeated at the
  /// end (if an order chooses, at the end of its block), is left out, or waits for its block's
  /// restart.
  /// \pre there is a current presentation
  void spoil();

  /// The block that must be restarted before anything else is presented.
  [[nodiscard]] std::optional<int> block_to_restart() const noexcept { return to_restart_; }
  /// Draws the next restart of a block without changing the course. The new trials get the numbers
  /// after all existing ones.
  [[nodiscard]] BlockRestart drawn_again(int block) const;
  /// Replaces the rest of the block by the restarted block, which comes before everything else.
  void restart(const BlockRestart& again);
  /// Whether a trial's number became invalid when its block was restarted.
  [[nodiscard]] bool was_given_up(int trial) const;
  /// Whether the schedule has a trial of this number.
  [[nodiscard]] bool has(int trial) const;

 private:
  /// Lets the order choose the current presentation.
  void choose();
  /// How many of the queue come before an interrupted presentation of this block is repeated.
  [[nodiscard]] std::ptrdiff_t places_before_repeats(int block) const;

  Schedule schedule_;
  OnInterruption policy_;
  DrawBlock draw_;
  std::unique_ptr<AdaptiveOrder> order_;
  std::deque<std::size_t> queue_;    ///< indices into the schedule, current one first
  std::map<int, int> restarts_;      ///< number of restarts, by block
  std::map<int, int> first_trials_;  ///< first trial of the last restart, by block
  std::optional<int> to_restart_;
};

}  // namespace touchtrial::study
