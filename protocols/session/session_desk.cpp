#include "protocols/session/session_desk.hpp"

#include "device/platform/stop_signals.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace touchtrial::session {
namespace {

constexpr std::chrono::milliseconds kShowInterval{250};
/// The time between two polls for a reply.
constexpr std::chrono::milliseconds kPollPause{2};

constexpr const char* kComfortStop = "comfort stop";
constexpr const char* kStopped = "stopped";  ///< stage after a comfort stop

std::string phrase_with_text(const std::string& phrase, const std::string& text) {
  return text.empty() ? phrase : phrase + ": " + text;
}

}  // namespace

/// Forwards all calls to the participant, and polls the experimenter's requests while the plane is
/// on.
class SessionDesk::AttendedParticipant final : public Participant {
 public:
  explicit AttendedParticipant(SessionDesk& desk)
      : desk_(desk),
        participant_(desk.parts_.participant),
        in_real_time_(desk.parts_.explorer.in_real_time()) {}

  void see_pictures(const std::vector<std::string>& labels) override {
    participant_.see_pictures(labels);
  }
  [[nodiscard]] std::optional<StepReply> show_step(const Step& step) override {
    return participant_.show_step(step);
  }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    return participant_.begin_exploring(plane);
  }
  void note_plane_on(std::chrono::steady_clock::time_point began) noexcept override {
    desk_.marks_.note_plane_on(began);
    participant_.note_plane_on(began);
  }
  void while_exploring(device::ServoControl& servo) override {
    participant_.while_exploring(servo);
    desk_.poll_experimenter(servo);
  }
  void feel(const device::ServoSample& sample) noexcept override {
    desk_.marks_.feel(sample);
    if (in_real_time_) desk_.hand_meter_.feel(sample);
    participant_.feel(sample);
  }

 private:
  SessionDesk& desk_;
  Participant& participant_;
  bool in_real_time_;
};

SessionDesk::SessionDesk(Session& session, const SessionParts& parts)
    : session_(session),
      parts_(parts),
      marks_(parts.explorer.in_real_time() ? parts.instruments : nullptr, session, parts.rate_hz),
      hand_meter_(parts.key.study.trials.validity, parts.rate_hz) {
  status_.participant = parts.participant_name;
  status_.device = parts.device_name;
}

void SessionDesk::record_marks() {
  if (!session_.accepts(SessionInput::note)) return;
  if (const auto marks = marks_.take(parts_.clock)) session_.mark(now(), *marks);
}

SessionDesk::Time SessionDesk::now() {
  return std::max(parts_.clock.now(), session_.last());
}

SessionDesk::Time SessionDesk::time_of(const StepReply& reply) {
  const Time latest = now();
  if (!reply.at) return latest;
  return std::clamp(parts_.clock.time_of(*reply.at), session_.last(), latest);
}

void SessionDesk::enter(const std::string& stage) {
  status_.stage = stage;
  status_.practice = false;
  status_.participant_stopped = stage == kStopped && is_participants_stop_;
  announces_next_ = stage == "ready";
  show();
}

void SessionDesk::enter_practice(const std::string& stage, int presentation, int presentations) {
  status_.stage = stage;
  status_.practice = true;
  status_.participant_stopped = false;
  status_.trial = presentation;
  status_.total = presentations;
  show();
}

void SessionDesk::show() {
  if (!status_.practice) {
    const int begun = session_.presentations_begun();
    status_.trial = begun + (announces_next_ && !session_.in_presentation() ? 1 : 0);
    status_.total = begun + session_.presentations_left() - (session_.in_presentation() ? 1 : 0);
  }
  status_.elapsed = now();
  status_.hand = hand_meter_.levels();
  last_shown_ = std::chrono::steady_clock::now();
  parts_.experimenter.show(status_);
}

void SessionDesk::show_at_intervals() {
  if (std::chrono::steady_clock::now() - last_shown_ >= kShowInterval) show();
}

void SessionDesk::sleep_briefly() const {
  if (parts_.explorer.in_real_time()) std::this_thread::sleep_for(kPollPause);
}

bool SessionDesk::is_running() const noexcept {
  return !leave_reason_ && !is_aborted_ && session_.phase() != SessionPhase::stopped &&
         session_.phase() != SessionPhase::closed;
}

std::optional<StepReply> SessionDesk::show_step(const Step& step) {
  while (handle()) {
    if (std::optional<StepReply> reply = parts_.participant.show_step(step)) {
      parts_.clock.advance(reply->took);
      return reply;
    }
    show_at_intervals();
  }
  return std::nullopt;
}

