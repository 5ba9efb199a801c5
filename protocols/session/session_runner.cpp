#include "protocols/session/session_runner.hpp"

#include "protocols/session/plane_run.hpp"
#include "protocols/session/session_desk.hpp"
#include "protocols/session/trial_trace.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace touchtrial::session {
namespace {

using Time = SessionClock::Time;

// Durations in virtual time only.
constexpr std::chrono::seconds kBreak{60};
constexpr std::chrono::seconds kTrialGap{2};
/// Minimum remaining time for which the participant may return to the plane.
constexpr double kMinReturnS = 0.5;

/// Runs the trials of a session one after the other. In each presentation, the participant gets
/// ready, explores, and answers.
class TrialRun {
 public:
  TrialRun(SessionDesk& desk, SessionTally& tally)
      : desk_(desk),
        session_(desk.session()),
        parts_(desk.parts()),
        tally_(tally),
        servo_options_(desk.servo_options()) {}

  /// Runs the current presentation to its answer or interruption.
  /// \pre the session is ready
  void run();
  /// The number of trials that were repeated because they were not explored as instructed.
  [[nodiscard]] int repeated_trials() const noexcept { return repeated_trials_; }

 private:
  /// Start and end of an exploration by the servo's clock.
  struct Span {
    Time start;
    Time end;
  };
  [[nodiscard]] Span note_exploration(const Exploration& exploration, Time plane_on);
  /// Presents the trial's planes.
  /// \param is_return  whether the participant returns to the plane before answering
  /// \return whether the participant must answer
  [[nodiscard]] bool explore(bool is_return);
  [[nodiscard]] PlanesEnd run_planes(bool is_return);
  [[nodiscard]] bool interrupt_if_late();
  void answer();
  [[nodiscard]] AnswerStep question() const;
  void confirm(const StepReply& reply);
  void keep_evidence();
  [[nodiscard]] bool rejects_late_answers() const {
    return parts_.key.study.trials.on_timeout == study::OnTimeout::no_response;
  }

