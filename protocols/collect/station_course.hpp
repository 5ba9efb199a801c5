/// \file A station's file chain in the pieces in which it is pushed. Private to protocols/collect.
#pragma once

#include "protocols/store/file_chain.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace touchtrial::collect {

/// Sessions by their own numbers.
using Courses = std::map<int, store::SessionOnFile>;

/// Whether an exclusion, withdrawal or replacement of the session stands among these events.
/// \param first, end  sequences on the file's chain, from `first` up to before `end`
[[nodiscard]] bool is_decided_between(const store::SessionOnFile& course, std::int64_t first,
                                      std::int64_t end) noexcept;

/// What the chain up to before `end` says of a session.
[[nodiscard]] store::SessionOnFile course_until(store::SessionOnFile course, std::int64_t end);

/// A piece of a file chain that is pushed in one transaction, with the sessions that it closes.
struct ChainSegment {
  std::int64_t first = 0;  ///< sequence
  std::int64_t end = 0;    ///< after the last
  std::vector<int> sessions;

  friend bool operator==(const ChainSegment&, const ChainSegment&) = default;
};

/// Cuts a file chain from `first` on. Each segment closes one session and ends before the next
/// closing. It goes further if the session's key is gone, so that the withdrawal comes with it, and
/// if the session was replaced, since until then it blocks its successor. So wherever pushing
/// breaks off, the server's content holds by itself.
/// \param courses  what the chain says of its sessions
/// \param length  of the chain
/// \param has_key  whether a session's wrapped key is still in the file
[[nodiscard]] std::vector<ChainSegment> segments_of(const Courses& courses, std::int64_t length,
                                                    std::int64_t first,
                                                    const std::function<bool(int)>& has_key);

}  // namespace touchtrial::collect
