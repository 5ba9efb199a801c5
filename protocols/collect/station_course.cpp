#include "protocols/collect/station_course.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace touchtrial::collect {
namespace {

/// The least end of a segment that closes this session.
std::int64_t needed_end(const store::SessionOnFile& session, bool has_key) {
  std::int64_t last = *session.closed_at;
  if (!has_key && session.erased_at) last = std::max(last, *session.erased_at);
  if (!has_key && session.safety_erased_at) last = std::max(last, *session.safety_erased_at);
  if (session.replaced_at) last = std::max(last, *session.replaced_at);
  return last + 1;
}

}  // namespace

bool is_decided_between(const store::SessionOnFile& course, std::int64_t first,
                        std::int64_t end) noexcept {
  const auto lies = [&](const std::optional<std::int64_t>& at) {
    return at && *at >= first && *at < end;
  };
  return lies(course.excluded_at) || lies(course.withdrawn_at) || lies(course.replaced_at);
}

store::SessionOnFile course_until(store::SessionOnFile course, std::int64_t end) {
  for (std::optional<std::int64_t>* at :
       {&course.excluded_at, &course.withdrawn_at, &course.erased_at, &course.safety_erased_at,
        &course.replaced_at}) {
    if (*at && **at >= end) at->reset();
  }
  if (!course.replaced_at) course.replaced_by.clear();
  return course;
}

std::vector<ChainSegment> segments_of(const Courses& courses, std::int64_t length,
                                      std::int64_t first, const std::function<bool(int)>& has_key) {
  std::map<std::int64_t, int> closings;
  for (const auto& [number, session] : courses) {
    if (session.closed_at && *session.closed_at >= first) closings[*session.closed_at] = number;
  }
  std::vector<ChainSegment> segments;
  auto closing = closings.begin();
  while (first < length) {
    ChainSegment segment{.first = first, .end = 0, .sessions = {}};
    // The first closing, and every other before the end that these sessions need.
    for (; closing != closings.end() && (segment.end == 0 || closing->first < segment.end);
         ++closing) {
      const store::SessionOnFile& session = courses.at(closing->second);
      segment.sessions.push_back(closing->second);
      segment.end = std::max(segment.end, needed_end(session, has_key(closing->second)));
    }
    segment.end = closing == closings.end() ? length : closing->first;
    first = segment.end;
    segments.push_back(std::move(segment));
  }
  return segments;
}

}  // namespace touchtrial::collect
