// Restores a session from its stored events.
#include "core/errors.hpp"
#include "protocols/session/session.hpp"
#include "record/payload_json.hpp"

#include <string>
#include <utility>

namespace touchtrial::session {
namespace {

using Phase = SessionPhase;

[[noreturn]] void refuse(const record::Event& event, const std::string& reason) {
  throw StoreError("session " + std::to_string(event.session) + ", event " +
                   std::to_string(event.sequence) + " ('" + std::string(name_of(event.kind)) +
                   "'): " + reason + "; run `touchtrial verify`");
}

}  // namespace

void Session::restore(std::span<const record::Event> events) {
  if (phase_ != Phase::fresh)
    throw std::logic_error("Session: only a fresh session can be restored");
  for (const record::Event& event : events) {
    apply(event);
    last_ = event.at;
  }
  if (!events.empty()) recorder_.continue_after(events.back());
}

void Session::resume_after_exit(Time at, const record::ResumedBody& body) {
  require(SessionInput::note, at);
  recorder_.add(at, record::EventKind::resumed, body);
  move_to(phase_ == Phase::paused ? before_pause_ : phase_, at);
  if (in_presentation()) interrupt(at, "program ended");
  restart_block(at);  // the program may have ended before restarting it
}

void Session::apply(const record::Event& event) {
  if (apply_to_trial(event) || apply_to_remarks(event)) return;
  apply_to_course(event);
}

bool Session::apply_to_trial(const record::Event& event) {
  const auto require_current = [&] {
    const int trial = record::from_json<record::TrialBody>(event.body).trial;
    if (!in_presentation() || current()->place.trial != trial) {
      refuse(event, "trial " + std::to_string(trial) + " is not the current trial");
    }
  };
  switch (event.kind) {
    case record::EventKind::presented:
      if (phase_ != Phase::ready ||
          current()->place.trial != record::from_json<record::TrialBody>(event.body).trial) {
        refuse(event, "is not the next trial of the schedule");
      }
      begin_presentation(event.at);
      return true;
    case record::EventKind::first_contact:
      require_current();
      had_contact_ = true;
      return true;
    case record::EventKind::trace_stored:
      note_force(record::from_json<record::TraceBody>(event.body).largest_force_n);
      return true;
    case record::EventKind::timed_out:
      require_current();
      was_timed_out_ = true;
      if (options_.on_timeout == study::OnTimeout::no_response) {
        finish_presentation(event.at, std::nullopt);
      } else {
        phase_ = Phase::answering;
      }
      return true;
    case record::EventKind::answered: {
      require_current();
      const std::optional<Answer> answer = record::from_json<record::AnswerBody>(event.body).answer;
      if (!answer) refuse(event, "its answer is not decrypted");
      const auto* const choice = std::get_if<ChoiceAnswer>(&*answer);
      if (choice != nullptr &&
          (choice->position < 0 || choice->position >= static_cast<int>(layout().size()))) {
        refuse(event, "chooses position " + std::to_string(choice->position) +
                          ", which the layout does not have");
      }
      count(*answer);
      finish_presentation(event.at, answer);
      return true;
    }
    case record::EventKind::interrupted:
      require_current();
      {
        const auto body = record::from_json<record::InterruptedBody>(event.body);
        note_force(body.largest_force_n.value_or(0.0));
        void_presentation(event.at, body.reason);
      }
      return true;
    case record::EventKind::explored_again:
      require_current();
      phase_ = Phase::exploring;
      return true;
    default:
      return false;
  }
}

bool Session::apply_to_remarks(const record::Event& event) {
  switch (event.kind) {
    case record::EventKind::practised:
      remarks_.practice.push_back(record::from_json<record::PracticeBody>(event.body));
      return true;
    case record::EventKind::ticked:
      remarks_.ticked.insert(record::from_json<record::TextBody>(event.body).text);
      return true;
    case record::EventKind::deviated:
      remarks_.deviations.insert(record::from_json<record::DeviationBody>(event.body).code);
      return true;
    case record::EventKind::questioned:
      remarks_.questionnaires.insert(record::from_json<record::TextBody>(event.body).text);
      return true;
    default:
      return false;
  }
}

void Session::apply_to_course(const record::Event& event) {
  switch (event.kind) {
    case record::EventKind::opened:
      phase_ = Phase::opened;
      return;
    case record::EventKind::calibrated:
      phase_ = Phase::calibrated;
      return;
    case record::EventKind::instructed:
      phase_ = between_trials();
      return;
    case record::EventKind::break_taken:
      done_since_break_ = 0;
      return;
    case record::EventKind::block_restarted: {
      course_.restart(
          course_.redrawn_block(record::from_json<record::BlockBody>(event.body).block));
      done_since_break_ = 0;
      return;
    }
    case record::EventKind::paused:
      before_pause_ = phase_;
      phase_ = Phase::paused;
      return;
    case record::EventKind::resumed:
      if (phase_ == Phase::paused) phase_ = before_pause_;
      return;
    case record::EventKind::stopped:
      phase_ = Phase::stopped;
      return;
    case record::EventKind::closed:
      phase_ = Phase::closed;
      return;
    default:
      if (belongs_to_file_chain(event.kind)) refuse(event, "does not belong to a session");
  }
}

}  // namespace touchtrial::session
