/// \file Something in the database that cannot be believed, and where it is.
#pragma once

#include "core/errors.hpp"
#include "protocols/store/event.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::store {

/// In place of a sequence number: the fault is not in an event.
inline constexpr std::int64_t kNoEvent = -1;

/// \param session  as Event::session
[[nodiscard]] inline std::string chain_named(std::int64_t session) {
  if (session == 0) return "the file's chain";
  if (session < 0) return "the chain of station " + std::to_string(-session);
  return "session " + std::to_string(session);
}

/// Thrown where events and rows are read or understood; Database::run adds file and remedy,
/// StudyStore::first_fault turns it into a ChainFault.
class EventFault : public StoreError {
 public:
  EventFault(std::int64_t session, std::int64_t sequence, const std::string& what)
      : StoreError(chain_named(session) +
                   (sequence < 0 ? "" : ", event " + std::to_string(sequence)) + ": " +
                   one_line(what)),
        session_(session),
        sequence_(sequence),
        what_(one_line(what)) {}

  [[nodiscard]] std::int64_t session() const noexcept { return session_; }
  [[nodiscard]] std::int64_t sequence() const noexcept { return sequence_; }
  /// What does not hold, without the place.
  [[nodiscard]] const std::string& bare() const noexcept { return what_; }

 private:
  std::int64_t session_;
  std::int64_t sequence_;
  std::string what_;
};

/// `parse(event.body)`, with any complaint about the body tied to the event.
template <typename Parse>
[[nodiscard]] auto body_of(const Event& event, Parse parse) {
  try {
    return parse(event.body);
  } catch (const StoreError& error) {
    throw EventFault(event.session, event.sequence, error.what());
  }
}

}  // namespace touchtrial::store
