// Pushing while the server is killed, other stations push, or nobody answers.
#include "core/files.hpp"
#include "core/random.hpp"
#include "protocols/collect/server/server_fixture.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <functional>
#include <future>
#include <latch>
#include <semaphore>
#include <thread>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

/// A server that a test may kill, with one database; what it has on disk is safe.
struct MortalServer {
  PostgresServer server{PostgresServer::Writes::safe};
  ServerFixture there{server};
};

/// Kills a server and starts it again, for whatever thread asks. All on one thread, because the
/// server ends with the thread that started it.
class Restarter {
 public:
  explicit Restarter(PostgresServer& server) : server_(server), thread_([this] { serve(); }) {}
  ~Restarter() {
    over_ = true;
    asked_.release();
    thread_.join();
    server_.start();  // outlives the thread
  }
  Restarter(const Restarter&) = delete;
  Restarter& operator=(const Restarter&) = delete;

  void restart() {
    asked_.release();
    done_.acquire();
  }

 private:
  void serve() {
    for (asked_.acquire(); !over_; asked_.acquire()) {
      server_.kill();
      server_.start();
      done_.release();
    }
    server_.kill();
  }

  PostgresServer& server_;
  std::binary_semaphore asked_{0};
  std::binary_semaphore done_{0};
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// Calls `work` once a push has pushed one session.
PushOptions after_one(const std::function<void()>& work, PushOptions options) {
  options.progress = [work](int pushed, int) {
    if (pushed == 1) work();
  };
  return options;
}

PushOptions without_waiting() {
  return {.wait = [](std::chrono::milliseconds) {}};
}

/// The content of a server after an undisturbed push of the same file.
std::string undisturbed(const StudyStore& store) {
  const ServerFixture other;
  other.push(store);
  return other.counts();
}

/// Accepts connections like a server, but is none.
class FalseServer {
 public:
  /// \param answer  sent to every client; empty: nothing is sent
  explicit FalseServer(const std::string& answer) : answer_(answer) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = (folder_.path() / ".s.PGSQL.5432").string();
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        listen(socket_, 8) != 0) {
      throw std::runtime_error("cannot listen at " + path);
    }
    if (!answer_.empty()) thread_ = std::thread([this] { serve(); });
  }
  ~FalseServer() {
    shutdown(socket_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    close(socket_);
  }
  FalseServer(const FalseServer&) = delete;
  FalseServer& operator=(const FalseServer&) = delete;

  [[nodiscard]] std::string url() const {
    return "postgresql:///study?user=postgres&connect_timeout=2&host=" + folder_.path().string();
  }

 private:
  void serve() const {
    for (int peer = 0; (peer = accept(socket_, nullptr, nullptr)) >= 0; close(peer)) {
      static_cast<void>(send(peer, answer_.data(), answer_.size(), MSG_NOSIGNAL));
    }
  }

  TempFolder folder_;
  std::string answer_;
  int socket_ = -1;
  std::thread thread_;
};

std::string push_refusal(const StudyStore& store, const std::string& url,
                         const PushOptions& options) {
  OpenStation station(store);
  PushReport report;
  return refusal_of([&] { push_station(station, ServerAddress(url), options, report); });
}

}  // namespace

TEST_CASE("a server that is killed in mid-push and comes back gets everything once") {
  MortalServer mortal;
  StoredFixture study(3);
  OpenStation station(*study.store);
  int kills = 0;
  {
    Restarter restarter(mortal.server);
    station.before_trace = [&](int session, int trial) {
      if (session == 2 && trial == 2 && kills++ == 0) restarter.restart();
    };
    const PushReport report = mortal.there.push(station, without_waiting());
    CHECK(report.reconnections == 1);
    CHECK(report.pushed.size() == 3);
  }
  CHECK(kills == 2);  // and once more in the second attempt
  CHECK(mortal.there.counts() == undisturbed(*study.store));
}

TEST_CASE("pushing to a server that stays away ends after bounded attempts; what arrived stays") {
  MortalServer mortal;
  StoredFixture study(3);
  OpenStation station(*study.store);
  std::vector<std::int64_t> waits;
  PushReport report;
  const PushOptions options =
      after_one([&] { mortal.server.kill(); },
                {.wait = [&](std::chrono::milliseconds time) { waits.push_back(time.count()); }});
  const std::string line =
      refusal_of([&] { push_station(station, mortal.there.address(), options, report); });
  CHECK(waits == std::vector<std::int64_t>{100, 200, 400, 800, 1600, 3200, 5000, 5000, 5000, 5000});
  CHECK_THAT(line, holds_text("run the same command again"));
  CHECK_THAT(line, holds_text("1 of 3 sessions were pushed"));
  CHECK(line.find('\n') == std::string::npos);
  CHECK(report.pushed.size() == 1);

  mortal.server.start();
  const PushReport again = mortal.there.push(*study.store);
  CHECK(again.already_there == 1);
  CHECK(again.pushed.size() == 2);
  CHECK(mortal.there.counts() == undisturbed(*study.store));
}

