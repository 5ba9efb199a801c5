// Pushing into a real server, undisturbed.
#include "protocols/collect/station_push.hpp"

#include "protocols/collect/server/server_fixture.hpp"
#include "support/catch.hpp"

#include <thread>

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

TEST_CASE("a station's finished sessions come to the server whole, and come once") {
  const ServerFixture there;
  StoredFixture study(3);
  const PushReport first = there.push(*study.store);
  CHECK(first.pushed == std::vector<PushedSession>{{1, "P1", 1}, {2, "P2", 2}, {3, "P3", 3}});
  CHECK(first.station == 1);
  CHECK(first.already_there == 0);
  CHECK(first.chain_events == 7);
  const std::string counts = there.counts();
  CHECK(there.first("SELECT count(*) FROM events WHERE session = -1") == "7");
  CHECK(there.first("SELECT count(*) FROM traces") == "9");
  CHECK(there.first("SELECT count(*) FROM participant_keys") == "3");

  const PushReport again = there.push(*study.store);
  CHECK(again.pushed.empty());
  CHECK(again.already_there == 3);
  CHECK(again.chain_events == 0);
  CHECK(there.counts() == counts);

  add(*study.store, 4);
  const PushReport more = there.push(*study.store);
  CHECK(more.pushed == std::vector<PushedSession>{{4, "P4", 4}});
  CHECK(more.already_there == 3);
}

TEST_CASE("derived rows on the server are those of the station") {
  const ServerFixture there;
  StoredFixture study(2);
  there.push(*study.store);
  CHECK(there.ask("SELECT participant || ' ' || enrolment || ' ' || state || ' ' || simulated || "
                  "pilot || excluded || withdrawn || ' ' || device || ' ' || own_session || ' ' || "
                  "station FROM sessions ORDER BY session") ==
        std::vector<std::string>{"P1 1 completed 1000 simulated 1 1",
                                 "P2 2 completed 1000 simulated 2 1"});
  CHECK(there.ask("SELECT trial || ' ' || block || ' ' || state || ' ' || valid || ' ' || overruns "
                  "|| ' ' || contact_ok || path_ok || force_ok || speed_ok || ' ' || rate_hz || ' "
                  "' || explorations FROM trials "
                  "WHERE session = 1 ORDER BY trial") ==
        std::vector<std::string>{"1 0 answered 1 1 1111 999.75 1", "2 0 answered 1 2 1111 999.75 1",
                                 "3 1 timed-out 0 3 1111 999.75 1"});
}

TEST_CASE("events and traces are append-only on the server too") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  for (const char* const sql :
       {"UPDATE events SET body = '{}'", "DELETE FROM events", "TRUNCATE events",
        "UPDATE traces SET trial = 9", "DELETE FROM traces", "TRUNCATE traces"}) {
    INFO(sql);
    CHECK_THROWS_WITH(there.ask(sql), holds_text("append-only"));
  }
}

TEST_CASE("an open session is left for later and named") {
  const ServerFixture there;
  StoredFixture study(1);
  const auto sink = study.store->begin_session(2, wrapped_key_of(2));
  SessionRecorder recorder(2, participant_key(2), *sink);
  recorder.opened(nanoseconds(0), opening(2), "{}");
  const PushReport before = there.push(*study.store);
  CHECK(before.pushed == std::vector<PushedSession>{{1, "P1", 1}});
  CHECK(before.left_open == std::vector<PushedSession>{{2, "P2", 2}});
  recorder.closed(seconds(5), false);
  const PushReport after = there.push(*study.store);
  CHECK(after.pushed == std::vector<PushedSession>{{2, "P2", 2}});
  CHECK(after.left_open.empty());
  CHECK(there.first("SELECT state FROM sessions WHERE own_session = 2") == "stopped");
}

TEST_CASE("a session that was replaced before it ended is not announced for later") {
  const ServerFixture there;
  StoredFixture study(1);
  const auto sink = study.store->begin_session(2, wrapped_key_of(2));
  SessionRecorder recorder(2, participant_key(2), *sink);
  recorder.opened(nanoseconds(0), opening(2), "{}");
  study.store->exclude(2, kUtc, "the program crashed");
  study.store->replace(2, "P9", kUtc, "excluded");
  const PushReport report = there.push(*study.store);
  CHECK(report.left_open.empty());
  CHECK(report.cut_short == std::vector<PushedSession>{{2, "P2", 2}});
  CHECK(there.first("SELECT count(*) FROM sessions") == "1");
}

