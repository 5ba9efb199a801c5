/// \file What is encrypted under a participant's key, and who holds that key: the investigator
/// always, the station only while the session is open. A box is bound to the session's own number
/// (Event::own_session) and to its place there, so that none can be passed off as another. Format:
/// docs/data-dictionary.md, "Events".
#pragma once

#include "core/public_keys.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/trace.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace touchtrial::store {

/// An encrypted trace, on its way to a database or from one.
struct SealedTrace {
  int session = 0;  ///< its own number, see Event::own_session: the box is bound to it
  int trial = 0;
  Bytes box;

  friend bool operator==(const SealedTrace&, const SealedTrace&) = default;
};

/// Events' sealed parts are padded to a multiple of this many bytes.
inline constexpr std::size_t kEventPadding = 256;

/// A participant's random key, sealed for the investigator. Once the row that holds it is
/// destroyed, nobody can read the participant's payloads any more. \param own_session  the
/// session's own number, see SessionRow
[[nodiscard]] Bytes wrap_participant_key(const PublicKey& investigator, int own_session,
                                         const SecretKey& participant_key);
/// \return nothing if the bytes are no such key, or another session's
[[nodiscard]] std::optional<SecretKey> unwrap_participant_key(const BoxKeys& investigator,
                                                              int own_session,
                                                              const Bytes& wrapped);

/// The same key, kept at the station while the session is open, so that it can be resumed there.
/// \param station_secret  see design::Station
[[nodiscard]] Bytes keep_participant_key(const SecretKey& station_secret, int own_session,
                                         const SecretKey& participant_key);
/// \return nothing if the bytes are no such key, another session's or another station's
[[nodiscard]] std::optional<SecretKey> kept_participant_key(const SecretKey& station_secret,
                                                            int own_session, const Bytes& kept);

/// Encrypts the secret text of an event (schedule, measures).
/// \param event  session, sequence and kind are set
/// \param padding  bytes, see touchtrial::seal
[[nodiscard]] Bytes seal_text(const Event& event, const SecretKey& participant_key,
                              const std::string& text, std::size_t padding = kEventPadding);
/// \return the secret text of an event, or nothing if key or bytes are wrong
[[nodiscard]] std::optional<std::string> unsealed(const Event& event,
                                                  const SecretKey& participant_key);

/// Encodes and encrypts a trace. The size of the box depends on the number of samples alone.
/// \param own_session  the session's own number, see SessionRow
/// \throws what encode_trace throws
[[nodiscard]] SealedTrace seal_trace(int own_session, int trial, const Trace& trace,
                                     const SecretKey& participant_key);
/// \return nothing if key, bytes or number of samples are wrong
/// \throws what decode_trace throws
[[nodiscard]] std::optional<Trace> unsealed_trace(const SealedTrace& sealed,
                                                  const SecretKey& participant_key,
                                                  std::size_t sample_count);

}  // namespace touchtrial::store