TEST_CASE("a server that is shut down in good order is waited for as well") {
  MortalServer mortal;
  StoredFixture study(2);
  OpenStation station(*study.store);
  int waits = 0;
  const PushReport report = mortal.there.push(
      station, after_one([&] { mortal.server.stop(); }, {.wait = [&](std::chrono::milliseconds) {
                           if (++waits == 3) mortal.server.start();
                         }}));
  CHECK(waits == 3);
  CHECK(report.reconnections == 3);
  CHECK(mortal.there.counts() == undisturbed(*study.store));
}

TEST_CASE("wherever the server dies, pushing goes on to the same end") {
  MortalServer mortal;
  StoredFixture study(6, 4);
  const std::string expected = undisturbed(*study.store);
  RandomStream random(20260105, "kills of the server");
  OpenStation station(*study.store);
  int kills = 0;
  {
    Restarter restarter(mortal.server);
    station.before_trace = [&](int, int) {
      if (kills == 5 || random.below(4) != 0) return;
      ++kills;
      restarter.restart();
    };
    const PushReport report = mortal.there.push(station, without_waiting());
    CHECK(report.reconnections >= 1);
    CHECK(report.reconnections <= kills);  // some are noticed together
    CHECK(report.pushed.size() == 6);
  }
  CHECK(kills >= 3);
  CHECK(mortal.there.counts() == expected);
}

TEST_CASE("four stations push at once into a database that has no tables yet") {
  const ServerFixture there;
  std::vector<std::future<std::size_t>> pushes;
  std::latch start(4);
  for (int number = 0; number < 4; ++number) {
    pushes.push_back(std::async(std::launch::async, [&, number] {
      StoredFixture study;
      for (int session = 1; session <= 3; ++session) {
        const int enrolment = 3 * number + session;
        add_visit(*study.store, {session, "P" + std::to_string(enrolment), enrolment});
      }
      start.arrive_and_wait();
      return there.push(*study.store, without_waiting()).pushed.size();
    }));
  }
  for (auto& push : pushes) CHECK(push.get() == 3);
  CHECK(there.first("SELECT count(*) FROM stations") == "4");
  CHECK(there.first("SELECT count(DISTINCT participant) FROM sessions") == "12");
  CHECK(there.first("SELECT count(DISTINCT session) FROM sessions") == "12");
  CHECK(there.first("SELECT count(*) FROM events WHERE session < 0") == "28");
}

TEST_CASE("a station that is pushed by two programs at once comes once") {
  const ServerFixture there;
  StoredFixture study(6);
  const std::string expected = undisturbed(*study.store);
  study.store.reset();
  std::latch start(2);
  const auto push = [&] {
    const StudyStore store = StudyStore::open(study.path, StudyStore::Access::read_only);
    start.arrive_and_wait();
    return there.push(store, without_waiting());
  };
  std::future<PushReport> other = std::async(std::launch::async, push);
  const PushReport here = push();
  const PushReport beside = other.get();
  CHECK(here.pushed.size() + beside.pushed.size() == 6);
  CHECK(here.already_there == static_cast<int>(beside.pushed.size()));
  CHECK(beside.already_there == static_cast<int>(here.pushed.size()));
  CHECK(there.counts() == expected);
}

TEST_CASE(
    "of two stations that bring one participant at once, one is refused and told which session "
    "stays") {
  const ServerFixture there;
  std::latch start(2);
  const auto push = [&](int enrolment) {
    StoredFixture study;
    add_visit(*study.store, {1, "P1", enrolment});
    OpenStation station(*study.store, "room-" + std::to_string(enrolment) + ".db");
    start.arrive_and_wait();
    return refusal_of([&] { there.push(station, without_waiting()); });
  };
  std::future<std::string> other = std::async(std::launch::async, push, 2);
  const std::string here = push(1);
  const std::string there_line = other.get();
  CHECK(here.empty() != there_line.empty());
  CHECK_THAT(here + there_line, holds_text("participant P1 is taken already by session 1"));
  CHECK_THAT(here, holds_text(here.empty() ? "" : "room-2.db"));
  CHECK_THAT(there_line, holds_text(there_line.empty() ? "" : "room-1.db"));
  CHECK(there.first("SELECT count(*) FROM sessions") == "1");
}

