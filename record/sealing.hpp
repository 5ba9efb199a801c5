/// \file Encryption under a participant's two keys, which the investigator always holds, and the
///   station while the session is open. The safety key is derived from the participant's key, and
///   outlives it: it opens reasons of stops, deviations and the end of a session, but no outcome. A
///   box is bound to the session's own number (Event::own_session) and to its place there, an
///   event's box also to the event's clear part, so that boxes cannot be exchanged. Format:
///   docs/data-dictionary.md, "Events".
#pragma once

#include "core/public_keys.hpp"
#include "record/event.hpp"
#include "record/trace.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace touchtrial::record {

/// An encrypted trace, as written to or read from a database.
struct SealedTrace {
  int session = 0;  ///< its own number (Event::own_session), to which the box is bound
  int trial = 0;
  Bytes box;

  friend bool operator==(const SealedTrace&, const SealedTrace&) = default;
};

/// The key of the safety record. Nobody can compute the participant's key from it.
[[nodiscard]] SecretKey safety_key(const SecretKey& participant_key);
/// Whether the sealed parts of a session's events of this kind belong to the safety record.
[[nodiscard]] bool is_safety_record(EventKind kind);

/// A session's two keys as a database holds them, each sealed for the investigator. What a key
/// sealed is unreadable once the key is destroyed.
struct WrappedKeys {
  std::optional<Bytes> participant;  ///< empty: destroyed
  std::optional<Bytes> safety;       ///< likewise

  friend bool operator==(const WrappedKeys&, const WrappedKeys&) = default;
};

/// The part of a new session's keys that a database stores.
struct NewKeys {
  Bytes participant;    ///< sealed for the investigator
  Bytes safety;         ///< likewise
  PublicKey remarks{};  ///< the participant's key opens what it seals
  PublicKey reasons{};  ///< the safety key opens what it seals
};

/// \param own_session  the session's own number, see SessionRow
[[nodiscard]] NewKeys wrap_participant_key(const PublicKey& investigator, int own_session,
                                           const SecretKey& participant_key);
/// \return nothing if the bytes are not such a key, or another session's
[[nodiscard]] std::optional<SecretKey> unwrap_participant_key(const BoxKeys& investigator,
                                                              int own_session,
                                                              const Bytes& wrapped);
/// The same for a safety key.
[[nodiscard]] std::optional<SecretKey> unwrap_safety_key(const BoxKeys& investigator,
                                                         int own_session, const Bytes& wrapped);

/// The keys that open texts about a person on the file's chain: of the safety record, and of
/// remarks.
[[nodiscard]] BoxKeys reasons_box(const SecretKey& safety_key);
[[nodiscard]] BoxKeys remarks_box(const SecretKey& participant_key);

/// The same key, kept at the station while the session is open, so that it can be resumed there.
/// \param station_secret  see study::Station
[[nodiscard]] Bytes keep_participant_key(const SecretKey& station_secret, int own_session,
                                         const SecretKey& participant_key);
/// \return nothing if the bytes are not such a key, or another session's or station's
[[nodiscard]] std::optional<SecretKey> kept_participant_key(const SecretKey& station_secret,
                                                            int own_session, const Bytes& kept);

/// An event of a session as it was recorded.
struct OpenedEvent {
  Event event;         ///< with its time and its whole body; its hash is that of the stored event
  std::string secret;  ///< text outside the body (schedule, measures); may be empty
};

/// Seals the time of a session's event, the sealed members of its body, and a secret text.
/// \param event  with its time, whole body and `previous`
/// \param padding  bytes, see touchtrial::seal; a multiple of kSealedUnit
/// \return the event as it is stored, with its hash
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] Event sealed_event(Event event, const std::string& secret,
                                 const SecretKey& participant_key, std::size_t padding);
/// The same with the padding of the event's kind.
[[nodiscard]] Event sealed_event(Event event, const std::string& secret,
                                 const SecretKey& participant_key);
/// \param event  of a session, as it is stored
/// \return nothing if the key is wrong, or anything of the event was altered
[[nodiscard]] std::optional<OpenedEvent> opened_event(const Event& event,
                                                      const SecretKey& participant_key);
/// The same with the safety key alone, for events of the safety record.
/// \return nothing also for any other event
[[nodiscard]] std::optional<OpenedEvent> opened_safety_event(const Event& event,
                                                             const SecretKey& safety_key);
/// \return the secret text alone, or nothing likewise
[[nodiscard]] std::optional<std::string> unsealed(const Event& event,
                                                  const SecretKey& participant_key);

/// Encodes and encrypts a trace. The size of the box depends only on its tens of seconds
/// (trace_padding).
/// \param own_session  the session's own number, see SessionRow
/// \throws what encode_trace throws
[[nodiscard]] SealedTrace seal_trace(int own_session, int trial, const Trace& trace,
                                     const SecretKey& participant_key);
/// \return nothing if key or bytes are wrong
/// \throws what decode_trace throws
[[nodiscard]] std::optional<Trace> unsealed_trace(const SealedTrace& sealed,
                                                  const SecretKey& participant_key);

}  // namespace touchtrial::record
