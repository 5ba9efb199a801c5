#include "protocols/session/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial::session {
namespace {

/// Whether there are 20 or more answers, at least 95 % of them at the same position.
bool is_one_key(const std::map<int, int>& answers, int n) {
  constexpr int kMinAnswers = 20;
  constexpr int kInverseOtherShare = 20;
  if (n < kMinAnswers) return false;
  const auto& [position, at_position] =
      *std::ranges::max_element(answers, {}, &std::pair<const int, int>::second);
  return (n - at_position) * kInverseOtherShare <= n;
}

}  // namespace

using Phase = SessionPhase;
using Input = SessionInput;

std::string_view name_of(SessionPhase phase) {
  constexpr std::array<std::string_view, 11> kNames = {
      "fresh",  "opened", "calibrated", "ready",   "exploring", "answering",
      "chosen", "paused", "finished",   "stopped", "closed"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view name_of(SessionInput input) {
  constexpr std::array<std::string_view, 19> kNames = {
      "open",          "calibrate", "instruct",  "present",       "contact",
      "end-exploring", "time-out",  "interrupt", "keep-evidence", "explore-again",
      "choose",        "confirm",   "practise",  "take-break",    "pause",
      "resume",        "note",      "stop",      "close"};
  return kNames[static_cast<std::size_t>(input)];
}

SerialiseBlock block_serialiser(const study::StudyCodes& codes) {
  return [&codes](const std::vector<study::Trial>& trials) {
    return study::block_to_json(trials, codes);
  };
}

Session::Session(std::unique_ptr<study::Order> order, const study::TrialOptions& options,
                 record::SessionRecorder recorder, SerialiseBlock seal)
    : course_(std::move(order), options.on_interruption),
      options_(options),
      recorder_(std::move(recorder)),
      serialise_block_(std::move(seal)) {
  if (options.on_interruption == study::OnInterruption::restart_block && !serialise_block_) {
    throw std::invalid_argument("Session: `seal` is required if the study restarts blocks");
  }
}

bool Session::is_open() const noexcept {
  return phase_ != Phase::fresh && phase_ != Phase::closed;
}

bool Session::in_presentation() const noexcept {
  const Phase phase = phase_ == Phase::paused ? before_pause_ : phase_;
  return phase == Phase::exploring || phase == Phase::answering || phase == Phase::chosen;
}

bool Session::has_changed_choice() const noexcept {
  const auto* const choice = answer_ ? std::get_if<ChoiceAnswer>(&*answer_) : nullptr;
  return choice != nullptr && choice->first_position.has_value();
}

bool Session::accepts(SessionInput input) const noexcept {
  const bool is_answering = phase_ == Phase::answering || phase_ == Phase::chosen;
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
    case Input::keep_evidence:
      return phase_ == Phase::exploring || is_answering;
    case Input::explore_again:
      return is_answering && !was_timed_out_;
    case Input::choose:
      return is_answering && !has_changed_choice();
    case Input::confirm:
      return phase_ == Phase::chosen;
    case Input::practise:
      return phase_ == Phase::ready && begun_ == 0;
    case Input::pause:
      return is_open() && phase_ != Phase::exploring && phase_ != Phase::paused &&
             phase_ != Phase::stopped;
    case Input::resume:
      return phase_ == Phase::paused;
    case Input::note:
      return is_open();
    case Input::stop:
      return is_open() && phase_ != Phase::finished && phase_ != Phase::stopped;
    case Input::close:
      return phase_ == Phase::finished || phase_ == Phase::stopped;
  }
  return false;
}

void Session::require(SessionInput input, Time at) const {
  if (!accepts(input)) {
    throw std::logic_error("a session in the phase " + std::string(name_of(phase_)) +
                           " does not accept the input " + std::string(name_of(input)));
  }
  if (at < last_) throw std::logic_error("the session's time ran backwards");
  if (observer_) observer_(input, current() == nullptr ? 0 : current()->place.trial);
}

void Session::move_to(SessionPhase phase, Time at) noexcept {
  phase_ = phase;
  last_ = at;
}

SessionPhase Session::between_trials() const noexcept {
  return course_.is_over() ? Phase::finished : Phase::ready;
}

bool Session::is_break_due() const noexcept {
  if (phase_ != Phase::ready || done_since_break_ == 0) return false;
  const bool due_by_trials = options_.break_every > 0 && done_since_break_ >= options_.break_every;
  const std::chrono::duration<double, std::ratio<60>> work = last_ - work_began_at_;
  const bool due_by_time =
      options_.break_after_min > 0.0 && work.count() >= options_.break_after_min;
  return due_by_trials || due_by_time;
}

void Session::open(Time at, const record::SessionOpening& opening,
                   const std::string& secret_schedule) {
  require(Input::open, at);
  recorder_.opened(at, opening, secret_schedule);
  move_to(Phase::opened, at);
}

void Session::calibrate(Time at, const std::string& text) {
  require(Input::calibrate, at);
  recorder_.add(at, record::EventKind::calibrated, record::TextBody{.text = text});
  move_to(Phase::calibrated, at);
}

void Session::instruct(Time at, const std::string& text) {
  require(Input::instruct, at);
  recorder_.add(at, record::EventKind::instructed, record::TextBody{.text = text});
  move_to(between_trials(), at);
}

void Session::present(Time at) {
  require(Input::present, at);
  recorder_.presented(at, current()->place.trial, current()->place.block);
  begin_presentation(at);
}

void Session::begin_presentation(Time at) noexcept {
  // The hand has rested before the first trial after a break, instructions or practice.
  if (done_since_break_ == 0) work_began_at_ = at;
  had_contact_ = false;
  was_timed_out_ = false;
  evidence_.reset();
  answer_.reset();
  ++begun_;
  move_to(Phase::exploring, at);
}

void Session::contact(Time at) {
  require(Input::contact, at);
  if (!had_contact_) recorder_.first_contact(at, current()->place.trial);
  had_contact_ = true;
  move_to(Phase::exploring, at);
}

void Session::end_exploring(Time at) {
  require(Input::end_exploring, at);
  move_to(Phase::answering, at);
}

void Session::time_out(Time at) {
  require(Input::time_out, at);
  const bool is_done = options_.on_timeout == study::OnTimeout::no_response;
  recorder_.timed_out(at, current()->place.trial, is_done ? evidence_ : std::nullopt);
  was_timed_out_ = true;
  if (is_done) {
    finish_presentation(at, std::nullopt);
  } else {
    move_to(Phase::answering, at);
  }
}

void Session::interrupt(Time at, const std::string& reason,
                        const std::optional<record::InterruptionDetail>& detail) {
  require(Input::interrupt, at);
  recorder_.interrupted(at, current()->place.trial, reason, detail);
  if (detail) note_force(detail->largest_force_n);
  void_presentation(at, reason);
  restart_block(at);
}

void Session::keep_evidence(record::TrialEvidence evidence) {
  require(Input::keep_evidence, last_);
  note_force(evidence.body.largest_force_n);
  evidence_ = std::move(evidence);
}

void Session::explore_again(Time at) {
  require(Input::explore_again, at);
  recorder_.add(at, record::EventKind::explored_again, record::TrialBody{current()->place.trial});
  answer_.reset();
  move_to(Phase::exploring, at);
}

void Session::choose(int position) {
  require(Input::choose, last_);
  if (position < 0 || position >= static_cast<int>(layout().size())) {
    throw std::invalid_argument("there is no choice at position " + std::to_string(position));
  }
  const auto* const previous = answer_ ? std::get_if<ChoiceAnswer>(&*answer_) : nullptr;
  if (previous != nullptr && previous->position == position)
    return;  // the same choice is not a change
  answer_ =
      previous != nullptr ? ChoiceAnswer{position, previous->position} : ChoiceAnswer{position};
  phase_ = Phase::chosen;
}

void Session::rate(std::vector<double> values) {
  require(Input::choose, last_);
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument("a rating is not a finite number");
  }
  answer_ = RatingAnswer{std::move(values)};
  phase_ = Phase::chosen;
}

