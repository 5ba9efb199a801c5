#include "protocols/session/session_runner.hpp"

#include "protocols/session/interval_run.hpp"
#include "protocols/session/session_desk.hpp"
#include "protocols/session/trial_trace.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::session {
namespace {

using Time = SessionClock::Time;

// In virtual time; people take their own time.
constexpr std::chrono::seconds kBreak{60};
constexpr std::chrono::seconds kBetweenTrials{2};
/// With less time than this left, the participant may not go back to the plane.
constexpr double kLeastAgainS = 0.5;

/// The trials of a session, one after the other. Each presentation is a way from the schedule to
/// the recorder: the participant is ready, explores, and answers; the session records it.
class TrialRun {
 public:
  TrialRun(SessionDesk& desk, SessionTally& tally)
      : desk_(desk),
        session_(desk.session()),
        parts_(desk.parts()),
        tally_(tally),
        servo_(desk.servo_options()),
        intervals_(parts_.key.study.protocol->interval_plan(parts_.key.study)) {}

  /// Runs the current presentation to its answer or interruption.
  /// \pre the session is ready
  void run();
  /// How many trials came again because they were not explored as asked for.
  [[nodiscard]] int came_again() const noexcept { return came_again_; }

 private:
  [[nodiscard]] engine::RenderingModel model() const;
  /// Presents all planes of a trial with intervals.
  void run_intervals();
  /// When an exploration began, by the servo's clock, and ended.
  struct Span {
    Time began;
    Time ended;
  };
  [[nodiscard]] Span note_exploration(const Exploration& done, Time plane_on);
  /// \return whether the participant is to answer
  [[nodiscard]] bool explore(const engine::RenderingModel& model);
  [[nodiscard]] bool explore_again(const engine::RenderingModel& model);
  [[nodiscard]] bool came_late();
  [[nodiscard]] bool end_exploration(const Exploration& done, Time plane_on);
  void answer(const engine::RenderingModel& model);
  [[nodiscard]] AnswerStep question() const;
  void confirm(const StepReply& reply);
  void keep_evidence();

