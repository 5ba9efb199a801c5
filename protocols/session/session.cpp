#include "protocols/session/session.hpp"

#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace touchtrial {

using Phase = SessionPhase;
using Input = SessionInput;

std::string_view name_of(SessionPhase phase) {
  constexpr std::array<std::string_view, 11> kNames = {
      "fresh",  "opened", "calibrated", "ready",   "exploring", "answering",
      "chosen", "paused", "finished",   "stopped", "closed"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view name_of(SessionInput input) {
  constexpr std::array<std::string_view, 17> kNames = {
      "open",     "calibrate", "instruct",    "present", "contact", "end-exploring",
      "time-out", "interrupt", "store-trace", "choose",  "confirm", "take-break",
      "pause",    "resume",    "note",        "stop",    "close"};
  return kNames[static_cast<std::size_t>(input)];
}

Session::Session(Schedule schedule, const TrialOptions& options, SessionRecorder recorder)
    : schedule_(std::move(schedule)),
      options_(options),
      recorder_(std::move(recorder)),
      queue_(schedule_.presentations.size()) {
  std::iota(queue_.begin(), queue_.end(), std::size_t{0});
}

bool Session::is_under_way() const noexcept {
  return phase_ != Phase::fresh && phase_ != Phase::closed;
}

bool Session::accepts(SessionInput input) const noexcept {
  const bool answering = phase_ == Phase::answering || phase_ == Phase::chosen;
  switch (input) {
    case Input::open:
      return phase_ == Phase::fresh;
    case Input::calibrate:
      return phase_ == Phase::opened;
    case Input::instruct:
      return phase_ == Phase::calibrated;
    case Input::present:
    case Input::take_break:
      return phase_ == Phase::ready;
    case Input::contact:
    case Input::end_exploring:
    case Input::time_out:
      return phase_ == Phase::exploring;
    case Input::interrupt:
      return phase_ == Phase::exploring && !has_trace_;
    case Input::store_trace:
      return (phase_ == Phase::exploring || answering) && !has_trace_;
    case Input::choose:
      return answering && !(answer_ && answer_->first_position);
    case Input::confirm:
      return phase_ == Phase::chosen;
    case Input::pause:
      return phase_ == Phase::ready || answering;
    case Input::resume:
      return phase_ == Phase::paused;
    case Input::note:
      return is_under_way();
    case Input::stop:
      return is_under_way() && phase_ != Phase::finished && phase_ != Phase::stopped;
    case Input::close:
      return phase_ == Phase::finished || phase_ == Phase::stopped;
  }
  return false;
}

void Session::require(SessionInput input, Time at) const {
  if (!accepts(input)) {
    throw std::logic_error("a session that is " + std::string(name_of(phase_)) + " does not take " +
                           std::string(name_of(input)));
  }
  if (at < last_) throw std::logic_error("a session's time went back");
}

void Session::move_to(SessionPhase phase, Time at) noexcept {
  phase_ = phase;
  last_ = at;
}

const Presentation* Session::current() const noexcept {
  return queue_.empty() ? nullptr : &schedule_.presentations[queue_.front()];
}

bool Session::break_due() const noexcept {
  return phase_ == Phase::ready && options_.break_every > 0 &&
         done_since_break_ >= options_.break_every;
}

void Session::open(Time at, const SessionOpening& opening, const std::string& secret_schedule) {
  require(Input::open, at);
  recorder_.opened(at, opening, secret_schedule);
  move_to(Phase::opened, at);
}

void Session::calibrate(Time at, const std::string& text) {
  require(Input::calibrate, at);
  recorder_.remarked(at, EventKind::calibrated, text);
  move_to(Phase::calibrated, at);
}

void Session::instruct(Time at, const std::string& text) {
  require(Input::instruct, at);
  recorder_.remarked(at, EventKind::instructed, text);
  move_to(queue_.empty() ? Phase::finished : Phase::ready, at);
}

void Session::present(Time at) {
  require(Input::present, at);
  recorder_.presented(at, current()->trial, current()->block);
  had_contact_ = false;
  has_trace_ = false;
  answer_.reset();
  move_to(Phase::exploring, at);
}

void Session::contact(Time at) {
  require(Input::contact, at);
  if (!had_contact_) recorder_.first_contact(at, current()->trial);
  had_contact_ = true;
  move_to(Phase::exploring, at);
}

void Session::end_exploring(Time at) {
  require(Input::end_exploring, at);
  move_to(Phase::answering, at);
}

void Session::time_out(Time at) {
  require(Input::time_out, at);
  recorder_.timed_out(at, current()->trial);
  if (options_.on_timeout == OnTimeout::no_response) {
    finish_presentation(at);
  } else {
    move_to(Phase::answering, at);
  }
}

void Session::interrupt(Time at, const std::string& reason,
                        const std::optional<InterruptionDetail>& detail) {
  require(Input::interrupt, at);
  recorder_.interrupted(at, current()->trial, reason, detail);
  queue_.push_back(queue_.front());
  queue_.pop_front();
  move_to(Phase::ready, at);
}

void Session::store_trace(Time at, const TraceBody& body, const TrialMeasures& measures,
                          const Trace& trace) {
  require(Input::store_trace, at);
  recorder_.trace_stored(at, body, measures, trace);
  has_trace_ = true;
  move_to(phase_, at);
}

void Session::choose(int position) {
  require(Input::choose, last_);
  if (position < 0 || position >= static_cast<int>(schedule_.layout.size())) {
    throw std::invalid_argument("there is no picture at this position");
  }
  if (answer_ && answer_->position == position) return;  // no change, and not the one allowed
  answer_ = answer_ ? Answer{position, answer_->position} : Answer{position, std::nullopt};
  phase_ = Phase::chosen;
}

void Session::confirm(Time at, std::optional<int> confidence) {
  require(Input::confirm, at);
  recorder_.answered(at,
                     {current()->trial, answer_->position, answer_->first_position, confidence});
  finish_presentation(at);
}

void Session::finish_presentation(Time at) noexcept {
  queue_.pop_front();
  ++done_since_break_;
  move_to(queue_.empty() ? Phase::finished : Phase::ready, at);
}

void Session::take_break(Time at, const std::string& text) {
  require(Input::take_break, at);
  recorder_.remarked(at, EventKind::break_taken, text);
  done_since_break_ = 0;
  move_to(Phase::ready, at);
}

void Session::pause(Time at, const std::string& reason) {
  require(Input::pause, at);
  recorder_.remarked(at, EventKind::paused, reason);
  before_pause_ = phase_;
  move_to(Phase::paused, at);
}

void Session::resume(Time at) {
  require(Input::resume, at);
  recorder_.remarked(at, EventKind::noted, "resumed");
  move_to(before_pause_, at);
}

void Session::note(Time at, const std::string& text) {
  require(Input::note, at);
  recorder_.remarked(at, EventKind::noted, text);
  move_to(phase_, at);
}

void Session::stop(Time at, const std::string& reason) {
  require(Input::stop, at);
  recorder_.remarked(at, EventKind::stopped, reason);
  move_to(Phase::stopped, at);
}

void Session::close(Time at) {
  require(Input::close, at);
  recorder_.closed(at, phase_ == Phase::finished);
  move_to(Phase::closed, at);
}

}  // namespace touchtrial
