#include "protocols/session/session_desk.hpp"

#include "device/platform/stop_signals.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace touchtrial::session {
namespace {

constexpr std::chrono::milliseconds kBetweenShows{250};
/// What a wait without a reply leaves to others.
constexpr std::chrono::milliseconds kBreath{2};

std::string with_text(const std::string& words, const std::string& text) {
  return text.empty() ? words : words + ": " + text;
}

}  // namespace

SessionDesk::SessionDesk(Session& session, const SessionParts& parts)
    : session_(session), parts_(parts) {
  status_.participant = parts.participant_name;
  status_.device = parts.device_name;
}

SessionDesk::Time SessionDesk::now() {
  return std::max(parts_.clock.now(), session_.last());
}

SessionDesk::Time SessionDesk::when(const StepReply& reply) {
  const Time latest = now();
  if (!reply.at) return latest;
  return std::clamp(parts_.clock.of(*reply.at), session_.last(), latest);
}

void SessionDesk::enter(const std::string& stage, bool practice) {
  status_.stage = stage;
  status_.practice = practice;
  show();
}

void SessionDesk::show() {
  status_.trial = session_.presentations_begun();
  status_.of = status_.trial + session_.presentations_left() - (session_.in_presentation() ? 1 : 0);
  status_.elapsed = now();
  shown_ = std::chrono::steady_clock::now();
  parts_.experimenter.show(status_);
}

void SessionDesk::show_now_and_then() {
  if (std::chrono::steady_clock::now() - shown_ >= kBetweenShows) show();
}

void SessionDesk::breathe() const {
  if (parts_.explorer.in_real_time()) std::this_thread::sleep_for(kBreath);
}

bool SessionDesk::goes_on() const noexcept {
  return !tally_.left && !is_aborted_ && session_.phase() != SessionPhase::stopped &&
         session_.phase() != SessionPhase::closed;
}

std::optional<StepReply> SessionDesk::attend(const Step& step) {
  while (obey()) {
    if (std::optional<StepReply> reply = parts_.participant.attend(step)) return reply;
    show_now_and_then();
  }
  return std::nullopt;
}

void SessionDesk::look(device::ServoControl& servo) {
  show_now_and_then();
  // Whoever wants the session to end may ask for it for as long as it has not.
  while (!end_is_postponed()) {
    std::optional<Request> request = parts_.experimenter.request();
    if (!request) return;
    heed(std::move(*request), servo);
  }
}

bool SessionDesk::end_is_postponed() const noexcept {
  return !postponed_.empty() && (postponed_.back().kind == Request::Kind::abort ||
                                 postponed_.back().kind == Request::Kind::leave);
}

void SessionDesk::heed(Request request, device::ServoControl& servo) {
  switch (request.kind) {
    case Request::Kind::comfort_stop:
      reason_ = with_text("comfort stop", request.text);
      servo.comfort_stop();
      return;  // done
    case Request::Kind::abort:
    case Request::Kind::leave:
      reason_ = request.kind == Request::Kind::abort ? "aborted" : "program ended";
      servo.comfort_stop();
      break;
    case Request::Kind::pause:
      servo.finish();
      break;
    default:
      break;
  }
  // Events are stamped in order, and the first contact, known at the exploration's end, comes
  // first.
  postponed_.push_back(std::move(request));
}

std::string SessionDesk::note_interruption(const std::string& words) {
  ++status_.interruptions;
  parts_.devices.interrupted();
  return std::exchange(reason_, std::nullopt).value_or(words);
}

void SessionDesk::saw_servo(const device::ServoReport& report) {
  status_.rate_hz = report.rate_hz;
  status_.lateness_p99_us = report.lateness.p99_us;
  status_.overruns = report.overruns;
}

std::optional<ExperimenterRequest> SessionDesk::next_request() {
  if (postponed_.empty()) return parts_.experimenter.request();
  Request request = std::move(postponed_.front());
  postponed_.pop_front();
  return request;
}

