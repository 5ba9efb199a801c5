// A session that stands in a database already: its events, followed one by one.
#include "core/errors.hpp"
#include "protocols/session/session.hpp"
#include "protocols/store/payload_json.hpp"

#include <string>
#include <utility>

namespace touchtrial {
namespace {

using Phase = SessionPhase;

[[noreturn]] void refuse(const Event& event, const std::string& why) {
  throw StoreError("session " + std::to_string(event.session) + ", event " +
                   std::to_string(event.sequence) + " ('" + std::string(name_of(event.kind)) +
                   "'): " + why + "; run `touchtrial verify`");
}

}  // namespace

void Session::restore(std::span<const Event> events) {
  if (phase_ != Phase::fresh) throw std::logic_error("a session is restored before it begins");
  for (const Event& event : events) {
    follow(event);
    last_ = event.at;
  }
  if (!events.empty()) recorder_.go_on_after(events.back());
}

void Session::take_up(Time at, const ResumedBody& body) {
  require(SessionInput::note, at);
  recorder_.resumed(at, body);
  move_to(phase_ == Phase::paused ? before_pause_ : phase_, at);
  if (in_presentation()) interrupt(at, "program ended");
  if (block_to_restart_) restart_block(at);  // the program ended before it could
}

void Session::follow(const Event& event) {
  if (follow_trial(event) || follow_remark(event)) return;
  follow_course(event);
}

bool Session::follow_trial(const Event& event) {
  const auto require_current = [&] {
    const int trial = trial_from_json(event.body).trial;
    if (!in_presentation() || current()->trial != trial) {
      refuse(event, "trial " + std::to_string(trial) + " is not under way");
    }
  };
  switch (event.kind) {
    case EventKind::presented:
      if (phase_ != Phase::ready || current()->trial != trial_from_json(event.body).trial) {
        refuse(event, "is not what the schedule has next");
      }
      begin_presentation(event.at);
      return true;
    case EventKind::first_contact:
      require_current();
      had_contact_ = true;
      return true;
    case EventKind::trace_stored:
      return true;
    case EventKind::timed_out:
      require_current();
      was_timed_out_ = true;
      if (options_.on_timeout == OnTimeout::no_response) {
        finish_presentation(event.at);
      } else {
        phase_ = Phase::answering;
      }
      return true;
    case EventKind::answered:
      require_current();
      finish_presentation(event.at);
      return true;
    case EventKind::interrupted:
      require_current();
      give_up_presentation(event.at);
      return true;
    case EventKind::explored_again:
      require_current();
      phase_ = Phase::exploring;
      return true;
    default:
      return false;
  }
}

bool Session::follow_remark(const Event& event) {
  switch (event.kind) {
    case EventKind::noted:
      return true;
    case EventKind::practised:
      remarks_.practice.push_back(practice_from_json(event.body));
      return true;
    case EventKind::ticked:
      remarks_.ticked.insert(remark_from_json(event.body));
      return true;
    case EventKind::deviated:
      remarks_.deviations.insert(deviation_from_json(event.body).code);
      return true;
    case EventKind::questioned:
      remarks_.questionnaires.insert(remark_from_json(event.body));
      return true;
    default:
      return false;
  }
}

void Session::follow_course(const Event& event) {
  switch (event.kind) {
    case EventKind::opened:
      phase_ = Phase::opened;
      return;
    case EventKind::calibrated:
      phase_ = Phase::calibrated;
      return;
    case EventKind::instructed:
      phase_ = queue_.empty() ? Phase::finished : Phase::ready;
      return;
    case EventKind::break_taken:
      done_since_break_ = 0;
      return;
    case EventKind::block_restarted: {
      const BlockBody body = block_from_json(event.body);
      replace_block(body.block, drawn_again(body.block, body.first_trial));
      return;
    }
    case EventKind::paused:
      before_pause_ = phase_;
      phase_ = Phase::paused;
      return;
    case EventKind::resumed:
      if (phase_ == Phase::paused) phase_ = before_pause_;
      return;
    case EventKind::stopped:
      phase_ = Phase::stopped;
      return;
    case EventKind::closed:
      phase_ = Phase::closed;
      return;
    default:
      refuse(event, "does not belong to a session");
  }
}

}  // namespace touchtrial