Exploration SessionDesk::explore(device::ForceSource& force, const PlaneGeometry& plane,
                                 const device::ServoOptions& options, record::Trace& trace) {
  AttendedParticipant participant(*this);
  hand_meter_.begin();
  was_cut_short_ = false;
  Exploration exploration = parts_.explorer.explore(force, plane, participant, options, trace);
  hand_meter_.begin();
  was_cut_short_ = was_cut_short_ && exploration.servo.end == device::ServoEnd::hand_stopped;
  parts_.clock.advance(exploration.duration);
  status_.rate_hz = exploration.servo.rate_hz;
  status_.lateness_p99_us = exploration.servo.lateness.p99_us;
  status_.overruns = exploration.servo.overruns;
  return exploration;
}

device::ServoOptions SessionDesk::servo_options() const {
  return trial_servo_options(parts_.key.study, parts_.rate_hz, parts_.limits);
}

void SessionDesk::poll_experimenter(device::ServoControl& servo) {
  show_at_intervals();
  // The experimenter may repeat a request to end the session until it is handled.
  while (!end_is_postponed()) {
    std::optional<Request> request = parts_.experimenter.request();
    if (!request) return;
    handle_while_exploring(std::move(*request), servo);
  }
}

bool SessionDesk::end_is_postponed() const noexcept {
  return !postponed_.empty() && (postponed_.back().kind == Request::Kind::abort ||
                                 postponed_.back().kind == Request::Kind::leave);
}

void SessionDesk::handle_while_exploring(Request request, device::ServoControl& servo) {
  switch (request.kind) {
    case Request::Kind::comfort_stop:
      reason_ = kComfortStop;
      servo.comfort_stop();
      if (request.text.empty()) return;  // nothing to record
      request = {Request::Kind::deviation, request.text, kComfortStopCode};
      break;
    case Request::Kind::abort:
    case Request::Kind::leave:
      reason_ = request.kind == Request::Kind::abort ? "aborted" : "program ended";
      servo.comfort_stop();
      break;
    case Request::Kind::pause:
      // If the participant has already finished, the pause begins at the answer screen.
      was_cut_short_ = was_cut_short_ || !servo.finish_requested();
      servo.finish();
      break;
    default:
      break;
  }
  // Recorded after the exploration, because events are stored in chronological order, and the time
  // of the first contact is known only at the end.
  postponed_.push_back(std::move(request));
}

std::string SessionDesk::note_interruption(const device::ServoReport& report) {
  return count_interruption(public_reason(report));
}

/// The experimenter's reason takes precedence.
std::string SessionDesk::count_interruption(const std::string& reason) {
  ++status_.interruptions;
  parts_.devices.on_interruption();
  is_stopped_ = reason_.value_or(reason) == kComfortStop;
  is_participants_stop_ = is_stopped_ && !reason_;
  return std::exchange(reason_, std::nullopt).value_or(reason);
}

std::optional<ExperimenterRequest> SessionDesk::next_request() {
  if (postponed_.empty()) return parts_.experimenter.request();
  Request request = std::move(postponed_.front());
  postponed_.pop_front();
  return request;
}

bool SessionDesk::handle() {
  if (!is_running()) return false;
  if (device::StopOnSignals::stop_requested()) return leave(device::StopOnSignals::message());
  while (const std::optional<Request> request = next_request()) {
    if (!handle(*request)) return false;
  }
  return true;
}

bool SessionDesk::handle(const Request& request) {
  switch (request.kind) {
    case Request::Kind::note:
      session_.note(now(), request.text);
      return true;
    case Request::Kind::deviation:
      session_.deviate(now(), {request.code, request.text});
      return true;
    case Request::Kind::delay:
      return handle_delay(request);
    case Request::Kind::pause:
      return handle_pause(request);
    case Request::Kind::resume:
      return true;  // the session is not paused
    case Request::Kind::comfort_stop:
      return handle_comfort_stop(request);
    case Request::Kind::abort:
      return handle_abort(request);
    case Request::Kind::leave:
      return leave(request.text);
  }
  return true;
}

