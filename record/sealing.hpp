/// \file Encryption under a participant's two keys. The investigator always holds them; the station
///   holds them while the session is open. The safety key is derived from the participant's key,
///   and outlives it: it opens reasons of stops, deviations and the end of a session, but no
///   outcome. A box is bound to Event::own_session and to its place in the session. An event's box
///   is also bound to the event's clear part. Boxes can therefore not be exchanged. Format:
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
  int session = 0;  ///< Event::own_session, to which the box is bound
  int trial = 0;
  Bytes box;

  friend bool operator==(const SealedTrace&, const SealedTrace&) = default;
};

/// The key of the safety record. The participant's key cannot be computed from it.
[[nodiscard]] SecretKey safety_key(const SecretKey& participant_key);
/// Whether the sealed parts of a session's events of this kind belong to the safety record.
[[nodiscard]] bool is_safety_record(EventKind kind);

/// A session's two keys as stored in a database, each sealed for the investigator. Destroying a key
/// makes everything that it sealed unreadable.
struct WrappedKeys {
  std::optional<Bytes> participant;  ///< empty: destroyed
  std::optional<Bytes> safety;       ///< empty: destroyed

  friend bool operator==(const WrappedKeys&, const WrappedKeys&) = default;
};

/// The part of a new session's keys that a database stores.
struct NewKeys {
  Bytes participant;    ///< sealed for the investigator
  Bytes safety;         ///< sealed for the investigator
  PublicKey remarks{};  ///< seals texts that the participant's key opens
  PublicKey reasons{};  ///< seals texts that the safety key opens
};

/// \param own_session  Event::own_session
[[nodiscard]] NewKeys wrap_participant_key(const PublicKey& investigator, int own_session,
                                           const SecretKey& participant_key);
/// \return nothing if the bytes are not such a key, or another session's
[[nodiscard]] std::optional<SecretKey> unwrap_participant_key(const BoxKeys& investigator,
                                                              int own_session,
                                                              const Bytes& wrapped);
/// The same for a safety key.
[[nodiscard]] std::optional<SecretKey> unwrap_safety_key(const BoxKeys& investigator,
                                                         int own_session, const Bytes& wrapped);

/// The keys for texts about a person on the file's chain: of the safety record, and of remarks.
[[nodiscard]] BoxKeys reasons_box(const SecretKey& safety_key);
[[nodiscard]] BoxKeys remarks_box(const SecretKey& participant_key);

/// Seals the station's copy of the participant's key, with which it can resume an open session.
/// \param station_secret  see study::Station
[[nodiscard]] Bytes seal_station_copy(const SecretKey& station_secret, int own_session,
                                      const SecretKey& participant_key);
/// \return nothing if the bytes are not such a key, or another session's or station's
[[nodiscard]] std::optional<SecretKey> open_station_copy(const SecretKey& station_secret,
                                                         int own_session, const Bytes& copy);

/// A decrypted event of a session.
struct OpenedEvent {
  Event event;         ///< with its time and complete body; its hash is that of the stored event
  std::string secret;  ///< text outside the body (schedule, measures); may be empty
};

/// Seals the time of a session's event, the sealed members of its body, and a secret text.
/// \param event  with its time, complete body and `previous`
/// \param padding  bytes, see touchtrial::seal; a multiple of kSealedUnit
/// \return the event to be stored, with its hash
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] Event sealed_event(Event event, const std::string& secret,
                                 const SecretKey& participant_key, std::size_t padding);
/// The same with the padding of the event's kind.
[[nodiscard]] Event sealed_event(Event event, const std::string& secret,
                                 const SecretKey& participant_key);
/// \param event  a stored event of a session
/// \return nothing if the key is wrong, or any part of the event was altered
[[nodiscard]] std::optional<OpenedEvent> opened_event(const Event& event,
                                                      const SecretKey& participant_key);
/// Opens an event of the safety record with the safety key.
/// \return nothing for other events, or as opened_event
[[nodiscard]] std::optional<OpenedEvent> opened_safety_event(const Event& event,
                                                             const SecretKey& safety_key);
/// Opens only the secret text.
/// \return nothing as opened_event
[[nodiscard]] std::optional<std::string> unsealed(const Event& event,
                                                  const SecretKey& participant_key);

/// Encodes and encrypts a trace. The box's size depends only on the trace's duration in steps of
/// ten seconds (trace_padding).
/// \param own_session  Event::own_session
/// \throws as encode_trace
[[nodiscard]] SealedTrace seal_trace(int own_session, int trial, const Trace& trace,
                                     const SecretKey& participant_key);
/// \return nothing if key or bytes are wrong
/// \throws as decode_trace
[[nodiscard]] std::optional<Trace> unsealed_trace(const SealedTrace& sealed,
                                                  const SecretKey& participant_key);

}  // namespace touchtrial::record
