/// \file Checks that a session's presentations and their order agree with its study.
#pragma once

#include "record/event.hpp"
#include "record/session_bodies.hpp"
#include "study/course.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

/// Follows a session's events in the same way as the runner, which presents exactly what is due:
/// catch trials and lead-ins in their places, interrupted presentations as the study's policy
/// requires, and restarted blocks in the order that the study gives them.
class SessionCourse {
 public:
  /// \param study  must outlive this object
  /// \param opened  the answers are opened, so an adaptive order's choices can be checked;
  ///   otherwise only the place of each presentation is checked
  /// \throws StudyError if the study has no order for this enrolment number
  SessionCourse(const study::Study& study, const study::ScheduleDraw& draw, bool opened = true);

  /// Checks the session's next event.
  /// \throws VerificationError, naming the session and its event or trial, if the event cannot
  ///   follow the earlier ones
  void follow(const record::Event& event);

  /// The schedule with which the session began, followed by the restarted blocks.
  [[nodiscard]] const study::Schedule& scheduled() const noexcept { return course_.schedule(); }
  /// Whether the answers decide what comes next.
  [[nodiscard]] bool is_adaptive() const noexcept { return course_.is_adaptive(); }
  [[nodiscard]] int presentations() const noexcept { return presentations_; }

 private:
  [[noreturn]] void fail(const record::Event& event, const std::string& why) const;
  [[noreturn]] void fail(const record::Event& event, int trial, const std::string& why) const;
  void follow_trial(const record::Event& event);
  void present(const record::Event& event);
  void answer(const record::Event& event);
  void require_chosen(const record::Event& event, const record::AnswerBody& body) const;
  void require_under_way(const record::Event& event, int trial) const;
  void restart_block(const record::Event& event);
  void take_up(const record::Event& event);
  void close(const record::Event& event) const;

  const study::Study& study_;
  bool opened_;
  study::Course course_;
  bool is_under_way_ = false;    ///< the course's current presentation waits for its answer
  bool is_interrupted_ = false;  ///< the program ended during the current presentation
  bool is_paused_ = false;
  bool is_stopped_ = false;
  int presentations_ = 0;
};

}  // namespace touchtrial::analysis
