/// \file Texts about a person on the file's chain. Anybody can seal them, but only a session's keys
/// open them: the participant's key opens remarks, and the safety key opens reasons and deviations.
/// Codes stay unencrypted. Format: docs/data-dictionary.md, "Events".
#pragma once

#include "record/event.hpp"
#include "record/file_bodies.hpp"

#include <optional>
#include <string>

namespace touchtrial::record {

/// The keys of a session that still exist.
struct PersonKeys {
  std::optional<SecretKey> participant;  ///< empty: destroyed
  std::optional<SecretKey> safety;       ///< empty: destroyed
};

/// A body in two parts: one unencrypted, and a box.
struct PersonText {
  std::string clear;  ///< JSON
  Bytes sealed;
};

/// \param kind  participant_excluded, -withdrawn, -replaced or -noted
/// \param at  the event's time
/// \param body  the complete body, from to_json
/// \param opening  the opening of its session
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] PersonText sealed_person_text(EventKind kind, std::chrono::nanoseconds at,
                                            const std::string& body,
                                            const SessionOpenedBody& opening);

/// The key that opens the sealed part of an event of any chain, if it still exists.
[[nodiscard]] const std::optional<SecretKey>& opening_key(const Event& event,
                                                          const PersonKeys& keys);

/// An event with its sealed texts restored to its body.
/// \param event  a stored event of a file's chain; returned unchanged if it has none
/// \param own_session  Event::own_session of its session
/// \return nothing if its key is missing or it was altered
[[nodiscard]] std::optional<Event> opened_person_text(const Event& event, int own_session,
                                                      const PersonKeys& keys);

}  // namespace touchtrial::record
