#include "protocols/collect/station_course.hpp"

#include "protocols/store/payload_json.hpp"
#include "protocols/store/store_fixture.hpp"
#include "support/catch.hpp"

#include <set>

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

/// A station's file chain.
class Chain {
 public:
  Chain() { add(EventKind::study_committed, to_json(commitment())); }
  Chain& opened(int session) {
    return add(EventKind::session_opened,
               to_json(SessionOpenedBody{.session = session,
                                         .participant = participant_of(session),
                                         .enrolment = session,
                                         .first = digest_of("first"),
                                         .key = digest_of("key")}));
  }
  Chain& closed(int session) {
    return add(EventKind::session_closed,
               to_json(SessionClosedBody{
                   .session = session, .length = 3, .head = digest_of("head"), .complete = true}));
  }
  Chain& withdrawn(int session) {
    return add(EventKind::participant_withdrawn,
               to_json(WithdrawalBody{
                   .session = session, .kept = Kept::safety_record, .reason = "asked"}));
  }
  Chain& replaced(int session, const std::string& by) {
    return add(EventKind::participant_replaced,
               to_json(ReplacementBody{.session = session, .by = by, .reason = "ill"}));
  }
  Chain& add(EventKind kind, const std::string& body) {
    events.push_back(next_on_file(events.empty() ? nullptr : &events.back(), kind, kUtc, body));
    return *this;
  }

  std::vector<Event> events;
};

using Segments = std::vector<ChainSegment>;

Courses courses_of(const Chain& chain) {
  FileChain file;
  for (const Event& event : chain.events) file.add(event);
  return file.sessions();
}

Segments cut(const Chain& chain, std::int64_t first = 0, const std::set<int>& without_key = {}) {
  return segments_of(courses_of(chain), static_cast<std::int64_t>(chain.events.size()), first,
                     [&](int session) { return !without_key.contains(session); });
}

}  // namespace

TEST_CASE("each session is pushed with what comes before the next one's end") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).closed(2).add(EventKind::study_closed, "{}");
  CHECK(cut(chain) == Segments{{0, 4, {1}}, {4, 6, {2}}});
}

TEST_CASE("pushing goes on where it was broken off") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).closed(2);
  CHECK(cut(chain, 4) == Segments{{4, 5, {2}}});
  CHECK(cut(chain, 5).empty());
}

TEST_CASE("a tail without an end of a session is pushed too") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).withdrawn(1);
  CHECK(cut(chain, 3) == Segments{{3, 5, {}}});
}

TEST_CASE("a session whose key is gone comes with its withdrawal, and with those between") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).closed(2).withdrawn(1).opened(3).closed(3);
  CHECK(cut(chain, 0, {1}) == Segments{{0, 7, {1, 2}}, {7, 8, {3}}});
  CHECK(cut(chain, 0) == Segments{{0, 4, {1}}, {4, 7, {2}}, {7, 8, {3}}});
}

TEST_CASE("a session that was replaced comes with its replacement") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).closed(2).replaced(1, "P9").opened(3).closed(3);
  CHECK(cut(chain) == Segments{{0, 7, {1, 2}}, {7, 8, {3}}});
}

TEST_CASE("a session that is still open is in no segment") {
  Chain chain;
  chain.opened(1).opened(2).closed(2);
  CHECK(cut(chain) == Segments{{0, 4, {2}}});
  CHECK_FALSE(courses_of(chain).at(1).closed_at);
  CHECK(courses_of(chain).at(2).closed_at == 3);
}

TEST_CASE("a decision about a session is found among the events of its chain") {
  Chain chain;
  chain.opened(1).closed(1).opened(2).closed(2).withdrawn(1).replaced(2, "P9");
  const Courses courses = courses_of(chain);
  CHECK(is_decided_between(courses.at(1), 5, 6));
  CHECK(is_decided_between(courses.at(1), 0, 7));
  CHECK_FALSE(is_decided_between(courses.at(1), 0, 5));
  CHECK_FALSE(is_decided_between(courses.at(1), 6, 7));
  CHECK(is_decided_between(courses.at(2), 6, 7));
  CHECK_FALSE(is_decided_between(courses.at(2), 0, 6));
}

TEST_CASE("a chain with events of sessions that were not opened is refused") {
  Chain chain;
  chain.opened(1).closed(2);
  CHECK_THAT(refusal_of([&] { static_cast<void>(courses_of(chain)); }),
             holds_text("session 2 has not been opened"));
}
