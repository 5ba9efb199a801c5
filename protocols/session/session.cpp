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

/// To tenths of a second: an exact time would tell more than how quickly somebody answers.
/// \return 0 if every answer waited for the end of a pause
double median_s(std::span<const GivenAnswer> answers) {
  std::vector<double> times_s;
  for (const GivenAnswer& answer : answers) {
    if (answer.took) times_s.push_back(std::chrono::duration<double>(*answer.took).count());
  }
  if (times_s.empty()) return 0.0;
  std::ranges::sort(times_s);
  const std::size_t half = times_s.size() / 2;
  const bool is_odd = times_s.size() % 2 == 1;
  const double median = is_odd ? times_s[half] : (times_s[half - 1] + times_s[half]) / 2.0;
  return std::round(10.0 * median) / 10.0;
}

int longest_run(std::span<const GivenAnswer> answers) {
  int longest = 0;
  int run = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const bool goes_on = i > 0 && answers[i].position == answers[i - 1].position;
    run = goes_on ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

/// How a participant answered, without what was right; nothing without answers.
std::optional<store::AnswerSummary> summary_of(std::span<const GivenAnswer> answers) {
  if (answers.empty()) return std::nullopt;
  std::map<int, int> counts;
  int most = 0;
  for (const GivenAnswer& answer : answers) most = std::max(most, ++counts[answer.position]);
  const auto n = static_cast<int>(answers.size());
  return store::AnswerSummary{.n = n,
                              .different = static_cast<int>(counts.size()),
                              .largest_share = static_cast<double>(most) / n,
                              .longest_run = longest_run(answers),
                              .median_s = median_s(answers)};
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

Session::Session(design::Schedule schedule, const design::TrialOptions& options,
                 store::SessionRecorder recorder, BlockDrawing blocks,
                 std::unique_ptr<design::AdaptiveOrder> order)
    : course_(std::move(schedule), options.on_interruption, std::move(blocks.draw),
              std::move(order)),
      options_(options),
      recorder_(std::move(recorder)),
      secret_of_block_(std::move(blocks.secret)) {
  if (options.on_interruption == design::OnInterruption::restart_block && !secret_of_block_) {
    throw std::invalid_argument("Session: a study that restarts blocks needs to seal them");
  }
}

bool Session::is_under_way() const noexcept {
  return phase_ != Phase::fresh && phase_ != Phase::closed;
}

bool Session::in_presentation() const noexcept {
  const Phase phase = phase_ == Phase::paused ? before_pause_ : phase_;
  return phase == Phase::exploring || phase == Phase::answering || phase == Phase::chosen;
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
    case Input::keep_evidence:
      return phase_ == Phase::exploring || answering;
    case Input::explore_again:
      return answering && !was_timed_out_;
    case Input::choose:
      return answering && !(answer_ && answer_->first_position);
    case Input::confirm:
      return phase_ == Phase::chosen;
    case Input::practise:
      return phase_ == Phase::ready && begun_ == 0;
    case Input::pause:
      return is_under_way() && phase_ != Phase::exploring && phase_ != Phase::paused &&
             phase_ != Phase::stopped;
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
  if (told_) told_(input, current() == nullptr ? 0 : current()->trial);
}

void Session::move_to(SessionPhase phase, Time at) noexcept {
  phase_ = phase;
  last_ = at;
}

SessionPhase Session::between_trials() const noexcept {
  return course_.is_over() ? Phase::finished : Phase::ready;
}

bool Session::break_due() const noexcept {
  if (phase_ != Phase::ready || done_since_break_ == 0) return false;
  const bool by_trials = options_.break_every > 0 && done_since_break_ >= options_.break_every;
  const std::chrono::duration<double, std::ratio<60>> since = last_ - rested_at_;
  const bool by_time = options_.break_after_min > 0.0 && since.count() >= options_.break_after_min;
  return by_trials || by_time;
}

void Session::open(Time at, const store::SessionOpening& opening,
                   const std::string& secret_schedule) {
  require(Input::open, at);
  recorder_.opened(at, opening, secret_schedule);
  move_to(Phase::opened, at);
}

void Session::calibrate(Time at, const std::string& text) {
  require(Input::calibrate, at);
  recorder_.remarked(at, store::EventKind::calibrated, text);
  move_to(Phase::calibrated, at);
}

void Session::instruct(Time at, const std::string& text) {
  require(Input::instruct, at);
  recorder_.remarked(at, store::EventKind::instructed, text);
  move_to(between_trials(), at);
}

void Session::present(Time at) {
  require(Input::present, at);
  recorder_.presented(at, current()->trial, current()->block);
  begin_presentation(at);
}

void Session::begin_presentation(Time at) noexcept {
  // The first trial after a break, instructions or practice: until then the hand has rested.
  if (done_since_break_ == 0) rested_at_ = at;
  presented_at_ = at;
  had_contact_ = false;
  was_timed_out_ = false;
  paused_answer_ = false;
  evidence_.reset();
  answer_.reset();
  ++begun_;
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
  const bool over = options_.on_timeout == design::OnTimeout::no_response;
  recorder_.timed_out(at, current()->trial, over ? evidence_ : std::nullopt);
  was_timed_out_ = true;
  if (over) {
    finish_presentation(at, std::nullopt);
  } else {
    move_to(Phase::answering, at);
  }
}

void Session::interrupt(Time at, const std::string& reason,
                        const std::optional<store::InterruptionDetail>& detail) {
  require(Input::interrupt, at);
  recorder_.interrupted(at, current()->trial, reason, detail);
  if (detail) note_force(detail->largest_force_n);
  give_up_presentation(at, reason);
  restart_block(at);
}

void Session::keep_evidence(store::TrialEvidence evidence) {
  require(Input::keep_evidence, last_);
  note_force(evidence.body.largest_force_n);
  evidence_ = std::move(evidence);
}

void Session::explore_again(Time at) {
  require(Input::explore_again, at);
  recorder_.explored_again(at, current()->trial);
  answer_.reset();
  move_to(Phase::exploring, at);
}

void Session::choose(int position) {
  require(Input::choose, last_);
  if (position < 0 || position >= static_cast<int>(layout().size())) {
    throw std::invalid_argument("there is no picture at this position");
  }
  if (answer_ && answer_->position == position) return;  // no change, and not the one allowed
  answer_ = answer_ ? Answer{position, answer_->position} : Answer{position, std::nullopt};
  phase_ = Phase::chosen;
}

void Session::confirm(Time at, std::optional<int> confidence) {
  require(Input::confirm, at);
  store::AnswerBody body{current()->trial, answer_->position, answer_->first_position, confidence};
  if (const auto& chosen = current()->chosen) {
    body.track = chosen->track;
    body.level = chosen->level;
    body.target = chosen->target;
  }
  recorder_.answered(at, body, evidence_);
  note_answer(at, answer_->position);
  finish_presentation(at, answer_->position);
}

void Session::note_evidence(const store::TraceBody& body) {
  if (body.saturated) ++saturated_;
  note_force(body.largest_force_n);
}

void Session::note_answer(Time at, int position) {
  GivenAnswer given{position, std::nullopt};
  if (!paused_answer_) given.took = at - presented_at_;
  answers_.push_back(given);
}

std::optional<int> Session::trial_under_way() const noexcept {
  return in_presentation() ? std::optional(current()->trial) : std::nullopt;
}

void Session::note_force(double largest_n) {
  largest_force_n_ = std::max(largest_force_n_.value_or(0.0), largest_n);
}

void Session::finish_presentation(Time at, std::optional<int> position) {
  if (evidence_) note_evidence(evidence_->body);
  course_.finish(position);
  evidence_.reset();
  ++done_since_break_;
  move_to(between_trials(), at);
}

void Session::give_up_presentation(Time at, const std::string& reason) {
  if (reason != store::kPauseReason) course_.spoil();
  evidence_.reset();
  move_to(between_trials(), at);
}

void Session::restart_block(Time at) {
  if (!course_.block_to_restart()) return;
  const design::BlockRestart again = course_.drawn_again(*course_.block_to_restart());
  recorder_.block_restarted(at, again.block, again.first_trial(),
                            secret_of_block_(again.presentations));
  course_.restart(again);
  done_since_break_ = 0;
  move_to(phase_, at);
}

void Session::take_break(Time at, const std::string& text) {
  require(Input::take_break, at);
  recorder_.remarked(at, store::EventKind::break_taken, text);
  done_since_break_ = 0;
  move_to(Phase::ready, at);
}

void Session::pause(Time at, const std::string& reason) {
  require(Input::pause, at);
  if (in_presentation()) paused_answer_ = true;
  recorder_.paused(at, {.text = reason, .trial = trial_under_way()});
  before_pause_ = phase_;
  move_to(Phase::paused, at);
}

void Session::resume(Time at) {
  require(Input::resume, at);
  recorder_.resumed(at, {.after = "pause",
                         .away_s = std::chrono::duration<double>(at - last_).count(),
                         .trial = trial_under_way()});
  move_to(before_pause_, at);
}

void Session::practise(Time at, const store::PracticeBody& body) {
  require(Input::practise, at);
  recorder_.practised(at, body);
  remarks_.practice.push_back(body);
  move_to(phase_, at);
}

void Session::deviate(Time at, const store::DeviationBody& body) {
  require(Input::note, at);
  recorder_.deviated(at, body);
  remarks_.deviations.insert(body.code);
  move_to(phase_, at);
}

void Session::tick(Time at, const std::string& item) {
  require(Input::note, at);
  recorder_.remarked(at, store::EventKind::ticked, item);
  remarks_.ticked.insert(item);
  move_to(phase_, at);
}

void Session::question(Time at, const std::string& name, const std::string& answers) {
  require(Input::note, at);
  recorder_.questioned(at, name, answers);
  remarks_.questionnaires.insert(name);
  move_to(phase_, at);
}

void Session::mark(Time at, const store::MarksBody& marks) {
  require(Input::note, at);
  recorder_.marked(at, marks);
  move_to(phase_, at);
}

void Session::note(Time at, const std::string& text) {
  require(Input::note, at);
  recorder_.remarked(at, store::EventKind::noted, text);
  move_to(phase_, at);
}

void Session::stop(Time at, const std::string& reason, const std::string& code) {
  require(Input::stop, at);
  recorder_.stopped(at, {.code = code, .text = reason});
  move_to(Phase::stopped, at);
}

void Session::close(Time at) {
  require(Input::close, at);
  recorder_.closed(at, phase_ == Phase::finished, summary_of(answers_), saturated_,
                   largest_force_n_);
  move_to(Phase::closed, at);
}

}  // namespace touchtrial::session