TEST_CASE("of many sessions in one transaction, no more than two are read before they are sent") {
  const ServerFixture there;
  StoredFixture empty;
  there.push(*empty.store);
  const int sessions = 8;
  for (int session = 1; session <= sessions; ++session) add(*empty.store, session);
  empty.store->withdraw(1, kUtc, "asked");  // its key is gone: the withdrawal comes with it
  OpenStation station(*empty.store);
  // What a transaction has added takes room before anybody sees it.
  std::vector<std::int64_t> bytes_there;
  std::int64_t bytes_of_session = 0;
  station.alter_trace = [&](int, const Bytes& box) {
    bytes_of_session += static_cast<std::int64_t>(box.size());
  };
  station.before_trace = [&](int, int trial) {
    if (trial != 1) return;
    bytes_there.push_back(std::stoll(there.first("SELECT pg_total_relation_size('traces')")));
  };
  CHECK(there.push(station).pushed.size() == sessions);
  bytes_of_session /= sessions;
  REQUIRE(bytes_there.size() == sessions);
  REQUIRE(bytes_of_session > 0);
  for (int session = 3; session <= sessions; ++session) {
    CHECK(bytes_there[static_cast<std::size_t>(session) - 1] >= (session - 2) * bytes_of_session);
  }
}

TEST_CASE("decisions at the station follow with the next push") {
  const ServerFixture there;
  StoredFixture study(3);
  there.push(*study.store);
  study.store->exclude(1, kUtc, "slept");
  study.store->replace(1, "P9", kUtc, "slept");
  study.store->withdraw(2, kUtc, "asked");
  study.store->note(3, kUtc, "", "sneezed");
  study.store->close_study(kUtc);
  const PushReport report = there.push(*study.store);
  CHECK(report.pushed.empty());
  CHECK(report.chain_events == 5);
  CHECK(there.ask("SELECT excluded || ' ' || withdrawn || ' ' || coalesce(replaced_by, '-') FROM "
                  "sessions ORDER BY session") ==
        std::vector<std::string>{"1 0 P9", "0 1 -", "0 0 -"});
  CHECK(there.ask("SELECT session FROM participant_keys ORDER BY session") ==
        std::vector<std::string>{"1", "3"});
}

TEST_CASE("sessions that were withdrawn or replaced before the first push arrive as they are") {
  const ServerFixture there;
  StoredFixture study(2);
  study.store->withdraw(1, kUtc, "asked");
  study.store->replace(1, "P3", kUtc, "asked");
  SessionOpening how = opening(3);
  how.enrolment = 1;
  study.store->add_session(session_of(3, 2, stroking(20, 0.05), how), wrapped_key_of(3), kUtc);
  CHECK(there.push(*study.store).pushed.size() == 3);
  CHECK(there.ask("SELECT participant || ' ' || enrolment FROM sessions WHERE replaced_by IS NULL "
                  "ORDER BY session") == std::vector<std::string>{"P2 2", "P3 1"});
  CHECK(there.first("SELECT count(*) FROM participant_keys") == "2");
}

TEST_CASE("a file without a session only makes the tables") {
  const ServerFixture there;
  StoredFixture study;
  CHECK(there.push(*study.store).station == 0);
  CHECK(there.first("SELECT count(*) FROM stations") == "0");
  CHECK(there.first("SELECT version FROM touchtrial_schema") == "6");
}

TEST_CASE("a dry run says what would be pushed and changes nothing") {
  const ServerFixture there;
  StoredFixture study(2);
  const PushOptions dry{.dry_run = true};
  CHECK(there.push(*study.store, dry).pushed.size() == 2);
  CHECK(there.first("SELECT count(*) FROM pg_tables WHERE schemaname = 'public'") == "0");
  there.push(*study.store);
  add(*study.store, 3);
  const std::string counts = there.counts();
  const PushReport report = there.push(*study.store, dry);
  CHECK(report.pushed == std::vector<PushedSession>{{3, "P3", 3}});
  CHECK(report.already_there == 2);
  CHECK(there.counts() == counts);
}

TEST_CASE("with the study's key the sealed ends of sessions are opened on arrival") {
  const ServerFixture there;
  StoredFixture study(2);
  CHECK_THAT(refusal_of([&] {
               there.push(*study.store,
                          {.investigator = box_keys(digest_of("another study's key"))});
             }),
             holds_text("session 1 did not arrive whole: its key does not open"));
  CHECK(there.first("SELECT count(*) FROM sessions") == "0");
  CHECK(there.push(*study.store, {.investigator = box_keys(study_master())}).pushed.size() == 2);
}

TEST_CASE("progress counts the sessions that are to be pushed") {
  const ServerFixture there;
  StoredFixture study(3);
  std::vector<std::pair<int, int>> calls;
  there.push(*study.store, {.progress = [&](int done, int of) { calls.emplace_back(done, of); }});
  CHECK(calls == std::vector<std::pair<int, int>>{{1, 3}, {2, 3}, {3, 3}});
}

TEST_CASE("the server lists all sessions of all stations for their balance") {
  const ServerFixture there;
  StoredFixture first(2);
  StoredFixture second;
  add_visit(*second.store, {1, "Q1", 3});
  second.store->exclude(1, kUtc, "slept");
  there.push(*first.store);
  there.push(*second.store);
  const std::vector<EnrolledSession> sessions = sessions_on_server(there.address());
  REQUIRE(sessions.size() == 3);
  CHECK(sessions[0].station == 1);
  CHECK(sessions[0].counts);
  CHECK(sessions[2].station == 2);
  CHECK(sessions[2].enrolment == 3);
  CHECK(sessions[2].state == SessionState::completed);
  CHECK_FALSE(sessions[2].counts);
}
