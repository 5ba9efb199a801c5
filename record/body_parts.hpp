/// \file Which members of an event's body anybody may read, and which are sealed with the event's
/// time. Source: docs/data-dictionary.md, "Events".
#pragma once

#include "record/event.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::record {

/// A body in two, each a compact JSON object with sorted keys.
struct BodyParts {
  std::string clear;
  std::string hidden;  ///< empty if every member is in clear
};

/// \param body  whole, of an event of a session, or about a person
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] BodyParts split_body(EventKind kind, const std::string& body);
/// The whole body again, as `split_body` got it.
/// \throws StoreError if a part is not a JSON object
[[nodiscard]] std::string joined_body(const BodyParts& parts);

/// The sealed parts of all events are padded to a multiple of this many bytes.
inline constexpr std::size_t kSealedUnit = 32;
/// The padding of the sealed part of an event, bytes: a multiple of kSealedUnit that follows from
/// the kind alone. What an answer or a time is made of fits in it once, so that sizes tell nothing.
[[nodiscard]] std::size_t sealed_padding(EventKind kind);

}  // namespace touchtrial::record