bool SessionDesk::obey() {
  if (!goes_on()) return false;
  if (device::StopOnSignals::asked()) return leave(device::StopOnSignals::message());
  while (const std::optional<Request> request = next_request()) {
    if (!obey(*request)) return false;
  }
  return true;
}

bool SessionDesk::obey(const Request& request) {
  switch (request.kind) {
    case Request::Kind::note:
      session_.note(now(), request.text);
      return true;
    case Request::Kind::deviation:
      session_.deviate(now(), {request.code, request.text});
      return true;
    case Request::Kind::pause:
      return obey_pause(request);
    case Request::Kind::resume:
      return true;  // nothing was paused
    case Request::Kind::comfort_stop:
      return obey_comfort_stop(request);
    case Request::Kind::abort:
      return obey_abort(request);
    case Request::Kind::leave:
      return leave(request.text);
  }
  return true;
}

bool SessionDesk::obey_pause(const Request& request) {
  if (!session_.accepts(SessionInput::pause)) return true;
  session_.pause(now(), request.text);
  const std::string stage = std::exchange(status_.stage, "paused");
  show();
  for (;;) {
    if (device::StopOnSignals::asked()) return leave(device::StopOnSignals::message());
    while (const std::optional<Request> next = next_request()) {
      if (next->kind == Request::Kind::resume) {
        session_.resume(now());
        enter(stage, status_.practice);
        return true;
      }
      if (!obey(*next)) return false;
      if (session_.phase() != SessionPhase::paused) return true;
    }
    static_cast<void>(parts_.participant.attend(PauseStep{}));
    show_now_and_then();
    breathe();
  }
}

/// No force is on: what is left to do is to spoil what is under way, and to ask for consent before
/// there is force again.
bool SessionDesk::obey_comfort_stop(const Request& request) {
  const std::string reason = with_text("comfort stop", request.text);
  if (session_.phase() == SessionPhase::paused) session_.resume(now());
  if (session_.accepts(SessionInput::interrupt)) {
    session_.interrupt(now(), note_interruption(reason));
    return false;
  }
  session_.note(now(), reason);
  parts_.devices.interrupted();
  return session_.phase() != SessionPhase::ready;
}

bool SessionDesk::obey_abort(const Request& request) {
  // A session whose trials are done stays complete.
  const bool is_done = session_.presentations_left() == 0;
  if (is_done && session_.phase() == SessionPhase::paused) session_.resume(now());
  if (session_.accepts(SessionInput::stop)) {
    session_.stop(now(), request.text);
  } else {
    session_.note(now(), with_text("aborted", request.text));
    is_aborted_ = true;
  }
  return false;
}

bool SessionDesk::leave(const std::string& why) {
  if (session_.accepts(SessionInput::note)) session_.note(now(), with_text("left", why));
  tally_.left = why;
  return false;
}

bool SessionDesk::await_device() {
  const SupplyState device = parts_.devices.make_ready();
  if (device == SupplyState::ready) return true;
  const bool pauses =
      session_.accepts(SessionInput::pause) && session_.phase() != SessionPhase::opened;
  if (pauses) session_.pause(now(), "waiting for the device");
  enter("waiting for the device");
  if (!wait_for_device(device)) return false;
  if (session_.phase() == SessionPhase::paused) session_.resume(now());
  return true;
}

bool SessionDesk::wait_for_device(SupplyState device) {
  while (device == SupplyState::not_yet) {
    if (!obey()) return false;
    show_now_and_then();
    breathe();
    device = parts_.devices.make_ready();
  }
  if (device == SupplyState::ready) return true;
  if (device::StopOnSignals::asked()) return leave(device::StopOnSignals::message());
  // Whoever stopped it may have said why.
  if (!obey()) return false;
  session_.stop(now(), "stopped while waiting for the device");
  return false;
}

}  // namespace touchtrial::session
