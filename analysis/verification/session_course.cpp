#include "analysis/verification/session_course.hpp"

#include "core/errors.hpp"
#include "record/payload_json.hpp"
#include "study/protocol.hpp"

#include <string>

#include <fmt/format.h>

namespace touchtrial::analysis {

SessionCourse::SessionCourse(const study::Study& study, const study::ScheduleDraw& draw,
                             bool answers_opened)
    : study_(study),
      answers_opened_(answers_opened),
      course_(study::make_order(study, draw), study.trials.on_interruption) {}

void SessionCourse::fail(const record::Event& event, const std::string& reason) const {
  throw VerificationError(
      fmt::format("session {}, event {}: {}", event.session, event.sequence, reason));
}

void SessionCourse::fail(const record::Event& event, int trial, const std::string& reason) const {
  throw VerificationError(fmt::format("session {}, trial {}: {}", event.session, trial, reason));
}

void SessionCourse::follow(const record::Event& event) {
  switch (event.kind) {
    case record::EventKind::presented:
      return present(event);
    case record::EventKind::first_contact:
    case record::EventKind::answered:
    case record::EventKind::timed_out:
    case record::EventKind::interrupted:
    case record::EventKind::explored_again:
      return follow_trial(event);
    case record::EventKind::block_restarted:
      return restart_block(event);
    case record::EventKind::paused:
      is_paused_ = true;
      return;
    case record::EventKind::resumed:
      return resume(event);
    case record::EventKind::stopped:
      is_stopped_ = true;
      return;
    case record::EventKind::closed:
      return close(event);
    default:
      return;  // remarks, practice and traces may occur anywhere
  }
}

void SessionCourse::present(const record::Event& event) {
  const auto body = record::from_json<record::PresentedBody>(event.body);
  if (!course_.has_trial(body.trial)) fail(event, body.trial, "was presented but not scheduled");
  if (course_.is_void(body.trial)) {
    fail(event, body.trial, "was presented under its old number after its block was restarted");
  }
  if (is_paused_) fail(event, body.trial, "was presented while the session was paused");
  if (is_stopped_) fail(event, body.trial, "was presented after the session was stopped");
  if (course_.block_to_restart()) {
    fail(event, body.trial,
         fmt::format("was presented although block {} was to be restarted",
                     *course_.block_to_restart()));
  }
  if (is_under_way_) {
    fail(event, body.trial,
         fmt::format("was presented while trial {} was under way", course_.current()->place.trial));
  }
  if (course_.is_over()) fail(event, body.trial, "was presented after the last trial that was due");
  const study::Place& next = course_.current()->place;
  if (next.trial != body.trial) {
    fail(event, body.trial, fmt::format("was presented where trial {} was due", next.trial));
  }
  if (next.block != body.block) {
    fail(event, body.trial,
         fmt::format("was presented in block {}, not in {}", body.block, next.block));
  }
  is_under_way_ = true;
  ++presentations_;
}

void SessionCourse::require_under_way(const record::Event& event, int trial) const {
  const std::string name(name_of(event.kind));
  if (!is_under_way_ || course_.current()->place.trial != trial) {
    fail(event, trial, name + ", but not under way");
  }
  if (event.kind == record::EventKind::interrupted) return;
  if (is_paused_) fail(event, trial, name + " while the session was paused");
  if (is_interrupted_) fail(event, trial, name + " although the program had ended during it");
}

void SessionCourse::follow_trial(const record::Event& event) {
  const int trial = record::from_json<record::TrialBody>(event.body).trial;
  require_under_way(event, trial);
  const bool is_over_without_answer = event.kind == record::EventKind::timed_out &&
                                      study_.trials.on_timeout == study::OnTimeout::no_response;
  if (event.kind == record::EventKind::interrupted) {
    if (record::from_json<record::InterruptedBody>(event.body).reason != record::kPauseReason)
      course_.interrupt();
  } else if (event.kind == record::EventKind::answered) {
    answer(event);
  } else if (is_over_without_answer) {
    course_.finish(std::nullopt);
  } else {
    return;
  }
  is_under_way_ = false;
  is_interrupted_ = false;
}

void SessionCourse::answer(const record::Event& event) {
  const record::AnswerBody body = record::from_json<record::AnswerBody>(event.body);
  // An erased answer is unknown, but later trials' places do not depend on it.
  if (!answers_opened_) return course_.finish(std::nullopt);
  require_chosen_level(event, body);
  if (body.answer) {
    const study::TrialQuestion question = study_.task->ask(study_, course_.current()->place);
    const std::string mismatch = study::mismatch_of(*body.answer, question);
    if (!mismatch.empty()) fail(event, body.trial, mismatch);
  }
  course_.finish(body.answer);
}

void SessionCourse::require_chosen_level(const record::Event& event,
                                         const record::AnswerBody& body) const {
  if (!course_.is_adaptive()) return;  // the sealed schedule has the whole order
  const study::Trial& due = *course_.current();
  const auto level_text = [](const auto& kind, const auto& track, const auto& level,
                             const auto& target) {
    return kind && track && level && target
               ? fmt::format("track {}, level {}, target {} ({})", *track, *level, *target, *kind)
               : std::string("no level");
  };
  const std::string presented = level_text(body.kind, body.track, body.level, body.target);
  const std::string chosen = due.level ? level_text(std::optional(std::string(name_of(due.role))),
                                                    std::optional(due.level->track),
                                                    std::optional(due.level->level), due.right)
                                       : "no level";
  if (presented == chosen) return;
  fail(event, body.trial,
       fmt::format("presented {}, but the procedure chooses {}", presented, chosen));
}

void SessionCourse::restart_block(const record::Event& event) {
  const record::BlockBody body = record::from_json<record::BlockBody>(event.body);
  if (course_.block_to_restart() != body.block) {
    fail(event, fmt::format("block {} was restarted, but nothing in it was interrupted, or the "
                            "study does not restart blocks",
                            body.block));
  }
  const study::BlockRestart restart = course_.redrawn_block(body.block);
  if (body.first_trial != restart.first_trial()) {
    fail(event, fmt::format("block {} was restarted with trial {}, not {}", body.block,
                            body.first_trial, restart.first_trial()));
  }
  course_.restart(restart);
}

void SessionCourse::resume(const record::Event& event) {
  constexpr double kSecondsInHour = 3600.0;
  const record::ResumedBody body = record::from_json<record::ResumedBody>(event.body);
  if (body.after == "pause") {
    if (!is_paused_) fail(event, "the session was resumed, but not paused");
  } else if (body.away_s > study_.trials.resume_within_h * kSecondsInHour) {
    fail(event, fmt::format("the session was resumed after {:.1f} h; the study allows {} h",
                            body.away_s / kSecondsInHour, study_.trials.resume_within_h));
  } else {
    is_interrupted_ = is_under_way_;
  }
  is_paused_ = false;
}

void SessionCourse::close(const record::Event& event) const {
  if (!record::from_json<record::ClosedBody>(event.body).complete) return;
  if (is_stopped_) fail(event, "the session is complete, but was stopped");
  if (course_.block_to_restart()) {
    fail(event, fmt::format("the session is complete, but block {} was not restarted",
                            *course_.block_to_restart()));
  }
  if (is_under_way_) {
    fail(event, course_.current()->place.trial,
         "the session is complete, but this trial has no answer");
  }
  if (!course_.is_over()) {
    fail(event, course_.current()->place.trial,
         "the session is complete, but this trial was still due");
  }
}

}  // namespace touchtrial::analysis
