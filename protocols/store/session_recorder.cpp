#include "protocols/store/session_recorder.hpp"

#include "core/errors.hpp"
#include "protocols/store/contexts.hpp"
#include "protocols/store/payload_json.hpp"

#include <utility>

namespace touchtrial {
namespace {

bool is_remark(EventKind kind) {
  switch (kind) {
    case EventKind::calibrated:
    case EventKind::instructed:
    case EventKind::practised:
    case EventKind::break_taken:
    case EventKind::paused:
    case EventKind::stopped:
    case EventKind::noted:
      return true;
    default:
      return false;
  }
}

}  // namespace

void BufferedEvents::accept(const Event& event, const std::optional<SealedTrace>& trace) {
  events.push_back(event);
  if (trace) traces.push_back(*trace);
}

std::size_t interruption_padding(std::int64_t ticks) {
  // A row has 21 values, 14 of them of up to 24 characters; ordinary rows need 330 bytes or less.
  constexpr std::size_t kBytesATick = 384;
  constexpr std::size_t kBytesBefore = 1024;
  const std::size_t bytes = kBytesBefore + kBytesATick * static_cast<std::size_t>(ticks);
  return (bytes + kEventPadding - 1) / kEventPadding * kEventPadding;
}

SessionRecorder::SessionRecorder(int session, const SecretKey& participant_key, EventSink& sink)
    : session_(session), participant_key_(participant_key), sink_(sink) {}

void SessionRecorder::opened(std::chrono::nanoseconds at, const SessionOpening& opening,
                             const std::string& secret_schedule) {
  append(at, EventKind::opened, to_json(opening), {secret_schedule});
}

void SessionRecorder::presented(std::chrono::nanoseconds at, int trial, int block) {
  append(at, EventKind::presented, presented_to_json(trial, block), {});
}

void SessionRecorder::first_contact(std::chrono::nanoseconds at, int trial) {
  append(at, EventKind::first_contact, trial_to_json(trial), {});
}

void SessionRecorder::answered(std::chrono::nanoseconds at, const AnswerBody& answer) {
  append(at, EventKind::answered, to_json(answer), {});
}

void SessionRecorder::interrupted(std::chrono::nanoseconds at, int trial, const std::string& reason,
                                  const std::optional<InterruptionDetail>& detail) {
  Secret secret;
  if (detail) secret = {to_json(*detail), interruption_padding(detail->ticks)};
  append(at, EventKind::interrupted, interrupted_to_json(trial, reason), secret);
}

void SessionRecorder::timed_out(std::chrono::nanoseconds at, int trial) {
  append(at, EventKind::timed_out, trial_to_json(trial), {});
}

void SessionRecorder::trace_stored(std::chrono::nanoseconds at, TraceBody body,
                                   const TrialMeasures& measures, const Trace& trace) {
  SealedTrace sealed{.session = session_,
                     .trial = body.trial,
                     .box = seal(participant_key_, trace_context(session_, body.trial),
                                 encode_trace(trace), trace_padding(trace.samples.size()))};
  body.samples = static_cast<std::int64_t>(trace.samples.size());
  body.trace = sha256(sealed.box);
  append(at, EventKind::trace_stored, to_json(body), {to_json(measures)}, std::move(sealed));
}

void SessionRecorder::remarked(std::chrono::nanoseconds at, EventKind kind,
                               const std::string& text) {
  if (!is_remark(kind)) {
    throw StoreError("an event of kind '" + std::string(name_of(kind)) +
                     "' is no remark; record it with the function of its name");
  }
  append(at, kind, remark_to_json(text), {});
}

void SessionRecorder::closed(std::chrono::nanoseconds at, bool complete) {
  // Only who has the key can seal this: a chain that was made anew without it ends otherwise.
  append(at, EventKind::closed, completion_to_json(complete),
         {to_json(ChainEnd{.length = length_, .head = head_})});
}

void SessionRecorder::append(std::chrono::nanoseconds at, EventKind kind, std::string body,
                             const Secret& secret, const std::optional<SealedTrace>& trace) {
  if (at < last_at_) {
    throw StoreError("session " + std::to_string(session_) + ": the clock went backwards before '" +
                     std::string(name_of(kind)) + "'; use a monotonic clock");
  }
  Event event{.session = session_,
              .sequence = length_,
              .kind = kind,
              .at = at,
              .body = std::move(body),
              .sealed = {},
              .previous = head_,
              .hash = {}};
  if (!secret.text.empty()) {
    event.sealed = seal(participant_key_, event_context(session_, length_, kind),
                        bytes_of(secret.text), secret.padding);
  }
  event.hash = event_hash(event);
  sink_.accept(event, trace);
  // Only now: an event that its sink refused is not part of the chain.
  head_ = event.hash;
  last_at_ = at;
  ++length_;
}

}  // namespace touchtrial