  SessionDesk& desk_;
  Session& session_;
  const SessionParts& parts_;
  SessionTally& tally_;
  device::ServoOptions servo_;
  std::optional<study::IntervalPlan> intervals_;
  TrialTrace trace_;
  Time presented_at_{};
  int of_ = 0;                 ///< presentations in all, as far as is known
  int came_again_ = 0;         ///< trials that were not explored as asked for
  bool hand_was_off_ = false;  ///< in the trial before
  bool time_is_up_ = false;
};

void TrialRun::run() {
  of_ = session_.presentations_begun() + session_.presentations_left();
  time_is_up_ = false;
  desk_.enter("ready");
  const bool hand_off = session_.current()->hand_off;
  if (hand_off && !hand_was_off_) {
    const NoticeStep notice{NoticeStep::What::hand_off, session_.presentations_begun()};
    if (!desk_.attend(notice)) return;
  }
  hand_was_off_ = hand_off;
  if (!desk_.attend(ReadyStep{session_.presentations_begun() + 1, of_, false, hand_off})) return;
  if (intervals_) return run_intervals();
  const engine::RenderingModel presented = model();
  if (explore(presented)) answer(presented);
  const bool is_lost =
      time_is_up_ && parts_.key.study.trials.on_timeout == study::OnTimeout::no_response;
  if (!is_lost || !desk_.goes_on()) return;
  desk_.enter("time is up");
  static_cast<void>(
      desk_.attend(NoticeStep{NoticeStep::What::time_is_up, session_.presentations_begun()}));
}

engine::RenderingModel TrialRun::model() const {
  const study::Presentation& presentation = *session_.current();
  if (presentation.role == study::Role::catch_trial) return parts_.source.flat();
  return parts_.source.model(parts_.key.code_of(presentation.stimulus), presentation.gain_db);
}

bool TrialRun::explore(const engine::RenderingModel& model) {
  if (parts_.explorer.in_real_time()) parts_.source.fetch();
  trace_.begin();
  presented_at_ = desk_.now();
  session_.present(presented_at_);
  ++tally_.presentations;
  if (came_late()) return false;
  desk_.enter("exploring");
  ModelForce force(model);
  return end_exploration(desk_.explore(force, parts_.source.plane(), servo_, trace_.next_part()),
                         presented_at_);
}

/// Where a plane waited for a locked database, its trial has no beginning: it is presented anew.
bool TrialRun::came_late() {
  constexpr std::chrono::seconds kLate{1};
  const Time now = desk_.now();
  if (now - presented_at_ < kLate) return false;
  session_.interrupt(now, record::kPauseReason);
  return true;
}

bool TrialRun::explore_again(const engine::RenderingModel& model) {
  device::ServoOptions rest = servo_;
  rest.limit_ticks -= trace_.ticks();
  record::Trace& part = trace_.next_part();
  const Time plane_on = desk_.now();
  session_.explore_again(plane_on);
  desk_.enter("exploring");
  ModelForce force(model);
  return end_exploration(desk_.explore(force, parts_.source.plane(), rest, part), plane_on);
}

/// Ticks count from the servo's start, a moment after plane-on was recorded. Events that follow the
/// exploration have the time of its end and not the present one: how long it takes to pack a trace
/// or to write a flight record tells rough textures from smooth ones.
TrialRun::Span TrialRun::note_exploration(const Exploration& done, Time plane_on) {
  const Time began =
      done.began ? std::clamp(parts_.clock.of(*done.began), plane_on, desk_.now()) : plane_on;
  const Time ended = std::min(began + done.lasted, desk_.now());
  tally_.ticks += done.servo.ticks;
  if (done.landed_at) session_.contact(std::min(began + *done.landed_at, ended));
  return {began, ended};
}

bool TrialRun::end_exploration(const Exploration& done, Time plane_on) {
  const auto [began, ended] = note_exploration(done, plane_on);
  if (is_interrupted(done.servo)) {
    session_.interrupt(ended, desk_.note_interruption(done.servo), done.detail);
    return false;
  }
  if (desk_.was_cut_short()) {
    session_.interrupt(ended, record::kPauseReason);
    return false;
  }
  trace_.add(done, began - presented_at_);
  trace_.pack(session_, parts_.explorer.in_real_time());
  time_is_up_ = done.servo.end == device::ServoEnd::time_limit;
  if (!time_is_up_) {
    session_.end_exploring(ended);
  } else {
    if (parts_.key.study.trials.on_timeout == study::OnTimeout::no_response) keep_evidence();
    session_.time_out(ended);
  }
  return session_.phase() == SessionPhase::answering;
}

void TrialRun::run_intervals() {
  const study::Presentation shown = *session_.current();
  trace_.begin();
  time_is_up_ = false;
  Time plane_on{};
  Time ended{};
  bool is_presented = false;
  device::ServoReport last;
  std::optional<record::InterruptionDetail> detail;
  IntervalListener listener;
  listener.plane_on = [&]() -> record::Trace* {
    plane_on = desk_.now();
    if (!is_presented) {
      session_.present(plane_on);
      presented_at_ = plane_on;
      ++tally_.presentations;
      is_presented = true;
      if (came_late()) return nullptr;
    }
    desk_.enter("exploring");
    return &trace_.next_part();
  };
  listener.explored = [&](const Exploration& done) {
    const Span span = note_exploration(done, plane_on);
    ended = span.ended;
    last = done.servo;
    detail = done.detail;
    if (!is_interrupted(done.servo)) trace_.add(done, span.began - presented_at_);
  };
  switch (session::run_intervals(desk_, shown, false, listener)) {
    case IntervalsEnd::broken_off:
      return;
    case IntervalsEnd::interrupted:
      session_.interrupt(ended, desk_.note_interruption(last), detail);
      return;
    case IntervalsEnd::paused:
      if (session_.in_presentation()) session_.interrupt(ended, record::kPauseReason);
      return;
    case IntervalsEnd::not_explored:
      session_.interrupt(ended, "not explored as asked for");
      ++came_again_;
      desk_.enter("not explored");
      static_cast<void>(
          desk_.attend(NoticeStep{NoticeStep::What::not_explored, session_.presentations_begun()}));
      return;
    case IntervalsEnd::explored:
      break;
  }
  trace_.pack(session_, parts_.explorer.in_real_time());
  session_.end_exploring(ended);
  desk_.enter("answering");
  const std::optional<StepReply> reply = desk_.attend(question());
  if (!reply) return;
  confirm(*reply);
  if (!intervals_->feedback || shown.hand_off || !shown.chosen) return;
  desk_.enter("feedback");
  static_cast<void>(desk_.attend(FeedbackStep{reply->position, shown.chosen->target}));
}

void TrialRun::answer(const engine::RenderingModel& model) {
  for (;;) {
    desk_.enter("answering");
    const AnswerStep step = question();
    const std::optional<StepReply> reply = desk_.attend(step);
    if (!reply) return;
    if (!reply->explore_again) return confirm(*reply);
    if (step.may_explore_again && !explore_again(model)) return;
  }
}

AnswerStep TrialRun::question() const {
  const study::SessionPlan& plan = parts_.key.study.session;
  const auto left_s = static_cast<double>(servo_.limit_ticks - trace_.ticks()) / servo_.rate_hz;
  return {.trial = session_.presentations_begun(),
          .of = of_,
          .practice = false,
          .time_is_up = time_is_up_,
          .may_explore_again = !intervals_ && !time_is_up_ && left_s >= kLeastAgainS,
          .confidence_levels = plan.confidence_levels,
          .question = intervals_ ? intervals_->question : std::string(),
          .sight = plan.sight};
}

void TrialRun::confirm(const StepReply& reply) {
  const int trial = session_.current()->trial;
  if (reply.first_position) session_.choose(*reply.first_position);
  session_.choose(reply.position);
  keep_evidence();
  session_.confirm(desk_.when(reply), reply.confidence);
  parts_.experimenter.acknowledged(trial);
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
  const int most_interruptions = session.presentations_left();
  while (desk.goes_on() && session.phase() == SessionPhase::ready) {
    if (!desk.await_device()) continue;
    desk.parts().clock.pass(kBetweenTrials);
    if (session.break_due()) take_break(desk);
    if (!desk.goes_on() || session.phase() != SessionPhase::ready) continue;
    trials.run();
    desk.record_marks();
    static_cast<void>(desk.obey());
    if (desk.interruptions() > most_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many faults");
    }
    if (trials.came_again() > most_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "", "too many trials not explored as asked for");
    }
  }
}

/// Nothing that could be lost is asked any more, so that the experimenter may leave.
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
  desk.tell_of_begin();
  if (run_opening_stages(desk)) run_trials(desk, tally);
  if (session.phase() == SessionPhase::finished) ask_closing_questions(desk);
  if (!desk.left()) desk.tell_of_end();
  desk.record_marks();
  if (!desk.left()) {
    const study::Study& study = parts.key.study;
    session.close(desk.now(), study.protocol->may_name_one_key(study));
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