void Session::confirm(Time at, std::optional<int> confidence) {
  require(Input::confirm, at);
  record::AnswerBody body{
      .trial = current()->place.trial, .answer = answer_, .confidence = confidence};
  if (const auto& level = current()->level) {
    body.kind = name_of(current()->role);
    body.track = level->track;
    body.level = level->level;
    body.target = current()->right;
  }
  recorder_.answered(at, body, evidence_);
  count(*answer_);
  finish_presentation(at, answer_);
}

void Session::count(const Answer& answer) {
  ++answered_;
  if (const auto* const choice = std::get_if<ChoiceAnswer>(&answer)) ++choices_[choice->position];
}

std::optional<int> Session::current_trial_number() const noexcept {
  return in_presentation() ? std::optional(current()->place.trial) : std::nullopt;
}

void Session::note_force(double largest_n) {
  largest_force_n_ = std::max(largest_force_n_.value_or(0.0), largest_n);
}

void Session::finish_presentation(Time at, const std::optional<Answer>& answer) {
  if (evidence_) note_force(evidence_->body.largest_force_n);
  course_.finish(answer);
  evidence_.reset();
  ++done_since_break_;
  move_to(between_trials(), at);
}

void Session::void_presentation(Time at, const std::string& reason) {
  if (reason != record::kPauseReason) course_.interrupt();
  evidence_.reset();
  move_to(between_trials(), at);
}

