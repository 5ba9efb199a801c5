/// \file What a session presented, in which order, held against the study that it is of.
#pragma once

#include "protocols/design/course.hpp"
#include "protocols/store/event.hpp"

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
  [[nodiscard]] const design::Schedule& schedule() const noexcept { return course_.schedule(); }
  [[nodiscard]] int presentations() const noexcept { return presentations_; }

 private:
  [[noreturn]] void fail(const store::Event& event, const std::string& why) const;
  [[noreturn]] void fail(const store::Event& event, int trial, const std::string& why) const;
  void follow_trial(const store::Event& event);
  void present(const store::Event& event);
  void require_under_way(const store::Event& event, int trial) const;
  void restart_block(const store::Event& event);
  void take_up(const store::Event& event);
  void close(const store::Event& event) const;

  const design::Study& study_;
  design::Course course_;
  bool is_under_way_ = false;  ///< the course's current presentation waits for its answer
  bool is_spoilt_ = false;     ///< the program ended in it
  bool is_paused_ = false;
  bool is_stopped_ = false;
  int presentations_ = 0;
};

}  // namespace touchtrial::analysis
