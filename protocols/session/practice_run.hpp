/// \file Practice with feedback, until enough answers of a round were correct. Private to the
/// runner.
#pragma once

#include "protocols/session/attended_exploring.hpp"
#include "protocols/session/session_desk.hpp"

#include <optional>
#include <vector>

namespace touchtrial::session {

/// How far practice has come.
struct PracticeProgress {
  int round = 1;    ///< that is under way, or comes next
  int done = 0;     ///< presentations of that round
  int correct = 0;  ///< of them
  bool passed = false;
};
/// \param practised  in their order  \param a_round  presentations of a round
[[nodiscard]] PracticeProgress progress_of(const std::vector<store::PracticeBody>& practised,
                                           const design::PracticePlan& plan, int a_round);

/// The practice of a session. Goes on where an earlier run of the program has left off.
class PracticeRun {
 public:
  PracticeRun(SessionDesk& desk, const PracticeTextures& textures);

  /// \return whether the session goes on
  [[nodiscard]] bool run();

 private:
  [[nodiscard]] PracticeProgress progress() const;
  [[nodiscard]] bool run_round(int round);
  /// \return nothing if it was interrupted, and is to be done again if the session goes on
  [[nodiscard]] std::optional<store::PracticeBody> present(const PracticeProgress& at, int position,
                                                           const engine::RenderingModel& model);
  [[nodiscard]] bool explore(const engine::RenderingModel& model);
  [[nodiscard]] std::optional<StepReply> answer(const AnswerStep& step);

  SessionDesk& desk_;
  const PracticeTextures& textures_;
  AttendedExploring participant_;
  device::ServoOptions servo_;
  store::Trace trace_;
  int a_round_;
};

}  // namespace touchtrial::session
