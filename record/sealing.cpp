#include "record/sealing.hpp"

#include "record/body_parts.hpp"
#include "record/event_kinds.hpp"
#include "record/opened_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace touchtrial::record {
namespace {

constexpr std::size_t kWrapPadding = 64;

SecretKey station_copy_key(const SecretKey& station_secret) {
  return derive_key(station_secret, "participant keys");
}

std::optional<SecretKey> key_from(const std::optional<Bytes>& bytes) {
  SecretKey key{};
  if (!bytes || bytes->size() != key.size()) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), key.begin());
  return key;
}

// The context that each box is bound to; part of the format.

std::string participant_key_context(int own_session) {
  return "participant-key|" + std::to_string(own_session);
}

std::string safety_key_context(int own_session) {
  return "safety-key|" + std::to_string(own_session);
}

std::string event_context(const Event& event) {
  std::string context = "event|";
  context.reserve(128 + event.body.size());
  context.append(std::to_string(event.own_session())).append("|");
  context.append(std::to_string(event.sequence)).append("|");
  context.append(name_of(event.kind)).append("|");
  context.append(to_hex(event.previous)).append("|");
  return context.append(event.body);
}

std::string trace_context(int own_session, int trial) {
  return "trace|" + std::to_string(own_session) + "|" + std::to_string(trial);
}

// The sealed part of an event: its time, the length of the hidden part of its body, that part, and
// the secret text. Numbers are little-endian.

constexpr std::size_t kTimeSize = 8;
constexpr std::size_t kLengthSize = 4;
constexpr std::size_t kPrefixSize = kTimeSize + kLengthSize;

void put_number(Bytes& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(number >> (8U * i)));
  }
}

std::uint64_t read_number(ByteView bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) number = (number << 8U) | bytes[i - 1];
  return number;
}

Bytes wrap_key_for(const PublicKey& investigator, const std::string& context,
                   const SecretKey& key) {
  return seal_box(investigator, context, key,
                  derive_key(key, "wrapping for " + to_hex(investigator)));
}

/// The key that seals a session's events of a kind.
SecretKey key_of_kind(EventKind kind, const SecretKey& participant_key) {
  return is_safety_record(kind) ? safety_key(participant_key) : participant_key;
}

/// \param key  the key that sealed the event
std::optional<OpenedParts> open_parts(const Event& event, const Unsealer& key) {
  const std::optional<Bytes> plain = key(event_context(event), event.sealed, kSealedUnit);
  if (!plain || plain->size() < kPrefixSize) return std::nullopt;
  const ByteView bytes(*plain);
  const std::uint64_t length = read_number(bytes.subspan(kTimeSize, kLengthSize));
  const ByteView texts = bytes.subspan(kPrefixSize);
  if (length > texts.size()) return std::nullopt;
  return OpenedParts{.at = std::chrono::nanoseconds(
                         static_cast<std::int64_t>(read_number(bytes.first(kTimeSize)))),
                     .body = {event.body, text_of(texts.first(length))},
                     .secret = text_of(texts.subspan(length))};
}

/// \param key  the key that sealed the event
std::optional<OpenedEvent> open_event(const Event& event, const SecretKey& key) {
  std::optional<OpenedParts> parts = open_parts(event, Unsealer(key));
  if (!parts) return std::nullopt;
  OpenedEvent opened{.event = event, .secret = std::move(parts->secret)};
  opened.event.at = parts->at;
  opened.event.body = join_body(parts->body);
  opened.event.sealed.clear();
  return opened;
}

}  // namespace

SecretKey safety_key(const SecretKey& participant_key) {
  return derive_key(participant_key, "safety");
}

bool is_safety_record(EventKind kind) {
  return row_of(kind).details.in_safety_record;
}

NewKeys wrap_participant_key(const PublicKey& investigator, int own_session,
                             const SecretKey& participant_key) {
  const SecretKey safety = safety_key(participant_key);
  return {.participant =
              wrap_key_for(investigator, participant_key_context(own_session), participant_key),
          .safety = wrap_key_for(investigator, safety_key_context(own_session), safety),
          .remarks = remarks_box(participant_key).public_half,
          .reasons = reasons_box(safety).public_half};
}

