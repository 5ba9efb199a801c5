/// \file Faults of a database: an impossible event or row, an incomplete file.
#pragma once

#include "core/errors.hpp"
#include "record/event.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace touchtrial::record {

/// A Touchtrial database that is truncated, lacks tables, has unreadable pages, or contains altered
/// evidence. A mistyped name is not a DamagedStore.
class DamagedStore : public StoreError {
 public:
  using StoreError::StoreError;
};

/// Another program has the database locked. Nothing was changed; the same call may succeed later.
class LockedStore : public StoreError {
 public:
  using StoreError::StoreError;
};

/// The sequence number of a fault that is not in an event.
inline constexpr std::int64_t kNoEvent = -1;

/// \param session  as Event::session
[[nodiscard]] inline std::string chain_name(std::int64_t session) {
  if (session == 0) return "the file's chain";
  if (session < 0) return "the chain of station " + std::to_string(-session);
  return "session " + std::to_string(session);
}

/// An impossible event or row, and its place. Thrown where events and rows are read; Database::run
/// adds file and remedy, StudyStore::first_fault turns it into a ChainFault.
class EventFault : public StoreError {
 public:
  EventFault(std::int64_t session, std::int64_t sequence, const std::string& what)
      : StoreError(chain_name(session) +
                   (sequence < 0 ? "" : ", event " + std::to_string(sequence)) + ": " +
                   one_line(what)),
        session_(session),
        sequence_(sequence),
        what_(one_line(what)) {}
  EventFault(const Event& event, const std::string& what)
      : EventFault(event.session, event.sequence, what) {}

  [[nodiscard]] std::int64_t session() const noexcept { return session_; }
  [[nodiscard]] std::int64_t sequence() const noexcept { return sequence_; }
  /// The fault, without the place.
  [[nodiscard]] const std::string& description() const noexcept { return what_; }

 private:
  std::int64_t session_;
  std::int64_t sequence_;
  std::string what_;
};

/// `parse(event.body)`.
/// \throws EventFault, naming the event, if `parse` throws StoreError
template <typename Parse>
[[nodiscard]] auto body_of(const Event& event, Parse parse) {
  try {
    return parse(event.body);
  } catch (const StoreError& error) {
    throw EventFault(event, error.what());
  }
}

/// A hash from a row of events.
/// \throws EventFault if it is not 32 bytes long
[[nodiscard]] inline Digest stored_hash(ByteView bytes, std::int64_t session,
                                        std::int64_t sequence) {
  Digest digest{};
  if (bytes.size() != digest.size()) {
    throw EventFault(session, sequence, "a hash of the event is not 32 bytes long");
  }
  std::copy(bytes.begin(), bytes.end(), digest.begin());
  return digest;
}

/// The kind of an event from its name in a row of events.
/// \throws EventFault if no kind has this name
[[nodiscard]] inline EventKind stored_kind(const std::string& name, std::int64_t session,
                                           std::int64_t sequence) {
  const std::optional<EventKind> kind = event_kind_from_name(name);
  if (!kind) throw EventFault(session, sequence, "unknown kind of event '" + name + "'");
  return *kind;
}

}  // namespace touchtrial::record
