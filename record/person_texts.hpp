/// \file Texts about a person on the file's chain, which anybody can seal and only a session's keys
/// open: the participant's key opens remarks, the safety key reasons and deviations. Codes stay in
/// clear. Format: docs/data-dictionary.md, "Events".
#pragma once

#include "record/event.hpp"
#include "record/file_bodies.hpp"

#include <optional>
#include <string>

namespace touchtrial::record {

/// The remaining keys of a session.
struct PersonKeys {
  std::optional<SecretKey> participant;  ///< empty: destroyed
  std::optional<SecretKey> safety;       ///< likewise
};

/// A body in two parts: one in clear, and a box.
struct PersonText {
  std::string clear;  ///< JSON
  Bytes sealed;
};

/// \param kind  participant_excluded, -withdrawn, -replaced or -noted
/// \param at  of the event
/// \param body  whole, as to_json makes it
/// \param opened  of the session that it is about
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] PersonText sealed_person_text(EventKind kind, std::chrono::nanoseconds at,
                                            const std::string& body,
                                            const SessionOpenedBody& opened);

/// The key that opens an event's sealed part, of any chain, if it still exists.
[[nodiscard]] const std::optional<SecretKey>& opener_of(const Event& event, const PersonKeys& keys);

/// An event with its texts back in its body.
/// \param event  of a file's chain, as it is stored; one without texts is unchanged
/// \param own_session  see Event::own_session, of the session that it is about
/// \return nothing if its key is missing or it was altered
[[nodiscard]] std::optional<Event> opened_person_text(const Event& event, int own_session,
                                                      const PersonKeys& keys);

}  // namespace touchtrial::record
