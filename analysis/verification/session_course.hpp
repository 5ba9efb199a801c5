/// \file What a session presented, in which order, held against the study that it is of.
#pragma once

#include "protocols/design/schedule.hpp"
#include "protocols/store/event.hpp"

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>

namespace touchtrial::analysis {

/// Goes through a session's events as its runner did, which presents what is due and nothing else:
/// catch trials and lead-ins in their places, what was interrupted as the study's policy has it,
/// blocks that were restarted in the order that the study gives them.
class SessionCourse {
 public:
  /// \param study  must outlive this \throws StudyError if the study has no order for it
  SessionCourse(const design::Study& study, int enrolment);

  /// Takes the session's next event.
  /// \throws VerificationError, naming session and trial, if it is not what can follow
  void follow(const store::Event& event);

  /// The schedule with which the session began, and after it the blocks that came again.
  [[nodiscard]] const design::Schedule& schedule() const noexcept { return schedule_; }
  [[nodiscard]] int presentations() const noexcept { return presentations_; }

 private:
  [[noreturn]] void fail(const store::Event& event, const std::string& why) const;
  [[noreturn]] void fail(const store::Event& event, int trial, const std::string& why) const;
  [[nodiscard]] bool is_over() const;  ///< what is under way, without an answer
  [[nodiscard]] bool was_voided(int trial) const;
  void follow_trial(const store::Event& event);
  void present(const store::Event& event);
  void require_under_way(const store::Event& event, int trial) const;
  void give_up(const store::Event& event, int trial);
  void restart_block(const store::Event& event);
  void take_up(const store::Event& event);
  void close(const store::Event& event) const;

  const design::Study& study_;
  int enrolment_;
  design::Schedule schedule_;
  std::deque<std::size_t> due_;           ///< indices of presentations
  std::map<int, int> restarts_;           ///< by block
  std::map<int, int> first_trials_;       ///< of the last restart, by block
  std::optional<std::size_t> under_way_;  ///< the presentation that waits for its answer
  bool is_timed_out_ = false;             ///< so that it may stay without
  bool is_spoilt_ = false;                ///< the program ended in it
  std::optional<int> block_to_restart_;
  bool is_paused_ = false;
  bool is_stopped_ = false;
  int presentations_ = 0;
};

}  // namespace touchtrial::analysis