void Session::restart_block(Time at) {
  if (!course_.block_to_restart()) return;
  const study::BlockRestart block = course_.redrawn_block(*course_.block_to_restart());
  recorder_.block_restarted(at, block.block, block.first_trial(), serialise_block_(block.trials));
  course_.restart(block);
  done_since_break_ = 0;
  move_to(phase_, at);
}

void Session::take_break(Time at, const std::string& text) {
  require(Input::take_break, at);
  recorder_.add(at, record::EventKind::break_taken, record::TextBody{.text = text});
  done_since_break_ = 0;
  move_to(Phase::ready, at);
}

void Session::pause(Time at, const std::string& reason) {
  require(Input::pause, at);
  recorder_.add(at, record::EventKind::paused,
                record::PauseBody{.text = reason, .trial = current_trial_number()});
  before_pause_ = phase_;
  move_to(Phase::paused, at);
}

void Session::resume(Time at) {
  require(Input::resume, at);
  recorder_.add(at, record::EventKind::resumed,
                record::ResumedBody{.after = "pause",
                                    .away_s = std::chrono::duration<double>(at - last_).count(),
                                    .trial = current_trial_number()});
  move_to(before_pause_, at);
}

void Session::practise(Time at, const record::PracticeBody& body) {
  require(Input::practise, at);
  recorder_.add(at, record::EventKind::practised, body);
  remarks_.practice.push_back(body);
  move_to(phase_, at);
}

void Session::deviate(Time at, const record::DeviationBody& body) {
  require(Input::note, at);
  recorder_.add(at, record::EventKind::deviated, body);
  remarks_.deviations.insert(body.code);
  move_to(phase_, at);
}

void Session::tick(Time at, const std::string& item) {
  require(Input::note, at);
  recorder_.add(at, record::EventKind::ticked, record::TextBody{.text = item});
  remarks_.ticked.insert(item);
  move_to(phase_, at);
}

void Session::question(Time at, const std::string& name, const std::string& answers) {
  require(Input::note, at);
  recorder_.add(at, record::EventKind::questioned, record::TextBody{name}, answers);
  remarks_.questionnaires.insert(name);
  move_to(phase_, at);
}

void Session::mark(Time at, const record::MarksBody& marks) {
  require(Input::note, at);
  recorder_.add(at, record::EventKind::marked, record::EmptyBody{}, to_json(marks));
  move_to(phase_, at);
}

void Session::note(Time at, const std::string& text) {
  require(Input::note, at);
  recorder_.add(at, record::EventKind::noted, record::RemarkBody{.text = text});
  move_to(phase_, at);
}

void Session::stop(Time at, const std::string& reason, const std::string& code) {
  require(Input::stop, at);
  recorder_.add(at, record::EventKind::stopped, record::StopBody{.code = code, .text = reason});
  move_to(Phase::stopped, at);
}

void Session::close(Time at, bool states_one_key) {
  require(Input::close, at);
  recorder_.closed(at, phase_ == Phase::finished, answered_,
                   states_one_key && is_one_key(choices_, answered_), largest_force_n_);
  move_to(Phase::closed, at);
}

}  // namespace touchtrial::session
