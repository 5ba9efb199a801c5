#include "record/event.hpp"

#include "support/catch.hpp"
#include "support/names.hpp"

#include <functional>
#include <set>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::record;

namespace {

Event an_event() {
  Event event{.session = 2,
              .sequence = 0,
              .kind = EventKind::presented,
              .at = std::chrono::nanoseconds(12345),
              .body = R"({"block":0,"trial":1})",
              .sealed = {1, 2, 3},
              .previous = {},
              .hash = {}};
  event.hash = event_hash(event);
  return event;
}

}  // namespace

TEST_CASE("every kind of event has a name of its own that reads back") {
  std::set<std::string_view> names;
  for (int k = 0; k <= static_cast<int>(EventKind::closed); ++k) {
    const auto kind = static_cast<EventKind>(k);
    REQUIRE(event_kind_from_name(name_of(kind)) == kind);
    REQUIRE(names.insert(name_of(kind)).second);
  }
  REQUIRE(name_of(EventKind::first_contact) == "first-contact");
  REQUIRE_FALSE(event_kind_from_name("first_contact"));
  REQUIRE_FALSE(event_kind_from_name(""));
}

TEST_CASE("the hash of an event is BLAKE2b over its length-prefixed members") {
  const Event event = an_event();
  const Digest expected = FieldHasher(HashFunction::blake2b)
                              .add(std::int64_t{2})
                              .add(std::int64_t{0})
                              .add("presented")
                              .add(std::int64_t{12345})
                              .add(event.body)
                              .add(event.sealed)
                              .add(event.previous)
                              .finish();
  REQUIRE(event_hash(event) == expected);
}

TEST_CASE("the hash of an event changes with each of its members") {
  const std::vector<std::function<void(Event&)>> changes = {
      [](Event& e) { e.session = 3; },
      [](Event& e) { e.sequence = 1; },
      [](Event& e) { e.kind = EventKind::timed_out; },
      [](Event& e) { e.at += std::chrono::nanoseconds(1); },
      [](Event& e) { e.body += ' '; },
      [](Event& e) { e.sealed.push_back(0); },
      [](Event& e) { e.previous[31] = 1; },
  };
  for (const auto& change : changes) {
    Event event = an_event();
    change(event);
    REQUIRE(event_hash(event) != an_event().hash);
  }
  Event rehashed = an_event();
  rehashed.hash = {};
  REQUIRE(event_hash(rehashed) == an_event().hash);
}

TEST_CASE("a chain accepts events that follow and gives the reason for refusing others") {
  ChainLink chain(2);
  Event first = an_event();
  REQUIRE(names(chain.link_fault(first).value(), "[time-in-clear]"));
  first.at = {};
  first.hash = event_hash(first);
  REQUIRE_FALSE(chain.link_fault(first));
  chain.extend(first);
  REQUIRE(chain.length() == 1);
  REQUIRE(chain.head() == first.hash);

  Event second = first;
  REQUIRE(names(chain.link_fault(second).value(), "[repeated-sequence]"));
  second.sequence = 2;
  REQUIRE(names(chain.link_fault(second).value(), "1 [sequence-gap]"));
  second.sequence = 1;
  REQUIRE(names(chain.link_fault(second).value(), "[broken-link]"));
  second.previous = first.hash;
  REQUIRE(names(chain.link_fault(second).value(), "[altered-event]"));
  second.kind = EventKind::study_closed;
  second.hash = event_hash(second);
  REQUIRE(names(chain.link_fault(second).value(), "study-closed"));
  second.kind = EventKind::timed_out;
  second.hash = event_hash(second);
  REQUIRE_FALSE(chain.link_fault(second));
}
