// The table of bundles on a real server: roles, rows that did not arrive whole, several at once.
#include "record/merging/bundle.hpp"
#include "record/merging/bundle_table.hpp"
#include "record/merging/lab_fixture.hpp"
#include "record/merging/postgres/server_connection.hpp"
#include "support/catch.hpp"
#include "support/postgres_server.hpp"

#include <thread>

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace touchtrial::fixture;
using touchtrial::testing::PostgresServer;

extern "C" BundleTable* touchtrial_open_bundle_table(const std::string& address);

namespace {

/// An empty database on a server that all cases share, and its roles.
struct ServerFixture {
  ServerFixture() : name("study" + std::to_string(++made)) { server().make_database(name); }

  static PostgresServer& server() {
    static PostgresServer one;
    return one;
  }
  [[nodiscard]] std::shared_ptr<BundleTable> table(
      const std::string& user = PostgresServer::kAdministrator) const {
    return std::shared_ptr<BundleTable>(touchtrial_open_bundle_table(server().url(name, user)));
  }
  std::vector<std::string> ask(const std::string& sql) const { return server().ask(name, sql); }
  /// Makes two collecting roles, a reading role, and one without any right; the statements of
  /// docs/several-stations.md.
  void make_roles() const {
    if (ask("SELECT 1 FROM pg_roles WHERE rolname = 'lab_a'").empty()) {
      ask("CREATE ROLE lab_a LOGIN; CREATE ROLE lab_b LOGIN; CREATE ROLE reader LOGIN; "
          "CREATE ROLE stranger LOGIN");
    }
    ask("GRANT SELECT(bundle, sent_by, station, seal, first_event, end_event, head, keys), "
        "INSERT(station, seal, first_event, end_event, head, keys, digest, chain, session) "
        "ON touchtrial_bundles TO lab_a, lab_b; GRANT SELECT ON touchtrial_bundles TO reader");
  }
  void send(const fs::path& file, BundleTable& to) const {
    static_cast<void>(send_station(*stations_of_file(file).at(0), to, false));
  }

  std::string name;
  inline static int made = 0;
};

BundleRow row_of(int first) {
  return {.number = 0,
          .sent_by = "",
          .station = digest_of("station"),
          .seal = digest_of("seal"),
          .first = first,
          .end = first + 1,
          .head = digest_of("head"),
          .keys = 2};
}

bool is_denied(const std::string& line) {
  return contains(line, "permission denied") && contains(line, "docs/several-stations.md") &&
         !contains(line, "\n");
}

}  // namespace

TEST_CASE("a row is read as it was sent, and stored once") {
  const ServerFixture there;
  const auto table = there.table();
  CHECK(table->rows().empty());
  const Bytes chain = {0, 1, 2, 0, 255, '\'', '\\'};
  table->add(row_of(7), chain, {});
  table->add(row_of(7), chain, {});
  const std::vector<BundleRow> rows = table->rows();
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].is_same_part(row_of(7)));
  CHECK(rows[0].seal == digest_of("seal"));
  CHECK(rows[0].keys == 2);
  CHECK(rows[0].sent_by == PostgresServer::kAdministrator);
  CHECK(table->half(rows[0].number, BundleTable::Half::chain) == chain);
  CHECK(table->half(rows[0].number, BundleTable::Half::session).empty());
}

TEST_CASE("of several programs that send the same rows at once, one adds each") {
  const ServerFixture there;
  std::vector<std::thread> programs;
  for (int i = 0; i < 4; ++i) {
    programs.emplace_back([&] {
      const auto table = there.table();
      for (int part = 0; part < 20; ++part) table->add(row_of(part), Bytes(50), {});
    });
  }
  for (std::thread& program : programs) program.join();
  CHECK(there.table()->rows().size() == 20);
}

TEST_CASE("a collecting role only adds, a reading role only reads, and a row names who sent it") {
  const ServerFixture there;
  TwoStations lab;
  there.send(lab.a, *there.table());
  there.make_roles();
  there.ask("TRUNCATE touchtrial_bundles RESTART IDENTITY");
  there.send(lab.a, *there.table("lab_a"));
  there.send(lab.b, *there.table("lab_b"));
  collect_into_file(stations_of_table(there.table("reader")), lab.file("fetched.db"));
  merge({lab.a, lab.b}, lab.file("merged.db"));
  CHECK((read_file(lab.file("fetched.db")) == read_file(lab.file("merged.db"))));
  CHECK(there.table("reader")->rows().front().sent_by == "lab_a");

  CHECK(is_denied(refusal_of(
      [&] { static_cast<void>(there.table("lab_a")->half(1, BundleTable::Half::session)); })));
  CHECK(is_denied(refusal_of([&] { there.table("reader")->add(row_of(1), Bytes(1), {}); })));
  CHECK(is_denied(refusal_of([&] { static_cast<void>(there.table("stranger")->rows()); })));
  const auto as_lab_a = [&](const std::string& statement) {
    return refusal_of([&] {
      ServerConnection(connection_options(there.server().url(there.name, "lab_a")))
          .execute(statement);
    });
  };
  for (const char* const statement :
       {"UPDATE touchtrial_bundles SET keys = 0", "DELETE FROM touchtrial_bundles",
        "TRUNCATE touchtrial_bundles", "SELECT chain FROM touchtrial_bundles",
        "DO $$ BEGIN LOCK TABLE touchtrial_bundles IN EXCLUSIVE MODE; END $$",
        "INSERT INTO touchtrial_bundles(sent_by) VALUES('lab_b')"}) {
    INFO(statement);
    CHECK(is_denied(as_lab_a(statement)));
  }
  CHECK(there.table("reader")->rows().size() == 4);
}

TEST_CASE("a station without the right to create the table gets a message on who can") {
  const ServerFixture there;
  there.ask("REVOKE CREATE ON SCHEMA public FROM PUBLIC");
  if (there.ask("SELECT 1 FROM pg_roles WHERE rolname = 'newcomer'").empty()) {
    there.ask("CREATE ROLE newcomer LOGIN");
  }
  CHECK(is_denied(refusal_of([&] { there.table("newcomer")->add(row_of(1), Bytes(1), {}); })));
}

TEST_CASE("the server refuses a row that did not arrive whole") {
  const ServerFixture there;
  const auto table = there.table();
  table->add(row_of(1), Bytes(5), Bytes(5));
  CHECK_THROWS(there.ask("UPDATE touchtrial_bundles SET session = '\\x00'"));
}

TEST_CASE("rows of another program and absurdly large ones are refused in one line") {
  const ServerFixture there;
  TwoStations lab;
  const auto table = there.table();
  const auto refusal = [&] {
    return refusal_of([&] { collect_into_file(stations_of_table(table), lab.file("refused.db")); });
  };
  CHECK_FALSE(refusal().empty());
  there.send(lab.a, *table);
  there.ask(
      "ALTER TABLE touchtrial_bundles DROP CONSTRAINT arrived_whole; "
      "UPDATE touchtrial_bundles SET session = convert_to(repeat('x', 140000000), 'UTF8') "
      "WHERE bundle = 1");
  CHECK_THAT(refusal(), holds_text("1") && holds_text("postgres"));
  there.ask("UPDATE touchtrial_bundles SET head = '\\x00' WHERE bundle = 2");
  CHECK_FALSE(refusal().empty());
  there.ask("DROP TABLE touchtrial_bundles; CREATE TABLE touchtrial_bundles(bundle TEXT)");
  CHECK_THAT(refusal(), holds_text("sent_by"));
  CHECK_FALSE(fs::exists(lab.file("refused.db")));
}
