/// \file Opened events whose bodies stay in two parts. Reading a study's answers opens every event,
///   and joining all bodies would take time without need.
#pragma once

#include "core/cipher.hpp"
#include "record/body_parts.hpp"
#include "record/fold.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace touchtrial::record {

/// The sealed part of a session's event.
struct OpenedParts {
  std::chrono::nanoseconds at{};
  BodyParts body;
  std::string secret;  ///< as OpenedEvent::secret
};

/// Opens the events of one session.
class EventOpener {
 public:
  explicit EventOpener(const SecretKey& participant_key);

  /// \param event  a stored event of the session
  /// \return nothing if the key is wrong, or the event was altered
  [[nodiscard]] std::optional<OpenedParts> operator()(const Event& event) const;

 private:
  Unsealer participant_;
  Unsealer safety_;
};

/// Does what `fold` does, with an event that was opened. The body of a trace-stored event can be
/// read with from_parts.
/// \param event  with its time and nothing sealed; its body is ignored
/// \throws as fold
void fold(DerivedRows& rows, const Event& event, const BodyParts& body);

}  // namespace touchtrial::record
