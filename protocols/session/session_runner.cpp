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

/// Runs the trials of a session one after the other. In each presentation the participant gets
/// ready, explores, and answers; the session records it.
class TrialRun {
 public:
  TrialRun(SessionDesk& desk, SessionTally& tally)
      : desk_(desk),
        session_(desk.session()),
        parts_(desk.parts()),
        tally_(tally),
        servo_(desk.servo_options()) {}

  /// Runs the current presentation to its answer or interruption.
  /// \pre the session is ready
  void run();
  /// Trials repeated because they were not explored as instructed.
  [[nodiscard]] int repeated() const noexcept { return repeated_; }

 private:
  /// Start and end of an exploration by the servo's clock.
  struct Span {
    Time began;
    Time ended;
  };
  [[nodiscard]] Span note_exploration(const Exploration& done, Time plane_on);
  /// Presents the trial's planes.
  /// \param again  whether the participant returns to the plane before answering
  /// \return whether the participant must answer
  [[nodiscard]] bool explore(bool again);
  [[nodiscard]] PlanesEnd run_planes(bool again);
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
  device::ServoOptions servo_;
  study::Trial trial_;  ///< the current one
  study::Ask ask_;
  TrialTrace trace_;
  Time presented_at_{};
  Exploration last_{};         ///< of the trial
  Time ended_{};               ///< that exploration
  int of_ = 0;                 ///< expected total of trials
  int repeated_ = 0;           ///< trials that were not explored as instructed
  bool hand_was_off_ = false;  ///< in the previous trial
  bool time_is_up_ = false;
};

