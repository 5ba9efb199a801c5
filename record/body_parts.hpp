/// \file Which members of an event's body are public, and which are sealed with the event's time.
///   Source: docs/data-dictionary.md, "Events".
#pragma once

#include "record/event_kinds.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::record {

/// A body in two parts, each a compact JSON object with sorted keys.
struct BodyParts {
  std::string clear;
  std::string hidden;  ///< empty if every member is in clear
};

/// \param body  the whole body of an event of a session, or of one about a person
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] BodyParts split_body(EventKind kind, const std::string& body);
/// The whole body, as passed to `split_body`.
/// \throws StoreError if a part is not a JSON object
[[nodiscard]] std::string joined_body(const BodyParts& parts);

/// The padding of the sealed part of an event, bytes: a multiple of kSealedUnit that depends only
/// on the kind.
[[nodiscard]] std::size_t sealed_padding(EventKind kind);

}  // namespace touchtrial::record