TEST_CASE("an address where nothing answers is refused in one line, at once") {
  StoredFixture study(1);
  int waits = 0;
  const PushOptions options{.wait = [&](std::chrono::milliseconds) { ++waits; }};
  TempFolder empty;
  const std::string absent =
      push_refusal(*study.store, "postgresql:///study?host=" + empty.path().string(), options);
  CHECK_THAT(absent, holds_text("cannot be reached"));
  CHECK_THAT(absent, holds_text("check the address"));
  CHECK(absent.find('\n') == std::string::npos);
  const FalseServer web("HTTP/1.1 400 Bad Request\r\n\r\n");
  CHECK_THAT(push_refusal(*study.store, web.url(), options), holds_text("cannot be reached"));
  const FalseServer silent("");
  CHECK_THAT(push_refusal(*study.store, silent.url(), options), holds_text("timeout expired"));
  CHECK(waits == 0);
}

TEST_CASE("a reconnection that is refused for want of room, or dies in its handshake, is retried") {
  const ServerFixture there;
  there.ask("CREATE ROLE narrow LOGIN SUPERUSER; CREATE ROLE narrower LOGIN CONNECTION LIMIT 0");
  StoredFixture study(2);
  OpenStation station(*study.store);
  int waits = 0;
  // Connections are cut, and for two attempts none is taken.
  const auto cut = [&] {
    there.ask("ALTER ROLE narrow NOSUPERUSER CONNECTION LIMIT 0");
    there.ask("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE usename = 'narrow'");
  };
  const PushOptions options =
      after_one(cut, {.wait = [&](std::chrono::milliseconds) {
                  if (++waits == 3) there.ask("ALTER ROLE narrow SUPERUSER CONNECTION LIMIT -1");
                }});
  PushReport report;
  push_station(station, there.address("narrow"), options, report);
  CHECK(waits == 3);
  CHECK(report.pushed.size() == 2);
  const std::string line = push_refusal(*study.store, there.url("narrower"), options);
  CHECK_THAT(line, holds_text("the server is busy"));
  CHECK_THAT(line, holds_text("try again later"));
  CHECK(line.find("password") == std::string::npos);
  CHECK(waits == 3);
}

TEST_CASE("a server that hangs up in the handshake is not said to refuse a password") {
  StoredFixture study(1);
  const FalseServer dying("E");
  const std::string line = push_refusal(*study.store, dying.url(), without_waiting());
  CHECK_THAT(line, holds_text("cannot be reached"));
  CHECK(line.find("password") == std::string::npos);
}

TEST_CASE("a database or a role that does not exist is reported in one line, at once") {
  const ServerFixture there;
  StoredFixture study(1);
  int waits = 0;
  const PushOptions options{.wait = [&](std::chrono::milliseconds) { ++waits; }};
  CHECK_THAT(push_refusal(*study.store, there.server.url("nowhere"), options),
             holds_text("database \"nowhere\" does not exist"));
  CHECK_THAT(push_refusal(*study.store, there.url("nobody"), options),
             holds_text("role \"nobody\" does not exist"));
  CHECK(waits == 0);
}

TEST_CASE("a full disk of the server is reported, and nothing of the session is kept") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  there.ask(
      "CREATE FUNCTION full_disk() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE EXCEPTION "
      "'could not extend file' USING ERRCODE = '53100'; END $$;"
      "CREATE TRIGGER full_disk BEFORE INSERT ON traces FOR EACH ROW EXECUTE FUNCTION full_disk()");
  add(*study.store, 2);
  const std::string counts = there.counts();
  CHECK_THAT(refusal_of([&] { there.push(*study.store, without_waiting()); }),
             holds_text("disk is full"));
  CHECK(there.counts() == counts);
}

TEST_CASE("passwords come from the places that PostgreSQL has for them, and are never repeated") {
  PostgresServer server(PostgresServer::Writes::unsafe, PostgresServer::Passwords::scram);
  const ServerFixture there(server);
  there.ask("CREATE ROLE lab LOGIN SUPERUSER PASSWORD 'geheim'");
  StoredFixture study(1);
  TempFolder folder;
  const std::string file = (folder.path() / "pgpass").string();
  const auto with_password = [&](const std::string& password) {
    replace_file(file, "*:*:*:lab:" + password + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    const std::string line =
        push_refusal(*study.store, there.url("lab") + "&passfile=" + file, without_waiting());
    std::filesystem::remove(file);
    return line;
  };
  const std::string wrong = with_password("falsch");
  CHECK_THAT(wrong, holds_text("password authentication failed"));
  CHECK_THAT(wrong, holds_text(".pgpass"));
  CHECK(wrong.find("falsch") == std::string::npos);
  CHECK(wrong.find('\n') == std::string::npos);
  CHECK_THAT(push_refusal(*study.store, there.url("lab"), without_waiting()),
             holds_text("no password supplied"));
  CHECK(with_password("geheim").empty());
  CHECK(there.first("SELECT count(*) FROM sessions") == "1");
}
