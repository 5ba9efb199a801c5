/// \file Splits an event's body into its public members and the members that are sealed together
///   with the event's time. Source: docs/data-dictionary.md, "Events".
#pragma once

#include "record/event_kinds.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::record {

/// A body in two parts, each a compact JSON object with sorted keys.
struct BodyParts {
  std::string clear;
  std::string hidden;  ///< empty if no member is encrypted
};

/// \param body  the complete body of a session's event, or of one about a person
/// \throws StoreError if the body is not a JSON object
[[nodiscard]] BodyParts split_body(EventKind kind, const std::string& body);
/// The complete body, as passed to `split_body`.
/// \throws StoreError if a part is not a JSON object
[[nodiscard]] std::string join_body(const BodyParts& parts);

/// The padding of the sealed part of an event, bytes: a multiple of kSealedUnit that depends only
/// on the kind.
[[nodiscard]] std::size_t sealed_padding(EventKind kind);

}  // namespace touchtrial::record
