// Restores a session from its events in a database, one by one.
#include "core/errors.hpp"
#include "protocols/session/session.hpp"
#include "protocols/store/payload_json.hpp"

#include <string>
#include <utility>

namespace touchtrial::session {
namespace {

using Phase = SessionPhase;

[[noreturn]] void refuse(const store::Event& event, const std::string& why) {
  throw StoreError("session " + std::to_string(event.session) + ", event " +
                   std::to_string(event.sequence) + " ('" + std::string(name_of(event.kind)) +
                   "'): " + why + "; run `touchtrial verify`");
}

}  // namespace

void Session::restore(std::span<const store::Event> events) {
  if (phase_ != Phase::fresh) throw std::logic_error("a session is restored before it begins");
  for (const store::Event& event : events) {
    follow(event);
    last_ = event.at;
  }
  if (!events.empty()) recorder_.go_on_after(events.back());
}

void Session::take_up(Time at, const store::ResumedBody& body) {
  require(SessionInput::note, at);
  recorder_.resumed(at, body);
  move_to(phase_ == Phase::paused ? before_pause_ : phase_, at);
  if (in_presentation()) interrupt(at, "program ended");
  restart_block(at);  // the program may have ended before it could
}

void Session::follow(const store::Event& event) {
  if (follow_trial(event) || follow_remark(event)) return;
  follow_course(event);
}

bool Session::follow_trial(const store::Event& event) {
  const auto require_current = [&] {
    const int trial = store::trial_from_json(event.body).trial;
    if (!in_presentation() || current()->trial != trial) {
      refuse(event, "trial " + std::to_string(trial) + " is not under way");
    }
  };
  switch (event.kind) {
    case store::EventKind::presented:
      if (phase_ != Phase::ready || current()->trial != store::trial_from_json(event.body).trial) {
        refuse(event, "is not what the schedule has next");
      }
      begin_presentation(event.at);
      return true;
    case store::EventKind::first_contact:
      require_current();
      had_contact_ = true;
      return true;
    case store::EventKind::trace_stored:
      note_force(store::trace_body_from_json(event.body).largest_force_n);
      return true;
    case store::EventKind::timed_out:
      require_current();
      was_timed_out_ = true;
      if (options_.on_timeout == design::OnTimeout::no_response) {
        finish_presentation(event.at, std::nullopt);
      } else {
        phase_ = Phase::answering;
      }
      return true;
    case store::EventKind::answered: {
      require_current();
      const std::optional<int> position = store::answer_from_json(event.body).position;
      if (!position) refuse(event, "is not opened");
      if (*position < 0 || *position >= static_cast<int>(layout().size())) {
        refuse(event, "answers at a position that there is not");
      }
      ++answers_[*position];
      finish_presentation(event.at, *position);
      return true;
    }
    case store::EventKind::interrupted:
      require_current();
      {
        const store::TrialBody body = store::trial_from_json(event.body);
        note_force(body.largest_force_n);
        give_up_presentation(event.at, body.reason);
      }
      return true;
    case store::EventKind::explored_again:
      require_current();
      phase_ = Phase::exploring;
      return true;
    default:
      return false;
  }
}

bool Session::follow_remark(const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::noted:
    case store::EventKind::marked:
      return true;
    case store::EventKind::practised:
      remarks_.practice.push_back(store::practice_from_json(event.body));
      return true;
    case store::EventKind::ticked:
      remarks_.ticked.insert(store::remark_from_json(event.body));
      return true;
    case store::EventKind::deviated:
      remarks_.deviations.insert(store::deviation_from_json(event.body).code);
      return true;
    case store::EventKind::questioned:
      remarks_.questionnaires.insert(store::remark_from_json(event.body));
      return true;
    default:
      return false;
  }
}

void Session::follow_course(const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::opened:
      phase_ = Phase::opened;
      return;
    case store::EventKind::calibrated:
      phase_ = Phase::calibrated;
      return;
    case store::EventKind::instructed:
      phase_ = between_trials();
      return;
    case store::EventKind::break_taken:
      done_since_break_ = 0;
      return;
    case store::EventKind::block_restarted: {
      course_.restart(course_.drawn_again(store::block_from_json(event.body).block));
      done_since_break_ = 0;
      return;
    }
    case store::EventKind::paused:
      before_pause_ = phase_;
      phase_ = Phase::paused;
      return;
    case store::EventKind::resumed:
      if (phase_ == Phase::paused) phase_ = before_pause_;
      return;
    case store::EventKind::stopped:
      phase_ = Phase::stopped;
      return;
    case store::EventKind::closed:
      phase_ = Phase::closed;
      return;
    default:
      refuse(event, "does not belong to a session");
  }
}

}  // namespace touchtrial::session