bool SessionDesk::handle_pause(const Request& request) {
  // Between two planes, no force is on, but the presentation has begun.
  const bool interrupts = session_.phase() == SessionPhase::exploring;
  if (interrupts) session_.interrupt(now(), record::kPauseReason);
  if (!session_.accepts(SessionInput::pause)) return true;
  session_.pause(now(), request.text);
  ++pauses_;
  const std::string stage = std::exchange(status_.stage, "paused");
  show();
  for (;;) {
    if (device::StopOnSignals::stop_requested()) return leave(device::StopOnSignals::message());
    while (const std::optional<Request> next = next_request()) {
      if (next->kind == Request::Kind::resume) {
        session_.resume(now());
        status_.stage = stage;
        show();
        return !interrupts;
      }
      if (!handle(*next)) return false;
      if (session_.phase() != SessionPhase::paused) return true;
    }
    static_cast<void>(parts_.participant.show_step(PauseStep{}));
    show_at_intervals();
    sleep_briefly();
  }
}

/// Records the delay as a completed pause, because it would otherwise count as answering time.
bool SessionDesk::handle_delay(const Request& request) {
  session_.deviate(now(), {request.code, request.text});
  if (!session_.in_presentation()) return true;
  if (session_.phase() == SessionPhase::exploring) {
    session_.interrupt(now(), record::kPauseReason);
    return false;
  }
  if (!session_.accepts(SessionInput::pause)) return true;  // already paused
  session_.pause(now(), request.code);
  session_.resume(now());
  return true;
}

/// Handles a comfort stop while no force is on. Interrupts the current presentation; the device
/// asks for consent before force is sent again.
bool SessionDesk::handle_comfort_stop(const Request& request) {
  if (session_.phase() == SessionPhase::paused) session_.resume(now());
  const bool interrupts = session_.accepts(SessionInput::interrupt);
  if (interrupts) {
    reason_ = kComfortStop;
    session_.interrupt(now(), count_interruption(kComfortStop));
  }
  if (!interrupts || !request.text.empty()) {
    session_.deviate(now(), {.code = kComfortStopCode, .text = request.text});
  }
  if (interrupts) return false;
  is_stopped_ = true;
  is_participants_stop_ = false;
  parts_.devices.on_interruption();
  return session_.phase() != SessionPhase::ready;
}

bool SessionDesk::handle_abort(const Request& request) {
  // If all trials are done, the session stays complete.
  const bool is_done = session_.presentations_left() == 0;
  if (is_done && session_.phase() == SessionPhase::paused) session_.resume(now());
  if (session_.accepts(SessionInput::stop)) {
    session_.stop(now(), request.text);
  } else {
    session_.note(now(), phrase_with_text("aborted", request.text));
    is_aborted_ = true;
  }
  return false;
}

bool SessionDesk::leave(const std::string& reason) {
  if (session_.accepts(SessionInput::note)) session_.note(now(), phrase_with_text("left", reason));
  leave_reason_ = reason;
  return false;
}

bool SessionDesk::await_device() {
  const SupplyState device = parts_.devices.make_ready();
  if (device == SupplyState::ready) return wait_for_consent();
  const bool pauses =
      session_.accepts(SessionInput::pause) && session_.phase() != SessionPhase::opened;
  if (pauses) session_.pause(now(), "waiting for the device");
  status_.needs_consent = true;
  enter(is_stopped_ ? kStopped : "waiting for the device");
  const bool is_ready = wait_for_device(device);
  status_.needs_consent = false;
  if (!is_ready) return false;
  is_stopped_ = false;
  if (session_.phase() == SessionPhase::paused) session_.resume(now());
  return true;
}

bool SessionDesk::wait_for_consent() {
  if (!is_stopped_) return true;
  enter(kStopped);
  if (!show_step(NoticeStep{NoticeStep::What::stopped, session_.presentations_begun()}))
    return false;
  is_stopped_ = false;
  return true;
}

Step SessionDesk::waiting_page() const {
  if (!is_stopped_) return PauseStep{};
  return NoticeStep{NoticeStep::What::stopped, session_.presentations_begun(), false};
}

bool SessionDesk::wait_for_device(SupplyState device) {
  while (device == SupplyState::not_yet) {
    if (!handle()) return false;
    static_cast<void>(parts_.participant.show_step(waiting_page()));
    show_at_intervals();
    sleep_briefly();
    device = parts_.devices.make_ready();
  }
  if (device == SupplyState::ready) return true;
  if (device::StopOnSignals::stop_requested()) return leave(device::StopOnSignals::message());
  // The experimenter may have given a reason.
  if (!handle()) return false;
  session_.stop(now(), "", "stopped while waiting for the device");
  return false;
}

}  // namespace touchtrial::session
