#include "record/study_store.hpp"

#include "record/payload_json.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <fstream>
#include <sstream>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void require_refused(StoredFixture& study, const BufferedEvents& session,
                     const std::string& words = "") {
  const std::size_t before = study.store->events(0).size();
  const std::string line =
      refusal_of([&] { study.store->add_session(session, wrapped_key_of(1), kUtc); });
  REQUIRE(names_in_order(line, study.path.string() + " " + words));
  REQUIRE(study.store->events(0).size() == before);
  REQUIRE_FALSE(study.store->first_fault());
}

}  // namespace

TEST_CASE("a new database holds its commitment and nothing else") {
  StoredFixture study;
  REQUIRE(study.store->commitment() == commitment());
  REQUIRE(study.store->sessions().empty());
  REQUIRE(study.store->trials().empty());
  REQUIRE(study.store->next_session() == 1);
  REQUIRE_FALSE(study.store->state().closed);
  REQUIRE_FALSE(study.store->state().unblinded);
  const auto chain = study.store->events(0);
  REQUIRE(chain.size() == 1);
  REQUIRE(chain[0].kind == EventKind::study_committed);
  REQUIRE(chain[0].at == kUtc);
  REQUIRE(chain[0].previous == Digest{});
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("an added session is there after the database is opened again") {
  StoredFixture study(2);
  const BufferedEvents second = session_of(2);
  study.store.reset();
  const StudyStore store = StudyStore::open(study.path, StudyStore::Access::read_only);
  REQUIRE(store.commitment() == commitment());
  const auto stored = store.events(2);
  REQUIRE(stored.size() == second.events.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    REQUIRE(stored[i].hash == second.events[i].hash);
    REQUIRE(event_hash(stored[i]) == second.events[i].hash);
  }
  REQUIRE(store.sealed_trace(2, 3) == second.traces[2]);
  REQUIRE_FALSE(store.sealed_trace(2, 4));
  REQUIRE(store.wrapped_key(2) == wrapped_key_of(2).participant);
  REQUIRE_FALSE(store.wrapped_key(3));
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("sessions and trials are derived from the events") {
  StoredFixture study(2);
  const auto sessions = study.store->sessions();
  REQUIRE(sessions.size() == 2);
  REQUIRE(sessions[1] == SessionRow{.session = 2,
                                    .participant = "P2",
                                    .enrolment = 2,
                                    .state = SessionState::completed,
                                    .simulated = true,
                                    .pilot = false,
                                    .excluded = false,
                                    .withdrawn = false,
                                    .device = "simulated",
                                    .replaced_by = {},
                                    .own_session = 2,
                                    .station = 0});
  const auto trials = study.store->trials();
  REQUIRE(trials.size() == 6);
  const TrialRow second{.session = 1,
                        .trial = 2,
                        .block = 0,
                        .state = TrialState::answered,
                        .valid = true,
                        .hand = {},
                        .overruns = 2,
                        .rate_hz = 999.75,
                        .explorations = 1,
                        .presented_at = {},
                        .contact_at = {},
                        .answered_at = {},
                        .answer = {},
                        .confidence = {},
                        .kind = {},
                        .track = {},
                        .level = {},
                        .target = {},
                        .samples = 0};
  REQUIRE(trials[1] == second);
  TrialRow opened = second;
  opened.presented_at = seconds(40);
  opened.contact_at = seconds(40) + milliseconds(350);
  opened.answered_at = seconds(49);
  opened.answer = ChoiceAnswer{2, 4};
  opened.confidence = 3;
  opened.samples = 20;
  REQUIRE(opened_trials(*study.store, 1)[1] == opened);
  const TrialRow& last = trials[5];
  REQUIRE(last.session == 2);
  REQUIRE(last.trial == 3);
  REQUIRE(last.block == 1);
  REQUIRE(last.state == TrialState::timed_out);
  REQUIRE_FALSE(last.valid);
  REQUIRE_FALSE(position_of(opened_trials(*study.store, 2)[2].answer));
}

TEST_CASE("events of one kind are visited by session and sequence") {
  StoredFixture study(2);
  std::vector<std::pair<int, std::int64_t>> visited;
  study.store->for_each(EventKind::trace_stored, [&](const Event& event) {
    visited.emplace_back(event.session, event.sequence);
    REQUIRE(study.store->wrapped_key(event.session));  // other queries may run meanwhile
  });
  REQUIRE(visited.size() == 6);
  REQUIRE(std::is_sorted(visited.begin(), visited.end()));
}

TEST_CASE("the file's chain commits to key, beginning and end of every session") {
  StoredFixture study(1);
  const BufferedEvents session = session_of(1);
  const auto chain = study.store->events(0);
  REQUIRE(chain.size() == 3);
  const SessionOpenedBody opened = from_json<SessionOpenedBody>(chain[1].body);
  REQUIRE(opened.first == session.events.front().hash);
  REQUIRE(opened.key == sha256(wrapped_key_of(1).participant));
  REQUIRE(opened.safety_key == sha256(wrapped_key_of(1).safety));
  REQUIRE(opened.participant == "P1");
  const SessionClosedBody closed = from_json<SessionClosedBody>(chain[2].body);
  REQUIRE(closed.head == session.events.back().hash);
  REQUIRE(closed.length == static_cast<std::int64_t>(session.events.size()));
  REQUIRE(closed.complete);
}

TEST_CASE("a participant or an enrolment that is taken is refused, with the session that has it") {
  StoredFixture study(2);
  SessionOpening same_person = opening(3);
  same_person.participant = "P2";
  require_refused(study, session_of(3, 3, stroking(5, 0.0), same_person), "P2 2");
  SessionOpening same_number = opening(3);
  same_number.enrolment = 1;
  require_refused(study, session_of(3, 3, stroking(5, 0.0), same_number), "1 P3 P1 1");
}

TEST_CASE("a session of another study, out of turn or without its opening is refused") {
  StoredFixture study;
  SessionOpening other_study = opening(1);
  other_study.study_id = "ff";
  require_refused(study, session_of(1, 1, {}, other_study));
  SessionOpening other_seal = opening(1);
  other_seal.seal[0] ^= 1U;
  require_refused(study, session_of(1, 1, {}, other_seal));
  require_refused(study, session_of(2), "2 1");
  for (const std::string name : {"", "P 1", "../x", "P\n", "012345678901234567890123456789012"}) {
    SessionOpening odd = opening(1);
    odd.participant = name;
    require_refused(study, session_of(1, 1, {}, odd));
  }
  require_refused(study, BufferedEvents{});
}

TEST_CASE("pilots and other sessions never share a database") {
  StoredFixture study;
  SessionOpening how = opening(1);
  how.pilot = true;
  require_refused(study, session_of(1, 3, {}, how));

  StudyCommitment pilot = commitment();
  pilot.pilot = true;
  const std::filesystem::path path = study.folder.path() / "pilot.db";
  StudyStore store = StudyStore::create(path, pilot, kUtc, investigator());
  REQUIRE(refuses([&] { store.add_session(session_of(1), wrapped_key_of(1), kUtc); }));
  store.add_session(session_of(1, 3, {}, how), wrapped_key_of(1), kUtc);
  REQUIRE(store.sessions().front().pilot);
}

TEST_CASE("a device on a screen is for pilots alone, and seen and felt sessions are never pooled") {
  const auto seen = [](int session, bool visual) {
    SessionOpening how = opening(session);
    how.device = visual ? "mouse" : "falcon";
    how.pilot = true;
    how.station = StationRecord();
    how.station->visual = visual;
    return session_of(session, 3, {}, how);
  };
  StoredFixture study;
  SessionOpening how = opening(1);
  how.device = "mouse";
  how.station = StationRecord();
  how.station->visual = true;
  require_refused(study, session_of(1, 3, {}, how), "mouse");

  StudyCommitment pilot = commitment();
  pilot.pilot = true;
  for (const bool first : {true, false}) {
    const std::filesystem::path path = study.folder.path() / (first ? "seen.db" : "felt.db");
    StudyStore store = StudyStore::create(path, pilot, kUtc, investigator());
    store.add_session(seen(1, first), wrapped_key_of(1), kUtc);
    store.add_session(seen(2, first), wrapped_key_of(2), kUtc);
    REQUIRE(refuses([&] { store.add_session(seen(3, !first), wrapped_key_of(3), kUtc); }));
  }
}

TEST_CASE("a session whose chain or traces do not hold is refused whole") {
  StoredFixture study;
  BufferedEvents session = session_of(1);
  session.events[4].body.back() = ' ';
  require_refused(study, session, "1 4");

  session = session_of(1);
  session.events.erase(session.events.begin() + 3);
  require_refused(study, session, "1 3 3");

  session = session_of(1);
  session.events.pop_back();
  require_refused(study, session);

  session = session_of(1);
  session.traces.pop_back();
  require_refused(study, session, "3");

  session = session_of(1);
  session.traces.push_back(session.traces.back());
  require_refused(study, session);

  add(*study.store, 1);
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("a closed study takes no sessions and is closed once") {
  StoredFixture study(1);
  study.store->close_study(kUtc);
  REQUIRE(study.store->state().closed);
  require_refused(study, session_of(2));
  REQUIRE(refuses([&] { study.store->close_study(kUtc); }));
}

TEST_CASE("unblinding is recorded with its reason, and an open study needs an interim look") {
  StoredFixture study(1);
  REQUIRE(refuses([&] { study.store->unblind(kUtc, "done", false); }));
  REQUIRE(refuses([&] { study.store->unblind(kUtc, "", true); }));
  REQUIRE_FALSE(study.store->state().unblinded);
  study.store->unblind(kUtc, "safety board", true);
  REQUIRE(study.store->state().unblinded);
  REQUIRE(study.store->state().unblinding_reason == "safety board");
  study.store->close_study(kUtc);
  REQUIRE(refuses([&] { study.store->unblind(kUtc, "again", true); }));
  study.store->unblind(kUtc, "collection is over", false);
  const auto chain = study.store->events(0);
  REQUIRE(chain[3].body == R"({"interim":true,"reason":"safety board"})");
  REQUIRE(chain.back().body == R"({"interim":false,"reason":"collection is over"})");
  REQUIRE(study.store->state().unblinding_reason == "collection is over");
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("an exclusion marks its session, once and with a reason") {
  StoredFixture study(2);
  study.store->exclude(2, kUtc, "fell asleep");
  REQUIRE(study.store->sessions()[1].excluded);
  REQUIRE_FALSE(study.store->sessions()[0].excluded);
  REQUIRE(refuses([&] { study.store->exclude(2, kUtc, "again"); }));
  REQUIRE(refuses([&] { study.store->exclude(3, kUtc, "who"); }, "3"));
  REQUIRE(refuses([&] { study.store->exclude(1, kUtc, ""); }));
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("withdrawal destroys the key in the file, and the chains still hold") {
  StoredFixture study(60, 1);  // enough for several pages of keys
  for (const int session : {1, 17, 30, 59}) {
    study.store->withdraw(session, kUtc, "asked to");
    REQUIRE_FALSE(study.store->wrapped_key(session));
    REQUIRE(study.store->sessions()[static_cast<std::size_t>(session) - 1].withdrawn);
    const Bytes key = wrapped_key_of(session).participant;
    const std::string text(key.begin(), key.end());
    for (const std::string suffix : {"", "-wal"}) {
      REQUIRE_FALSE(contains(content_of(study.path.string() + suffix), text));
    }
  }
  REQUIRE(study.store->wrapped_key(2) == wrapped_key_of(2).participant);
  REQUIRE(study.store->events(17).size() == session_of(17, 1).events.size());
  REQUIRE_FALSE(study.store->first_fault());
  REQUIRE(refuses([&] { study.store->withdraw(17, kUtc, "again"); }));
  REQUIRE(refuses([&] { study.store->withdraw(61, kUtc, ""); }, "61"));
}

TEST_CASE("events and traces cannot be changed through SQL") {
  StoredFixture study(1);
  study.store.reset();
  SQLite::Database raw(study.path.string(), SQLite::OPEN_READWRITE);
  for (const char* const sql :
       {"UPDATE events SET at_ns = 0", "DELETE FROM events WHERE session = 1",
        "INSERT OR REPLACE INTO events SELECT * FROM events WHERE session = 1 AND sequence = 1",
        "UPDATE traces SET box = x'00'", "DELETE FROM traces",
        "INSERT OR REPLACE INTO traces SELECT * FROM traces"}) {
    REQUIRE_THROWS_AS(raw.exec(sql), SQLite::Exception);
  }
}

TEST_CASE("no secret of the study or of a participant is in the file") {
  StoredFixture study(2);
  study.store.reset();
  const std::string text = content_of(study.path);
  const SecretKey master = study_master();
  REQUIRE_FALSE(contains(text, std::string(master.begin(), master.end())));
  const SecretKey key = participant_key(1);
  REQUIRE_FALSE(contains(text, std::string(key.begin(), key.end())));
  REQUIRE_FALSE(contains(text, to_hex(key)));
  REQUIRE_FALSE(contains(text, "schedule"));
  REQUIRE_FALSE(contains(text, "512.5"));
}
