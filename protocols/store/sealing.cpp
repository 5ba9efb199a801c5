#include "protocols/store/sealing.hpp"

#include <algorithm>

namespace touchtrial::store {
namespace {

constexpr std::size_t kWrapPadding = 64;

SecretKey keeping_key(const SecretKey& station_secret) {
  return derive_key(station_secret, "participant keys");
}

std::optional<SecretKey> key_from(const std::optional<Bytes>& bytes) {
  SecretKey key{};
  if (!bytes || bytes->size() != key.size()) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), key.begin());
  return key;
}

// What each box is bound to; part of the format.

std::string participant_key_context(int own_session) {
  return "participant-key|" + std::to_string(own_session);
}

std::string event_context(const Event& event) {
  return "event|" + std::to_string(event.own_session()) + "|" + std::to_string(event.sequence) +
         "|" + std::string(name_of(event.kind));
}

std::string trace_context(int own_session, int trial) {
  return "trace|" + std::to_string(own_session) + "|" + std::to_string(trial);
}

}  // namespace

Bytes wrap_participant_key(const PublicKey& investigator, int own_session,
                           const SecretKey& participant_key) {
  return seal_box(investigator, participant_key_context(own_session), participant_key,
                  derive_key(participant_key, "wrapping for " + to_hex(investigator)));
}

std::optional<SecretKey> unwrap_participant_key(const BoxKeys& investigator, int own_session,
                                                const Bytes& wrapped) {
  return key_from(open_box(investigator, participant_key_context(own_session), wrapped));
}

Bytes keep_participant_key(const SecretKey& station_secret, int own_session,
                           const SecretKey& participant_key) {
  return seal(keeping_key(station_secret), participant_key_context(own_session), participant_key,
              kWrapPadding);
}

std::optional<SecretKey> kept_participant_key(const SecretKey& station_secret, int own_session,
                                              const Bytes& kept) {
  return key_from(unseal(keeping_key(station_secret), participant_key_context(own_session), kept,
                         kWrapPadding));
}

Bytes seal_text(const Event& event, const SecretKey& participant_key, const std::string& text,
                std::size_t padding) {
  return seal(participant_key, event_context(event), bytes_of(text), padding);
}

std::optional<std::string> unsealed(const Event& event, const SecretKey& participant_key) {
  const std::optional<Bytes> bytes = unseal(participant_key, event_context(event), event.sealed);
  if (!bytes) return std::nullopt;
  return text_of(*bytes);
}

SealedTrace seal_trace(int own_session, int trial, const Trace& trace,
                       const SecretKey& participant_key) {
  return {.session = own_session,
          .trial = trial,
          .box = seal(participant_key, trace_context(own_session, trial), encode_trace(trace),
                      trace_padding(trace.samples.size()))};
}

std::optional<Trace> unsealed_trace(const SealedTrace& sealed, const SecretKey& participant_key,
                                    std::size_t sample_count) {
  const std::optional<Bytes> bytes =
      unseal(participant_key, trace_context(sealed.session, sealed.trial), sealed.box,
             trace_padding(sample_count));
  if (!bytes) return std::nullopt;
  return decode_trace(*bytes);
}

}  // namespace touchtrial::store
