/// \file A server with an empty database, stations to push into it, and the means to disturb both.
#pragma once

#include "protocols/collect/station_push.hpp"
#include "protocols/store/store_fixture.hpp"
#include "support/postgres_server.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::fixture {

using testing::PostgresServer;

/// A study's file as a station, with a hook before every session's events are read.
class OpenStation final : public collect::StationFile {
 public:
  explicit OpenStation(const store::StudyStore& store, std::string name = "study.db")
      : store_(store), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  std::vector<store::Event> file_chain() override { return store_.events(0); }
  std::vector<store::Event> events(int own_session) override {
    std::vector<store::Event> events = store_.events(own_session);
    if (alter) alter(events);
    return events;
  }
  store::WrappedKeys wrapped_keys(int own_session) override {
    return store_.wrapped_keys(own_session);
  }
  std::optional<Bytes> trace(int own_session, int trial) override {
    const auto sealed = store_.sealed_trace(own_session, trial);
    if (!sealed) return std::nullopt;
    return sealed->box;
  }
  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    for (const store::TrialRow& row : store_.trials()) {
      if (row.session != own_session) continue;
      if (before_trace) before_trace(own_session, row.trial);
      auto box = trace(own_session, row.trial);
      if (box && alter_trace) alter_trace(row.trial, *box);
      if (box) visit(row.trial, *box);
    }
  }

  std::function<void(int, int)> before_trace;
  std::function<void(std::vector<store::Event>&)> alter;
  std::function<void(int, Bytes&)> alter_trace;

 private:
  const store::StudyStore& store_;
  std::string name_;
};

/// A session of another station: its own number there, and who took part.
struct Visit {
  int session = 1;
  std::string participant;
  int enrolment = 0;
};

inline void add_visit(store::StudyStore& store, const Visit& visit, int trials = 3) {
  store::SessionOpening how = opening(visit.session);
  how.participant = visit.participant;
  how.enrolment = visit.enrolment;
  store.add_session(session_of(visit.session, trials, stroking(20, 0.05), how),
                    wrapped_key_of(visit.session), kUtc);
}

/// The server of all tests that do not disturb it: making one takes a second.
inline PostgresServer& shared_server() {
  static PostgresServer server;
  return server;
}

/// An empty database of its own on a server.
struct ServerFixture {
  explicit ServerFixture(PostgresServer& on = shared_server()) : server(on) {
    static int databases = 0;
    database = "study" + std::to_string(++databases);
    server.make_database(database);
  }

  [[nodiscard]] std::string url(const std::string& user = PostgresServer::kAdministrator) const {
    return server.url(database, user);
  }
  [[nodiscard]] collect::ServerAddress address(
      const std::string& user = PostgresServer::kAdministrator) const {
    return collect::ServerAddress(url(user));
  }
  collect::PushReport push(collect::StationFile& station,
                           const collect::PushOptions& options = {}) const {
    collect::PushReport report;
    collect::push_station(station, address(), options, report);
    return report;
  }
  collect::PushReport push(const store::StudyStore& store,
                           const collect::PushOptions& options = {}) const {
    OpenStation station(store);
    return push(station, options);
  }
  std::vector<std::string> ask(const std::string& sql) const { return server.ask(database, sql); }
  [[nodiscard]] std::string first(const std::string& sql) const { return ask(sql).at(0); }
  /// Executes SQL without the triggers that protect events and traces.
  void tamper(const std::string& sql) const {
    ask("SET session_replication_role = replica; " + sql);
  }
  /// The number of rows of every table, in the order of their names.
  [[nodiscard]] std::string counts() const {
    std::string text;
    for (const char* const table :
         {"events", "participant_keys", "safety_keys", "sessions", "traces", "trials"}) {
      text += first(std::string("SELECT count(*) FROM ") + table) + " ";
    }
    return text;
  }

  PostgresServer& server;
  std::string database;
};

}  // namespace touchtrial::fixture
