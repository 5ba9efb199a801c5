// The table of bundles in a PostgreSQL database, and the one function of the module that `sync` and
// `merge` load (bundle_module.cpp).
#include "core/text.hpp"
#include "record/damage.hpp"
#include "record/merging/bundle.hpp"
#include "record/merging/bundle_table.hpp"
#include "record/merging/postgres/server_connection.hpp"

#include <array>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::merging {
namespace {

// The server itself records the sender of a row, and refuses an incomplete one. It does not
// compress bundles again. It is one statement, because two stations may start at once.
constexpr const char* kCreateTable = R"sql(DO $$ BEGIN
  PERFORM pg_advisory_xact_lock(hashtextextended('touchtrial_bundles', 0));
  CREATE TABLE IF NOT EXISTS touchtrial_bundles(
    bundle      BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    sent_by     NAME NOT NULL DEFAULT session_user,
    sent_at     TIMESTAMPTZ NOT NULL DEFAULT now(),
    station     BYTEA NOT NULL,
    seal        BYTEA NOT NULL,
    first_event BIGINT NOT NULL,
    end_event   BIGINT NOT NULL,
    head        BYTEA NOT NULL,
    keys        INTEGER NOT NULL,
    digest      BYTEA NOT NULL,
    chain       BYTEA NOT NULL,
    session     BYTEA NOT NULL,
    CONSTRAINT arrived_whole CHECK(digest = sha256(sha256(chain) || sha256(session))),
    UNIQUE(station, first_event, end_event, head, keys));
  ALTER TABLE touchtrial_bundles ALTER COLUMN session SET STORAGE EXTERNAL;
END $$)sql";

class PostgresTable final : public BundleTable {
 public:
  explicit PostgresTable(const std::string& address) : server_(connection_options(address)) {}

  [[nodiscard]] const std::string& address() const override { return server_.address(); }

  [[nodiscard]] std::vector<BundleRow> rows() override {
    const auto tables =
        server_.execute("SELECT WHERE to_regclass('touchtrial_bundles') IS NOT NULL");
    exists_ = PQntuples(tables.get()) > 0;
    if (!exists_) return {};
    // The columns are in the order of BundleRow's members.
    const SqlRows found = server_.execute(
        "SELECT bundle::text, sent_by::text, encode(station, 'hex'), encode(seal, 'hex'), "
        "first_event::text, end_event::text, encode(head, 'hex'), keys::text "
        "FROM touchtrial_bundles ORDER BY bundle");
    std::vector<BundleRow> rows;
    for (int i = 0; i < PQntuples(found.get()); ++i) {
      const auto text = [&](int column) { return text_of(value_at(found, i, column)); };
      const auto number = [&](int column) {
        return require(number_in<std::int64_t>(text(column)));
      };
      const auto digest = [&](int column) { return require(digest_from_hex(text(column))); };
      rows.push_back(
          {number(0), text(1), digest(2), digest(3), number(4), number(5), digest(6), number(7)});
    }
    return rows;
  }

  void add(const BundleRow& row, ByteView chain, ByteView session) override {
    // If the table exists, the role needs no right to create tables.
    if (!exists_) server_.execute(kCreateTable);
    exists_ = true;
    const std::array<Digest, 2> halves = {sha256(chain), sha256(session)};
    const Digest digest = sha256(bytes_of(text_of(halves[0]) + text_of(halves[1])));
    server_.execute(
        fmt::format("INSERT INTO touchtrial_bundles(station, seal, head, digest, chain, "
                    "session, first_event, end_event, keys) VALUES($1, $2, $3, $4, $5, $6, "
                    "{}, {}, {}) ON CONFLICT DO NOTHING",
                    row.first, row.end, row.keys),
        {row.station, row.seal, row.head, digest, chain, session});
  }

  [[nodiscard]] Bytes half(std::int64_t number, Half half) override {
    const SqlRows rows = server_.execute(fmt::format(
        "SELECT {0} FROM touchtrial_bundles WHERE bundle = {1} AND octet_length({0}) <= "
        "{2}",
        half == Half::chain ? "chain" : "session", number, kMaxBundleBytes));
    if (PQntuples(rows.get()) != 1) return {};
    const ByteView bytes = value_at(rows, 0, 0);
    return {bytes.begin(), bytes.end()};
  }

 private:
  template <typename Value>
  [[nodiscard]] Value require(const std::optional<Value>& value) const {
    if (value) return *value;
    throw record::DamagedStore(
        address() +
        ": the table of bundles contains rows that Touchtrial did not write; "
        "create a new database, and sync all stations to it");
  }

  ServerConnection server_;
  bool exists_ = false;
};

}  // namespace
}  // namespace touchtrial::merging

extern "C" __attribute__((visibility("default"))) touchtrial::merging::BundleTable*
touchtrial_open_bundle_table(const std::string& address) {
  return new touchtrial::merging::PostgresTable(address);
}