std::optional<SecretKey> unwrap_participant_key(const BoxKeys& investigator, int own_session,
                                                const Bytes& wrapped) {
  return key_from(open_box(investigator, participant_key_context(own_session), wrapped));
}

std::optional<SecretKey> unwrap_safety_key(const BoxKeys& investigator, int own_session,
                                           const Bytes& wrapped) {
  return key_from(open_box(investigator, safety_key_context(own_session), wrapped));
}

BoxKeys reasons_box(const SecretKey& safety_key) {
  return box_keys(derive_key(safety_key, "reasons"));
}

BoxKeys remarks_box(const SecretKey& participant_key) {
  return box_keys(derive_key(participant_key, "remarks"));
}

Bytes seal_station_copy(const SecretKey& station_secret, int own_session,
                        const SecretKey& participant_key) {
  return seal(station_copy_key(station_secret), participant_key_context(own_session),
              participant_key, kWrapPadding);
}

std::optional<SecretKey> open_station_copy(const SecretKey& station_secret, int own_session,
                                           const Bytes& copy) {
  return key_from(unseal(station_copy_key(station_secret), participant_key_context(own_session),
                         copy, kWrapPadding));
}

Event sealed_event(Event event, const std::string& secret, const SecretKey& participant_key,
                   std::size_t padding) {
  BodyParts parts = split_body(event.kind, event.body);
  Bytes plain;
  put_number(plain, static_cast<std::uint64_t>(event.at.count()), kTimeSize);
  put_number(plain, parts.hidden.size(), kLengthSize);
  for (const std::string& text : {parts.hidden, secret}) {
    plain.insert(plain.end(), text.begin(), text.end());
  }
  event.at = {};
  event.body = std::move(parts.clear);
  event.sealed =
      seal(key_of_kind(event.kind, participant_key), event_context(event), plain, padding);
  event.hash = event_hash(event);
  return event;
}

Event sealed_event(Event event, const std::string& secret, const SecretKey& participant_key) {
  const std::size_t padding = sealed_padding(event.kind);
  return sealed_event(std::move(event), secret, participant_key, padding);
}

std::optional<OpenedEvent> opened_event(const Event& event, const SecretKey& participant_key) {
  return open_event(event, key_of_kind(event.kind, participant_key));
}

EventOpener::EventOpener(const SecretKey& participant_key)
    : participant_(participant_key), safety_(safety_key(participant_key)) {}

std::optional<OpenedParts> EventOpener::operator()(const Event& event) const {
  return open_parts(event, is_safety_record(event.kind) ? safety_ : participant_);
}

std::optional<OpenedEvent> opened_safety_event(const Event& event, const SecretKey& safety_key) {
  if (!is_safety_record(event.kind)) return std::nullopt;
  return open_event(event, safety_key);
}

std::optional<std::string> unsealed(const Event& event, const SecretKey& participant_key) {
  std::optional<OpenedEvent> opened = opened_event(event, participant_key);
  if (!opened) return std::nullopt;
  return std::move(opened->secret);
}

SealedTrace seal_trace(int own_session, int trial, const Trace& trace,
                       const SecretKey& participant_key) {
  return {.session = own_session,
          .trial = trial,
          .box = seal(participant_key, trace_context(own_session, trial), encode_trace(trace),
                      trace_padding(trace.samples.size()))};
}

std::optional<Trace> unsealed_trace(const SealedTrace& sealed, const SecretKey& participant_key) {
  // The start of the padding is marked, so its size need not be known.
  const std::optional<Bytes> bytes = unseal(
      participant_key, trace_context(sealed.session, sealed.trial), sealed.box, /*padded_size=*/1);
  if (!bytes) return std::nullopt;
  return decode_trace(*bytes);
}

}  // namespace touchtrial::record
