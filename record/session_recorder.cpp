#include "record/session_recorder.hpp"

#include "core/errors.hpp"
#include "record/body_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchtrial::record {
namespace {

/// The padding of an interruption, bytes: room for a flight record of three seconds, or for the
/// next whole thousand of ticks if it is longer. The size therefore reveals neither roughness nor
/// duration.
std::size_t interruption_padding(std::int64_t ticks) {
  // A row is at most 384 bytes long: 21 values, 14 of them with up to 24 characters.
  constexpr std::size_t kBytesPerThousandTicks = 384'000;
  constexpr std::size_t kHeaderBytes = 1024;
  constexpr std::size_t kMinThousands = 3;
  const std::size_t thousands = (static_cast<std::size_t>(ticks) + 999) / 1000;
  return kHeaderBytes + kBytesPerThousandTicks * std::max(kMinThousands, thousands);
}
static_assert(1024 % kSealedUnit == 0 && 384'000 % kSealedUnit == 0);

double largest_force_in(const Trace& trace) {
  double largest_squared = 0.0;
  for (const TraceSample& sample : trace.samples) {
    largest_squared = std::max(largest_squared, dot(sample.force_n, sample.force_n));
  }
  return std::sqrt(largest_squared);
}

}  // namespace

void BufferedEvents::accept(const Event& event, const std::optional<SealedTrace>& trace) {
  events.push_back(event);
  if (trace) traces.push_back(*trace);
}

SessionRecorder::SessionRecorder(int session, const SecretKey& participant_key, EventSink& sink)
    : session_(session), participant_key_(participant_key), sink_(sink) {}

void SessionRecorder::opened(std::chrono::nanoseconds at, const SessionOpening& opening,
                             const std::string& secret_schedule) {
  append(at, {EventKind::opened, to_json(opening), secret_schedule});
}

void SessionRecorder::presented(std::chrono::nanoseconds at, int trial, int block) {
  append(at, {EventKind::presented, to_json(PresentedBody{.trial = trial, .block = block})});
}

void SessionRecorder::first_contact(std::chrono::nanoseconds at, int trial) {
  append(at, {EventKind::first_contact, to_json(TrialBody{trial})});
}

void SessionRecorder::answered(std::chrono::nanoseconds at, const AnswerBody& answer,
                               const std::optional<TrialEvidence>& evidence) {
  append_with_evidence(at, evidence, {EventKind::answered, to_json(answer)});
}

void SessionRecorder::interrupted(std::chrono::nanoseconds at, int trial, const std::string& reason,
                                  const std::optional<InterruptionDetail>& detail) {
  InterruptedBody body{.trial = trial, .reason = reason};
  if (detail) {
    body.safety_fault = detail->safety_fault;
    body.device_fault = detail->device_fault;
    body.largest_force_n = detail->largest_force_n;
  }
  Draft draft{EventKind::interrupted, to_json(body)};
  if (detail) {
    draft.secret = to_json(*detail);
    draft.padding = interruption_padding(detail->ticks);
  }
  append(at, std::move(draft));
}

void SessionRecorder::timed_out(std::chrono::nanoseconds at, int trial,
                                const std::optional<TrialEvidence>& evidence) {
  append_with_evidence(at, evidence, {EventKind::timed_out, to_json(TrialBody{trial})});
}

TrialEvidence SessionRecorder::pack_evidence(TraceBody body, const TrialMeasures& measures,
                                             const Trace& trace) const {
  SealedTrace sealed = seal_trace(session_, body.trial, trace, participant_key_);
  body.samples = static_cast<std::int64_t>(trace.samples.size());
  body.largest_force_n = largest_force_in(trace);
  body.trace = blake2b(sealed.box);
  return {std::move(body), measures, std::move(sealed)};
}

void SessionRecorder::trace_stored(std::chrono::nanoseconds at, const TraceBody& body,
                                   const TrialMeasures& measures, const Trace& trace) {
  append(at, draft_of(pack_evidence(body, measures, trace)));
}

void SessionRecorder::block_restarted(std::chrono::nanoseconds at, int block, int first_trial,
                                      const std::string& secret_schedule) {
  append(at, {EventKind::block_restarted,
              to_json(BlockBody{.block = block, .first_trial = first_trial}), secret_schedule});
}

void SessionRecorder::closed(std::chrono::nanoseconds at, bool complete, int answers, bool one_key,
                             std::optional<double> largest_force_n) {
  if (largest_force_n) largest_force_n = in_tenths(*largest_force_n);
  // Sealing this requires the key, so a forged chain ends differently.
  const ClosedBody body{.complete = complete,
                        .answers = answers,
                        .one_key = one_key,
                        .largest_force_n = largest_force_n};
  append(at,
         {EventKind::closed, to_json(body), to_json(ChainEnd{.length = length_, .head = head_})});
}

void SessionRecorder::continue_after(const Event& last) {
  head_ = last.hash;
  length_ = last.sequence + 1;
  last_at_ = last.at;
}

SessionRecorder::Draft SessionRecorder::draft_of(TrialEvidence evidence) {
  return {.kind = EventKind::trace_stored,
          .body = to_json(evidence.body),
          .secret = to_json(evidence.measures),
          .trace = std::move(evidence.trace)};
}

void SessionRecorder::add_described(std::chrono::nanoseconds at, EventKind kind,
                                    DescribeBody describe, std::string body, std::string secret) {
  if (row_of(kind).body != describe) {
    throw StoreError("an event of kind '" + std::string(name_of(kind)) +
                     "' has the wrong body; use the type in its row of event_kinds.cpp");
  }
  append(at, {kind, std::move(body), std::move(secret)});
}

void SessionRecorder::append(std::chrono::nanoseconds at, Draft draft) {
  append_together(at, std::span(&draft, 1));
}

void SessionRecorder::append_with_evidence(std::chrono::nanoseconds at,
                                           const std::optional<TrialEvidence>& evidence,
                                           Draft draft) {
  std::vector<Draft> drafts;
  if (evidence) drafts.push_back(draft_of(*evidence));
  drafts.push_back(std::move(draft));
  append_together(at, drafts);
}

void SessionRecorder::append_together(std::chrono::nanoseconds at, std::span<Draft> drafts) {
  if (at < last_at_) {
    throw StoreError("session " + std::to_string(session_) + ": the clock ran backwards before '" +
                     std::string(name_of(drafts.front().kind)) + "'; use a monotonic clock");
  }
  std::vector<RecordedEvent> events;
  Digest previous = head_;
  for (Draft& draft : drafts) {
    const std::int64_t sequence = length_ + static_cast<std::int64_t>(events.size());
    events.push_back(make_event(at, sequence, previous, draft));
    previous = events.back().event.hash;
  }
  if (events.size() == 1) {
    sink_.accept(events.front().event, events.front().trace);
  } else {
    sink_.accept_together(events);
  }
  // Added last: an event that the sink refused is not part of the chain.
  head_ = previous;
  last_at_ = at;
  length_ += static_cast<std::int64_t>(events.size());
}

RecordedEvent SessionRecorder::make_event(std::chrono::nanoseconds at, std::int64_t sequence,
                                          const Digest& previous, Draft& draft) const {
  Event event{.session = session_,
              .sequence = sequence,
              .kind = draft.kind,
              .at = at,
              .body = std::move(draft.body),
              .sealed = {},
              .previous = previous,
              .hash = {}};
  const std::size_t padding = draft.padding.value_or(sealed_padding(draft.kind));
  return {sealed_event(std::move(event), draft.secret, participant_key_, padding),
          std::move(draft.trace)};
}

}  // namespace touchtrial::record
