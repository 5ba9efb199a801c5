#include "protocols/session/trial_run.hpp"

#include "protocols/session/interruption_words.hpp"
#include "protocols/session/trial_servo_options.hpp"

#include <algorithm>
#include <chrono>

namespace touchtrial::session {
namespace {

using Time = SessionClock::Time;

/// With less time left than this, nobody is let back to the plane.
constexpr double kLeastAgainS = 0.5;

}  // namespace

device::ServoOptions servo_options(const SessionParts& parts) {
  return trial_servo_options(parts.key.study, parts.rate_hz, parts.limits);
}

TrialRun::TrialRun(SessionDesk& desk)
    : desk_(desk),
      session_(desk.session()),
      parts_(desk.parts()),
      participant_(desk),
      servo_(servo_options(desk.parts())) {}

const engine::RenderingModel& TrialRun::model() const {
  const design::Presentation& presentation = *session_.current();
  if (presentation.kind == design::PresentationKind::catch_trial) return parts_.source.flat();
  return parts_.source.model(parts_.key.code_of(presentation.stimulus));
}

void TrialRun::run() {
  of_ = session_.presentations_begun() + session_.presentations_left();
  desk_.enter("ready");
  if (!desk_.attend(ReadyStep{session_.presentations_begun() + 1, of_, false})) return;
  const engine::RenderingModel& presented = model();
  if (explore(presented)) answer(presented);
}

bool TrialRun::explore(const engine::RenderingModel& model) {
  if (parts_.explorer.in_real_time()) parts_.source.fetch();
  record_.begin();
  time_is_up_ = false;
  const Time plane_on = desk_.now();
  session_.present(plane_on);
  desk_.enter("exploring");
  ++desk_.tally().presentations;
  const Exploration done = parts_.explorer.explore(model, parts_.source.plane(), participant_,
                                                   servo_, record_.next_trace());
  return end_exploration(done, plane_on);
}

bool TrialRun::explore_again(const engine::RenderingModel& model) {
  device::ServoOptions rest = servo_;
  rest.limit_ticks -= record_.ticks();
  store::Trace& trace = record_.next_trace();
  const Time plane_on = desk_.now();
  session_.explore_again(plane_on);
  desk_.enter("exploring");
  return end_exploration(
      parts_.explorer.explore(model, parts_.source.plane(), participant_, rest, trace), plane_on);
}

/// Ticks are counted from the servo's start, a moment after plane-on was recorded. What is stamped
/// after the exploration has the time of its end and not of now: how long a trace takes to pack, or
/// a flight record to write, tells rough textures from smooth ones.
bool TrialRun::end_exploration(const Exploration& done, Time plane_on) {
  const Time began =
      done.began ? std::clamp(parts_.clock.of(*done.began), plane_on, desk_.now()) : plane_on;
  parts_.clock.pass(done.lasted);
  desk_.tally().ticks += done.servo.ticks;
  desk_.saw_servo(done.servo);
  const Time ended = std::min(began + done.lasted, desk_.now());
  if (done.landed_at) session_.contact(std::min(began + *done.landed_at, ended));
  if (is_interrupted(done.servo)) {
    session_.interrupt(ended, desk_.note_interruption(words_in_clear(done.servo)), done.detail);
    return false;
  }
  record_.add(done);
  record_.pack(session_, parts_.explorer.in_real_time());
  time_is_up_ = done.servo.end == device::ServoEnd::time_limit;
  if (!time_is_up_) {
    session_.end_exploring(ended);
  } else {
    if (parts_.key.study.trials.on_timeout == design::OnTimeout::no_response) keep_evidence();
    session_.time_out(ended);
  }
  return session_.phase() == SessionPhase::answering;
}

void TrialRun::keep_evidence() {
  JudgedEvidence judged = record_.take();
  if (!judged.valid) ++desk_.tally().invalid_trials;
  session_.keep_evidence(std::move(judged.evidence));
}

AnswerStep TrialRun::question() const {
  const design::SessionPlan& plan = parts_.key.study.session;
  const auto left_s = static_cast<double>(servo_.limit_ticks - record_.ticks()) / servo_.rate_hz;
  return {.trial = session_.presentations_begun(),
          .of = of_,
          .practice = false,
          .time_is_up = time_is_up_,
          .may_explore_again = !time_is_up_ && left_s >= kLeastAgainS,
          .confidence_levels = plan.confidence_levels,
          .sight = plan.sight};
}

void TrialRun::answer(const engine::RenderingModel& model) {
  for (;;) {
    desk_.enter("answering");
    const AnswerStep step = question();
    const std::optional<StepReply> reply = desk_.attend(step);
    if (!reply) return;
    if (!reply->explore_again) return confirm(*reply);
    if (!step.may_explore_again) continue;
    parts_.clock.pass(reply->took);
    if (!explore_again(model)) return;
  }
}

void TrialRun::confirm(const StepReply& reply) {
  parts_.clock.pass(reply.took);
  const int trial = session_.current()->trial;
  if (reply.first_position) session_.choose(*reply.first_position);
  session_.choose(reply.position);
  keep_evidence();
  session_.confirm(desk_.when(reply), reply.confidence);
  parts_.experimenter.acknowledged(trial);
}

}  // namespace touchtrial::session