void TrialRun::run() {
  of_ = session_.presentations_begun() + session_.presentations_left();
  time_is_up_ = false;
  trial_ = *session_.current();
  ask_ = parts_.key.study.task->ask(parts_.key.study, trial_.place);
  desk_.enter("ready");
  const bool hand_off = trial_.place.hand_off;
  if (hand_off && !hand_was_off_) {
    const NoticeStep notice{NoticeStep::What::hand_off, session_.presentations_begun()};
    if (!desk_.attend(notice)) return;
  }
  hand_was_off_ = hand_off;
  if (!desk_.attend(ReadyStep{session_.presentations_begun() + 1, of_, false, hand_off})) return;
  trace_.begin();
  if (explore(false)) answer();
  if (!time_is_up_ || !rejects_late_answers() || !desk_.is_running()) return;
  desk_.enter("time is up");
  static_cast<void>(
      desk_.attend(NoticeStep{NoticeStep::What::time_is_up, session_.presentations_begun()}));
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

/// Ticks count from the servo's start, shortly after plane-on was recorded. Later events are
/// stamped with the end of the exploration, not with the current time, because the time to pack a
/// trace or to write a flight record differs between rough and smooth textures.
TrialRun::Span TrialRun::note_exploration(const Exploration& done, Time plane_on) {
  const Time began =
      done.began ? std::clamp(parts_.clock.of(*done.began), plane_on, desk_.now()) : plane_on;
  const Time ended = std::min(began + done.lasted, desk_.now());
  tally_.ticks += done.servo.ticks;
  if (done.landed_at) session_.contact(std::min(began + *done.landed_at, ended));
  return {began, ended};
}

PlanesEnd TrialRun::run_planes(bool again) {
  device::ServoOptions servo = servo_;
  if (again) servo.limit_ticks -= trace_.ticks();
  Time plane_on{};
  bool is_presented = false;
  PlaneListener listener;
  listener.plane_on = [&]() -> record::Trace* {
    plane_on = desk_.now();
    if (again) {
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
  listener.explored = [&](const Exploration& done) {
    const Span span = note_exploration(done, plane_on);
    ended_ = span.ended;
    last_ = done;
    if (!is_interrupted(done.servo)) trace_.add(done, span.began - presented_at_);
  };
  return session::run_planes(desk_, trial_, servo, listener);
}

bool TrialRun::explore(bool again) {
  switch (run_planes(again)) {
    case PlanesEnd::aborted:
      return false;
    case PlanesEnd::interrupted:
      session_.interrupt(ended_, desk_.note_interruption(last_.servo), last_.detail);
      return false;
    case PlanesEnd::paused:
      if (session_.in_presentation()) session_.interrupt(ended_, record::kPauseReason);
      return false;
    case PlanesEnd::not_explored:
      session_.interrupt(ended_, "not explored as asked for");
      ++repeated_;
      desk_.enter("not explored");
      static_cast<void>(
          desk_.attend(NoticeStep{NoticeStep::What::not_explored, session_.presentations_begun()}));
      return false;
    case PlanesEnd::time_is_up:
    case PlanesEnd::explored:
      break;
  }
  trace_.pack(session_, parts_.explorer.in_real_time());
  const bool is_free = std::holds_alternative<study::Free>(ask_.exploring);
  time_is_up_ = is_free && last_.servo.end == device::ServoEnd::time_limit;
  if (!time_is_up_) {
    session_.end_exploring(ended_);
  } else {
    if (rejects_late_answers()) keep_evidence();
    session_.time_out(ended_);
  }
  return session_.phase() == SessionPhase::answering;
}

void TrialRun::answer() {
  for (;;) {
    desk_.enter("answering");
    const AnswerStep step = question();
    const std::optional<StepReply> reply = desk_.attend(step);
    if (!reply) return;
    if (!reply->explore_again) {
      confirm(*reply);
      if (!ask_.feedback || !trial_.right) return;
      desk_.enter("feedback");
      const auto& layout = session_.layout();
      const auto right = std::ranges::find(layout, *trial_.right) - layout.begin();
      const int answered = position_of(reply->answer).value_or(0);
      static_cast<void>(desk_.attend(FeedbackStep{answered, static_cast<int>(right)}));
      return;
    }
    if (step.may_explore_again && !explore(true)) return;
  }
}

AnswerStep TrialRun::question() const {
  const auto left_s = static_cast<double>(servo_.limit_ticks - trace_.ticks()) / servo_.rate_hz;
  const bool is_free = std::holds_alternative<study::Free>(ask_.exploring);
  return {.trial = session_.presentations_begun(),
          .of = of_,
          .practice = false,
          .time_is_up = time_is_up_,
          .may_explore_again = is_free && ask_.planes == 1 && !time_is_up_ && left_s >= kMinReturnS,
          .confidence_levels = ask_.confidence_levels,
          .question = ask_.question,
          .picture = study::picture_of(parts_.key.study, trial_),
          .sight = parts_.key.study.session.sight};
}

void TrialRun::confirm(const StepReply& reply) {
  if (const auto* const rated = std::get_if<Rated>(&reply.answer)) {
    session_.rate(rated->values);
  } else {
    const auto& chosen = std::get<Chosen>(reply.answer);
    if (chosen.first_position) session_.choose(*chosen.first_position);
    session_.choose(chosen.position);
  }
  keep_evidence();
  session_.confirm(desk_.when(reply), reply.confidence);
  parts_.experimenter.acknowledged(trial_.place.trial);
}

void TrialRun::keep_evidence() {
  JudgedEvidence judged = trace_.take_evidence();
  if (!judged.valid) ++tally_.invalid_trials;
  session_.keep_evidence(std::move(judged.evidence));
}

void take_break(SessionDesk& desk) {
  Session& session = desk.session();
  session.take_break(desk.now());
  desk.enter("break");
  desk.parts().clock.pass(kBreak);
  const int done = session.presentations_begun();
  static_cast<void>(desk.attend(BreakStep{done, done + session.presentations_left()}));
}

void run_trials(SessionDesk& desk, SessionTally& tally) {
  Session& session = desk.session();
  TrialRun trials(desk, tally);
  const int max_interruptions = session.presentations_left();
  while (desk.is_running() && session.phase() == SessionPhase::ready) {
    if (!desk.await_device()) continue;
    desk.parts().clock.pass(kTrialGap);
    if (session.break_due()) take_break(desk);
    if (!desk.is_running() || session.phase() != SessionPhase::ready) continue;
    trials.run();
    desk.record_marks();
    static_cast<void>(desk.handle());
    if (desk.interruptions() > max_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many faults");
    }
    if (trials.repeated() > max_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many trials not explored as asked for");
    }
  }
}

/// Shows the last page. Everything is stored by now, so the experimenter may leave.
void show_end(SessionDesk& desk) {
  desk.enter("end");
  const auto asked_to_end = [&] {
    const auto request = desk.parts().experimenter.request();
    return request && (request->kind == ExperimenterRequest::Kind::leave ||
                       request->kind == ExperimenterRequest::Kind::abort);
  };
  while (!asked_to_end() && !desk.parts().participant.attend(EndStep{})) {
  }
}

}  // namespace

Experimenter& no_experimenter() {
  static Experimenter nobody;
  return nobody;
}

const SessionTexts& no_texts() {
  static const SessionTexts none;
  return none;
}

SessionTally run_session(Session& session, const SessionParts& parts) {
  SessionDesk desk(session, parts);
  SessionTally tally;
  desk.mark_session_start();
  if (run_opening_stages(desk)) run_trials(desk, tally);
  if (session.phase() == SessionPhase::finished) ask_closing_questions(desk);
  if (!desk.left()) desk.mark_session_end();
  desk.record_marks();
  if (!desk.left()) {
    const study::Study& study = parts.key.study;
    session.close(desk.now(), study::ask_of(study).has_pictures());
  }
  tally.duration = desk.now();
  tally.left = desk.left();
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
