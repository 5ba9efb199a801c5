/// \file Checks that a session's presentations and their order agree with its study.
#pragma once

#include "record/event.hpp"
#include "record/session_bodies.hpp"
#include "study/course.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

/// Replays a session's events as the runner would: catch trials and lead-ins in their places,
/// interrupted presentations by the study's policy, and restarted blocks in the study's order.
class SessionCourse {
 public:
  /// \param study  must outlive this object
  /// \param answers_opened  whether the events contain the answers. Only then are an adaptive
  ///   order's choices checked, otherwise only the place of each presentation
  /// \throws StudyError if the study has no order for this enrolment number
  SessionCourse(const study::Study& study, const study::ScheduleDraw& draw,
                bool answers_opened = true);

  /// Checks the session's next event.
  /// \throws VerificationError, naming the session and its event or trial, if the event cannot
  ///   follow the earlier events
  void follow(const record::Event& event);

  /// The session's initial schedule, followed by the restarted blocks.
  [[nodiscard]] const study::Schedule& scheduled() const noexcept { return course_.schedule(); }
  /// Whether the answers determine the following trials.
  [[nodiscard]] bool is_adaptive() const noexcept { return course_.is_adaptive(); }
  [[nodiscard]] int presentations() const noexcept { return presentations_; }

 private:
  [[noreturn]] void fail(const record::Event& event, const std::string& reason) const;
  [[noreturn]] void fail(const record::Event& event, int trial, const std::string& reason) const;
  void follow_trial(const record::Event& event);
  void present(const record::Event& event);
  void answer(const record::Event& event);
  void require_chosen_level(const record::Event& event, const record::AnswerBody& body) const;
  void require_under_way(const record::Event& event, int trial) const;
  void restart_block(const record::Event& event);
  void resume(const record::Event& event);
  void close(const record::Event& event) const;

  const study::Study& study_;
  bool answers_opened_;
  study::Course course_;
  bool is_under_way_ = false;    ///< the current presentation has no answer yet
  bool is_interrupted_ = false;  ///< the program ended during the current presentation
  bool is_paused_ = false;
  bool is_stopped_ = false;
  int presentations_ = 0;
};

}  // namespace touchtrial::analysis
