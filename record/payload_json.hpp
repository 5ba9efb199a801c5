/// \file The bodies of events as compact JSON with sorted keys, and back. Reading requires all
/// members of a body and ignores keys that a later version may add. Format:
/// docs/data-dictionary.md, "Events".
#pragma once

#include "record/body_io.hpp"
#include "record/body_parts.hpp"
#include "record/damage.hpp"
#include "record/event.hpp"
#include "record/file_bodies.hpp"
#include "record/session_bodies.hpp"

#include <functional>
#include <string>

namespace touchtrial::record {

using DescribeMembers = std::function<void(BodyIo& io)>;

/// \throws StoreError if a text is not UTF-8 or a number is not finite
[[nodiscard]] std::string write_body(const DescribeMembers& describe);
/// \throws StoreError, naming the key, if the parts are not such a body
void read_body(const BodyParts& parts, const DescribeMembers& describe);

/// \throws as write_body
template <typename Body>
[[nodiscard]] std::string to_json(Body body) {
  return write_body([&](BodyIo& io) { body.describe(io); });
}

/// \throws as read_body
template <typename Body>
[[nodiscard]] Body from_parts(const BodyParts& parts) {
  Body body;
  read_body(parts, [&](BodyIo& io) { body.describe(io); });
  return body;
}
/// \throws as read_body
template <typename Body>
[[nodiscard]] Body from_json(const std::string& text) {
  return from_parts<Body>({text, ""});
}

/// The body of an event.
/// \throws EventFault, naming the event, if it is not such a body
template <typename Body>
[[nodiscard]] Body body_of(const Event& event) {
  return body_of(event, from_json<Body>);
}

/// Requires the body of an event to have the members of its kind.
/// \throws EventFault, naming the event, if it does not
void require_members(const Event& event);

/// The body of a station's event for a collected study: `session` becomes the session's number
/// there; everything else is unchanged.
/// \throws StoreError if the text is not a body about a session
[[nodiscard]] std::string renumbered(const std::string& body, int session);
/// The same for a `session-opened`, which also gets the session's station.
[[nodiscard]] std::string renumbered_opening(const std::string& body, int session, int station);

/// The measures that are sealed with a trace.
/// \throws StoreError with the remedy
[[nodiscard]] TrialMeasures measures_from_json(const std::string& text);
/// The number of the session that a body on the file's chain is about.
[[nodiscard]] int session_from_json(const std::string& text);

}  // namespace touchtrial::record
