/// \file A station's file chain in the pieces in which it is pushed.
#pragma once

#include "protocols/store/event.hpp"
#include "protocols/store/payload_json.hpp"
#include "protocols/store/study_store.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// What the file chain says of one session, and at which of its events.
struct SessionCourse {
  store::SessionOpenedBody opened;
  store::SessionClosedBody end;  ///< only if closed_at
  std::optional<std::int64_t> closed_at;
  std::optional<std::int64_t> excluded_at;
  std::optional<std::int64_t> withdrawn_at;
  std::optional<std::int64_t> replaced_at;
  std::string replaced_by;
};

/// Whether something is decided about a session, after its end, among these events of the chain.
/// \param first,end  sequences, the end not among them
[[nodiscard]] bool is_decided_between(const SessionCourse& course, std::int64_t first,
                                      std::int64_t end) noexcept;

/// Whether it was replaced or withdrawn and has not ended: it cannot go on any more.
[[nodiscard]] bool is_cut_short(const SessionCourse& course) noexcept;

/// By own number. \throws EventFault if a body is no such, or names a session that was not opened
[[nodiscard]] std::map<int, SessionCourse> courses_of(std::span<const store::Event> file_chain);

/// A piece of a file chain that is pushed in one transaction, with the sessions that it closes.
struct ChainSegment {
  std::int64_t first = 0;  ///< sequence
  std::int64_t end = 0;    ///< after the last
  std::vector<int> sessions;

  friend bool operator==(const ChainSegment&, const ChainSegment&) = default;
};

/// Cuts what lies from `first` on. Each segment closes one session, and goes up to before the next
/// closing; further if a session's key is gone, because the withdrawal must come with it, or if
/// somebody else took its place, because until then it stands in that one's way. So wherever
/// pushing breaks off, what is on the server holds by itself.
/// \param has_key  whether a session's wrapped key is still in the file
[[nodiscard]] std::vector<ChainSegment> segments_of(std::span<const store::Event> file_chain,
                                                    std::int64_t first,
                                                    const std::function<bool(int)>& has_key);

}  // namespace touchtrial::collect
