/// \file A session's way through its schedule: what is due next, given what became of what was
/// presented. The runner and `verify` take the same course over the same events.
#pragma once

#include "protocols/design/schedule.hpp"
#include "protocols/design/study.hpp"

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace touchtrial::design {

/// A block that comes again in a fresh order, under new trial numbers: nothing in clear then links
/// two presentations of one stimulus.
struct BlockRestart {
  int block = 0;
  std::vector<Presentation> presentations;

  [[nodiscard]] int first_trial() const { return presentations.front().trial; }
};

/// A queue of presentations. Not thread-safe.
class Course {
 public:
  /// Draws a block's presentations anew, as restarted_block does for a study and an enrolment.
  using DrawBlock =
      std::function<std::vector<Presentation>(int block, int restarts_before, int first_trial)>;

  /// \param policy  what follows a presentation that was spoilt
  /// \param draw  needed only if the policy restarts blocks
  /// \throws std::invalid_argument if it is needed and missing
  Course(Schedule schedule, OnInterruption policy, DrawBlock draw = {});

  /// The schedule with which the session began, followed by the blocks that were restarted.
  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }
  /// The presentation that is under way or due next; null when all are done.
  [[nodiscard]] const Presentation* current() const noexcept;
  /// Presentations still to be done, the current one included.
  [[nodiscard]] int left() const noexcept { return static_cast<int>(queue_.size()); }
  [[nodiscard]] bool is_over() const noexcept { return queue_.empty(); }

  /// The current presentation is done. \pre there is one
  void finish();
  /// The current presentation was spoilt: it comes again at the end, is left out, or waits for its
  /// block's restart, as the policy says. \pre there is one
  void spoil();

  /// The block that must be restarted before anything else is presented.
  [[nodiscard]] std::optional<int> block_to_restart() const noexcept { return to_restart_; }
  /// Draws the next restart of a block; changes nothing. The new trials are numbered after all
  /// others.
  [[nodiscard]] BlockRestart drawn_again(int block) const;
  /// Puts the restarted block in place of what was left of it, before everything else.
  void restart(const BlockRestart& again);
  /// Whether a trial's number was given up when its block was restarted.
  [[nodiscard]] bool was_given_up(int trial) const;
  /// \return whether the schedule has a trial of this number
  [[nodiscard]] bool has(int trial) const;

 private:
  Schedule schedule_;
  OnInterruption policy_;
  DrawBlock draw_;
  std::deque<std::size_t> queue_;    ///< indices into the schedule, the current one first
  std::map<int, int> restarts_;      ///< of each block
  std::map<int, int> first_trials_;  ///< of each block's last restart
  std::optional<int> to_restart_;
};

}  // namespace touchtrial::design
