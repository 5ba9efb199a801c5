#include "protocols/collect/station_course.hpp"

#include "protocols/store/event_fault.hpp"

#include <algorithm>

namespace touchtrial::collect {
namespace {

/// The session that an event on the file chain is about, if it is one that changes a session.
SessionCourse& course(std::map<int, SessionCourse>& courses, const store::Event& event,
                      int session) {
  const auto found = courses.find(session);
  if (found != courses.end()) return found->second;
  throw store::EventFault(event.session, event.sequence,
                          "session " + std::to_string(session) + " has not been opened");
}

void add(std::map<int, SessionCourse>& courses, const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::session_opened: {
      const store::SessionOpenedBody body = store::body_of(event, store::session_opened_from_json);
      courses[body.session].opened = body;
      return;
    }
    case store::EventKind::session_closed: {
      const store::SessionClosedBody body = store::body_of(event, store::session_closed_from_json);
      SessionCourse& session = course(courses, event, body.session);
      session.end = body;
      session.closed_at = event.sequence;
      return;
    }
    case store::EventKind::participant_excluded: {
      const store::ParticipantBody body = store::body_of(event, store::participant_from_json);
      course(courses, event, body.session).excluded_at = event.sequence;
      return;
    }
    case store::EventKind::participant_withdrawn: {
      const store::ParticipantBody body = store::body_of(event, store::participant_from_json);
      course(courses, event, body.session).withdrawn_at = event.sequence;
      return;
    }
    case store::EventKind::participant_replaced: {
      const store::ReplacementBody body = store::body_of(event, store::replacement_from_json);
      SessionCourse& session = course(courses, event, body.session);
      session.replaced_at = event.sequence;
      session.replaced_by = body.by;
      return;
    }
    default:
      return;
  }
}

/// Where a segment must at least end if it closes this session.
std::int64_t needed_end(const SessionCourse& session, bool has_key) {
  std::int64_t last = *session.closed_at;
  if (!has_key && session.withdrawn_at) last = std::max(last, *session.withdrawn_at);
  if (session.replaced_at) last = std::max(last, *session.replaced_at);
  return last + 1;
}

}  // namespace

bool is_decided_between(const SessionCourse& course, std::int64_t first,
                        std::int64_t end) noexcept {
  const auto lies = [&](const std::optional<std::int64_t>& at) {
    return at && *at >= first && *at < end;
  };
  return lies(course.excluded_at) || lies(course.withdrawn_at) || lies(course.replaced_at);
}

bool is_cut_short(const SessionCourse& course) noexcept {
  return !course.closed_at && (course.replaced_at || course.withdrawn_at);
}

std::map<int, SessionCourse> courses_of(std::span<const store::Event> file_chain) {
  std::map<int, SessionCourse> courses;
  for (const store::Event& event : file_chain) add(courses, event);
  return courses;
}

std::vector<ChainSegment> segments_of(std::span<const store::Event> file_chain, std::int64_t first,
                                      const std::function<bool(int)>& has_key) {
  const std::map<int, SessionCourse> courses = courses_of(file_chain);
  std::map<std::int64_t, int> closings;
  for (const auto& [number, session] : courses) {
    if (session.closed_at && *session.closed_at >= first) closings[*session.closed_at] = number;
  }
  const auto length = static_cast<std::int64_t>(file_chain.size());
  std::vector<ChainSegment> segments;
  auto closing = closings.begin();
  while (first < length) {
    ChainSegment segment{.first = first, .end = 0, .sessions = {}};
    // The first closing, and every other that comes before what these need.
    for (; closing != closings.end() && (segment.end == 0 || closing->first < segment.end);
         ++closing) {
      const SessionCourse& session = courses.at(closing->second);
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