  SessionDesk& desk_;
  Session& session_;
  const SessionParts& parts_;
  SessionTally& tally_;
  device::ServoOptions servo_options_;
  study::Trial trial_;  ///< the current trial
  study::TrialQuestion trial_question_;
  TrialTrace trace_;
  Time presented_at_{};
  Exploration last_exploration_{};  ///< the trial's last exploration
  Time exploration_end_{};          ///< end of that exploration
  int total_ = 0;                   ///< expected number of presentations
  int repeated_trials_ = 0;         ///< trials that were not explored as instructed
  bool hand_was_off_ = false;       ///< in the previous trial
  bool time_is_up_ = false;
};

void TrialRun::run() {
  total_ = session_.presentations_begun() + session_.presentations_left();
  time_is_up_ = false;
  trial_ = *session_.current();
  trial_question_ = parts_.key.study.task->ask(parts_.key.study, trial_.place);
  desk_.enter("ready");
  const bool hand_off = trial_.place.hand_off;
  if (hand_off && !hand_was_off_) {
    const NoticeStep notice{NoticeStep::What::hand_off, session_.presentations_begun()};
    if (!desk_.show_step(notice)) return;
  }
  hand_was_off_ = hand_off;
  if (!desk_.show_step(ReadyStep{session_.presentations_begun() + 1, total_, false, hand_off}))
    return;
  trace_.begin();
  if (explore(false)) answer();
  if (!time_is_up_ || !rejects_late_answers() || !desk_.is_running()) return;
  desk_.enter("time is up");
  static_cast<void>(
      desk_.show_step(NoticeStep{NoticeStep::What::time_is_up, session_.presentations_begun()}));
}

/// Interrupts a trial whose plane was delayed, for example by a locked database, so that it is
/// presented again.
bool TrialRun::interrupt_if_late() {
  constexpr std::chrono::seconds kLate{1};
  const Time now = desk_.now();
  if (now - presented_at_ < kLate) return false;
  session_.interrupt(now, record::kPauseReason);
  return true;
}

/// Records the contact, and returns when the exploration started and ended. Ticks count from the
/// servo's start, shortly after plane-on was recorded. Later events are stamped with the end of the
/// exploration, not with the current time, because the time to pack a trace or to write a flight
/// record differs between rough and smooth textures.
TrialRun::Span TrialRun::note_exploration(const Exploration& exploration, Time plane_on) {
  const Time start =
      exploration.servo_start
          ? std::clamp(parts_.clock.time_of(*exploration.servo_start), plane_on, desk_.now())
          : plane_on;
  const Time end = std::min(start + exploration.duration, desk_.now());
  tally_.ticks += exploration.servo.ticks;
  if (exploration.landed_at) session_.contact(std::min(start + *exploration.landed_at, end));
  return {start, end};
}

PlanesEnd TrialRun::run_planes(bool is_return) {
  device::ServoOptions servo = servo_options_;
  if (is_return) servo.limit_ticks -= trace_.ticks();
  Time plane_on{};
  bool is_presented = false;
  PlaneListener listener;
  listener.plane_on = [&]() -> record::Trace* {
    plane_on = desk_.now();
    if (is_return) {
      session_.explore_again(plane_on);
    } else if (!is_presented) {
      presented_at_ = plane_on;
      session_.present(plane_on);
      ++tally_.presentations;
      is_presented = true;
      if (interrupt_if_late()) return nullptr;
    }
    desk_.enter("exploring");
    return &trace_.next_part();
  };
  listener.explored = [&](const Exploration& exploration) {
    const Span span = note_exploration(exploration, plane_on);
    exploration_end_ = span.end;
    last_exploration_ = exploration;
    if (!is_interrupted(exploration.servo)) trace_.add(exploration, span.start - presented_at_);
  };
  return session::run_planes(desk_, trial_, servo, listener);
}

bool TrialRun::explore(bool is_return) {
  switch (run_planes(is_return)) {
    case PlanesEnd::aborted:
      return false;
    case PlanesEnd::interrupted:
      session_.interrupt(exploration_end_, desk_.note_interruption(last_exploration_.servo),
                         last_exploration_.detail);
      return false;
    case PlanesEnd::paused:
      if (session_.in_presentation()) session_.interrupt(exploration_end_, record::kPauseReason);
      return false;
    case PlanesEnd::not_explored:
      session_.interrupt(exploration_end_, "not explored as asked for");
      ++repeated_trials_;
      desk_.enter("not explored");
      static_cast<void>(desk_.show_step(
          NoticeStep{NoticeStep::What::not_explored, session_.presentations_begun()}));
      return false;
    case PlanesEnd::time_is_up:
    case PlanesEnd::explored:
      break;
  }
  trace_.pack(session_, parts_.explorer.in_real_time());
  const bool is_free = std::holds_alternative<study::FreeExploration>(trial_question_.exploring);
  time_is_up_ = is_free && last_exploration_.servo.end == device::ServoEnd::time_limit;
  if (!time_is_up_) {
    session_.end_exploring(exploration_end_);
  } else {
    if (rejects_late_answers()) keep_evidence();
    session_.time_out(exploration_end_);
  }
  return session_.phase() == SessionPhase::answering;
}

void TrialRun::answer() {
  for (;;) {
    desk_.enter("answering");
    const AnswerStep step = question();
    const std::optional<StepReply> reply = desk_.show_step(step);
    if (!reply) return;
    if (!reply->explore_again) {
      confirm(*reply);
      if (!trial_question_.feedback || !trial_.right) return;
      desk_.enter("feedback");
      const auto& layout = session_.layout();
      const auto right_position = std::ranges::find(layout, *trial_.right) - layout.begin();
      const int answered_position = position_of(reply->answer).value_or(0);
      static_cast<void>(
          desk_.show_step(FeedbackStep{answered_position, static_cast<int>(right_position)}));
      return;
    }
    if (step.may_explore_again && !explore(true)) return;
  }
}

AnswerStep TrialRun::question() const {
  const auto remaining_s =
      static_cast<double>(servo_options_.limit_ticks - trace_.ticks()) / servo_options_.rate_hz;
  const bool is_free = std::holds_alternative<study::FreeExploration>(trial_question_.exploring);
  return {.trial = session_.presentations_begun(),
          .total = total_,
          .practice = false,
          .time_is_up = time_is_up_,
          .may_explore_again =
              is_free && trial_question_.planes == 1 && !time_is_up_ && remaining_s >= kMinReturnS,
          .confidence_levels = trial_question_.confidence_levels,
          .question = trial_question_.question,
          .picture = study::picture_of(parts_.key.study, trial_),
          .sight = parts_.key.study.session.sight};
}

void TrialRun::confirm(const StepReply& reply) {
  if (const auto* const rating = std::get_if<RatingAnswer>(&reply.answer)) {
    session_.rate(rating->values);
  } else {
    const auto& choice = std::get<ChoiceAnswer>(reply.answer);
    if (choice.first_position) session_.choose(*choice.first_position);
    session_.choose(choice.position);
  }
  keep_evidence();
  session_.confirm(desk_.time_of(reply), reply.confidence);
  parts_.experimenter.acknowledged(trial_.place.trial);
}

void TrialRun::keep_evidence() {
  JudgedEvidence result = trace_.take_evidence();
  if (!result.valid) ++tally_.invalid_trials;
  session_.keep_evidence(std::move(result.evidence));
}

void take_break(SessionDesk& desk) {
  Session& session = desk.session();
  session.take_break(desk.now());
  desk.enter("break");
  desk.parts().clock.advance(kBreak);
  const int begun = session.presentations_begun();
  static_cast<void>(desk.show_step(BreakStep{begun, begun + session.presentations_left()}));
}

void run_trials(SessionDesk& desk, SessionTally& tally) {
  Session& session = desk.session();
  TrialRun trials(desk, tally);
  const int max_interruptions = session.presentations_left();
  while (desk.is_running() && session.phase() == SessionPhase::ready) {
    if (!desk.await_device()) continue;
    desk.parts().clock.advance(kTrialGap);
    if (session.is_break_due()) take_break(desk);
    if (!desk.is_running() || session.phase() != SessionPhase::ready) continue;
    trials.run();
    desk.record_marks();
    static_cast<void>(desk.handle());
    if (desk.interruptions() > max_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many faults");
    }
    if (trials.repeated_trials() > max_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many trials not explored as asked for");
    }
  }
}

/// Shows the last page. All data are stored, so the experimenter may leave.
void show_end(SessionDesk& desk) {
  desk.enter("end");
  const auto is_end_requested = [&] {
    const auto request = desk.parts().experimenter.request();
    return request && (request->kind == ExperimenterRequest::Kind::leave ||
                       request->kind == ExperimenterRequest::Kind::abort);
  };
  while (!is_end_requested() && !desk.parts().participant.show_step(EndStep{})) {
  }
}

}  // namespace

Experimenter& no_experimenter() {
  static Experimenter experimenter;
  return experimenter;
}

const SessionTexts& no_texts() {
  static const SessionTexts texts;
  return texts;
}

SessionTally run_session(Session& session, const SessionParts& parts) {
  SessionDesk desk(session, parts);
  SessionTally tally;
  desk.mark_session_start();
  if (run_opening_stages(desk)) run_trials(desk, tally);
  if (session.phase() == SessionPhase::finished) ask_closing_questions(desk);
  if (!desk.leave_reason()) desk.mark_session_end();
  desk.record_marks();
  if (!desk.leave_reason()) {
    const study::Study& study = parts.key.study;
    session.close(desk.now(), study::trial_question_of(study).has_pictures());
  }
  tally.duration = desk.now();
  tally.left = desk.leave_reason();
  if (!tally.left) show_end(desk);
  return tally;
}

SessionTally run_session_in_virtual_time(Session& session, const study::StudyCodes& key,
                                         const StimulusSource& source, Participant& participant) {
  VirtualSessionClock clock;
  VirtualExplorer explorer;
  AlwaysReady devices;
  return run_session(session, {key, source, participant, clock, explorer, devices});
}

}  // namespace touchtrial::session
