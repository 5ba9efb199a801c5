// What stations send to a server, and what merging makes of it, with a table in memory.
#include "record/merging/bundle.hpp"

#include "core/random.hpp"
#include "record/merging/bundle_table.hpp"
#include "record/merging/lab_fixture.hpp"
#include "support/catch.hpp"

#include <zstd.h>

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// Keeps rows as the server's table does.
class TableInMemory final : public BundleTable {
 public:
  struct Row {
    BundleRow row;
    Bytes chain;
    Bytes session;
  };

  [[nodiscard]] const std::string& address() const override { return name_; }
  [[nodiscard]] std::vector<BundleRow> rows() override {
    std::vector<BundleRow> rows;
    for (const Row& one : kept) rows.push_back(one.row);
    return rows;
  }
  void add(const BundleRow& row, ByteView chain, ByteView session) override {
    if (fails_after == 0) throw StoreError("the server was killed");
    --fails_after;
    for (const Row& one : kept) {
      if (one.row.is_same_part(row) && one.row.keys == row.keys) return;
    }
    put(row, {chain.begin(), chain.end()}, {session.begin(), session.end()});
  }
  void put(BundleRow row, const Bytes& chain, const Bytes& session) {
    row.number = ++last_;
    row.sent_by = "lab_a";
    kept.push_back({row, chain, session});
  }
  [[nodiscard]] Bytes half(std::int64_t number, Half which) override {
    for (const Row& one : kept) {
      if (one.row.number == number) return which == Half::chain ? one.chain : one.session;
    }
    return {};
  }

  std::vector<Row> kept;
  int fails_after = -1;  ///< rows; negative: never

 private:
  std::string name_ = "postgresql://lab/study";
  std::int64_t last_ = 0;
};

/// Two stations of a lab, and a server's table that its stations send to.
struct ServedLab : TwoStations {
  SendReport send(const fs::path& file, bool dry_run = false) {
    return send_station(*stations_of_file(file).at(0), *table, dry_run);
  }
  std::string send_refusal(const fs::path& file) {
    return refusal_of([&] { send(file); });
  }
  /// What merging the table makes, to the byte.
  [[nodiscard]] Bytes fetched() {
    fs::remove(file("fetched.db"));
    collect_into_file(stations_of_table(table), file("fetched.db"));
    return read_file(file("fetched.db"));
  }
  [[nodiscard]] Bytes merged(const std::vector<fs::path>& files) {
    fs::remove(file("merged.db"));
    merge(files, file("merged.db"));
    return read_file(file("merged.db"));
  }
  /// The line with which merging refuses the table; checks that it is one, and left no file.
  std::string fetch_refusal() {
    std::string line =
        refusal_of([&] { collect_into_file(stations_of_table(table), file("refused.db")); });
    CHECK(line.find('\n') == std::string::npos);
    CHECK_FALSE(fs::exists(file("refused.db")));
    return line;
  }

  std::shared_ptr<TableInMemory> table = std::make_shared<TableInMemory>();
};

std::vector<std::string> participants_of(const std::vector<SessionLeftOut>& sessions) {
  std::vector<std::string> names;
  for (const SessionLeftOut& session : sessions) names.push_back(session.participant);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("bundles of two stations merge to the same file as their databases, to the byte") {
  ServedLab lab;
  CHECK(lab.send(lab.a).sent == Names{"P1", "P3"});
  CHECK(lab.send(lab.b).sent == Names{"P2", "P4"});
  CHECK((lab.fetched() == lab.merged({lab.a, lab.b})));
  std::ranges::reverse(lab.table->kept);
  CHECK((lab.fetched() == lab.merged({lab.a, lab.b})));
}

TEST_CASE("sending again sends only new sessions, and a dry run nothing") {
  ServedLab lab;
  CHECK(lab.send(lab.a, true).sent == Names{"P1", "P3"});
  CHECK(lab.table->kept.empty());
  lab.send(lab.a);
  const std::size_t rows = lab.table->kept.size();
  const SendReport again = lab.send(lab.a);
  CHECK(again.sent.empty());
  CHECK(again.already_there == 2);
  CHECK(lab.table->kept.size() == rows);
  Lab::at(lab.a, [](StudyStore& store) {
    store.exclude(1, kUtc + minutes(40), "coughed");
    begin(store, {"P5", 5, minutes(50)});
  });
  CHECK(participants_of(lab.send(lab.a).left_out) == Names{"P5"});
  CHECK((lab.fetched() == lab.merged({lab.a})));
  Lab::at(lab.a, [](StudyStore& store) { visit(store, {{"P6", 6, minutes(60)}}); });
  CHECK(lab.send(lab.a).sent == Names{"P6"});
  CHECK((lab.fetched() == lab.merged({lab.a})));
}

TEST_CASE("an interrupted transfer continues where it stopped, without duplicates") {
  ServedLab whole;
  whole.send(whole.a);
  for (int rows = 0; rows < static_cast<int>(whole.table->kept.size()); ++rows) {
    ServedLab lab;
    lab.table->fails_after = rows;
    CHECK_FALSE(lab.send_refusal(whole.a).empty());
    lab.table->fails_after = -1;
    lab.send(whole.a);
    CHECK(lab.table->kept.size() == whole.table->kept.size());
    CHECK((lab.fetched() == whole.merged({whole.a})));
  }
}

TEST_CASE("rows that are there twice, or were sent before a withdrawal, do no harm") {
  ServedLab lab;
  lab.send(lab.a);
  const std::vector<TableInMemory::Row> before = lab.table->kept;
  Lab::at(lab.a, [](StudyStore& store) { store.withdraw(1, kUtc + minutes(70), "asked"); });
  const SendReport report = lab.send(lab.a);
  CHECK(report.rows_with_erased_keys == std::vector<std::int64_t>{before.front().row.number});
  for (const TableInMemory::Row& one : before) lab.table->put(one.row, one.chain, one.session);
  CHECK((lab.fetched() == lab.merged({lab.a})));
  // The owner destroys the keys.
  std::erase_if(lab.table->kept, [&](const TableInMemory::Row& one) {
    return one.row.is_same_part(before.front().row) && one.row.keys == 2;
  });
  CHECK((lab.fetched() == lab.merged({lab.a})));
  CHECK(lab.send(lab.a).rows_with_erased_keys.empty());
}

TEST_CASE("an older copy of a file and one that forked are named, and send nothing") {
  ServedLab lab;
  const fs::path older = lab.file("older.db");
  const fs::path forked = lab.file("forked.db");
  fs::copy_file(lab.a, older);
  fs::copy_file(lab.a, forked);
  Lab::at(lab.a, [](StudyStore& store) { visit(store, {{"P5", 5, minutes(50)}}); });
  Lab::at(forked, [](StudyStore& store) { visit(store, {{"P6", 6, minutes(60)}}); });
  lab.send(lab.a);
  const std::size_t rows = lab.table->kept.size();
  for (const fs::path& file : {older, forked}) {
    CHECK_THAT(lab.send_refusal(file),
               holds_text(file.filename().string()) && holds_text("3") && holds_text("lab_a"));
  }
  CHECK(lab.table->kept.size() == rows);
  ServedLab other;
  other.send(forked);
  const TableInMemory::Row& last = other.table->kept.back();
  lab.table->put(last.row, last.chain, last.session);
  CHECK(names(lab.fetch_refusal(), "4"));
}

TEST_CASE("a lost row is missed by merging, and sent again") {
  ServedLab lab;
  lab.send(lab.a);
  lab.table->kept.erase(lab.table->kept.begin());
  CHECK(names(lab.fetch_refusal(), "2"));
  CHECK(lab.send(lab.a).sent == Names{"P1"});
  CHECK((lab.fetched() == lab.merged({lab.a})));
}

TEST_CASE("sessions of another study are refused, at sending and at merging") {
  ServedLab lab;
  StudyCommitment other = lab_commitment();
  other.seal = digest_of("another seal");
  const fs::path strange = lab.station("strange.db", {{"P9", 9, minutes(9)}}, other);
  lab.send(lab.a);
  CHECK(names_in_order(lab.send_refusal(strange), "1 lab_a"));
  ServedLab elsewhere;
  elsewhere.send(strange);
  const TableInMemory::Row& row = elsewhere.table->kept.front();
  lab.table->put(row.row, row.chain, row.session);
  CHECK_FALSE(lab.fetch_refusal().empty());
}

TEST_CASE("garbage, bombs and altered bytes in a row are refused by its number, or by place") {
  const auto refusal_after = [](const auto& alter) {
    ServedLab lab;
    lab.send(lab.a);
    alter(lab.table->kept.at(1));
    return lab.fetch_refusal();
  };
  const Bytes zeros(kMaxBundleBytes + 1);
  Bytes bomb(ZSTD_compressBound(zeros.size()));
  bomb.resize(ZSTD_compress(bomb.data(), bomb.size(), zeros.data(), zeros.size(), 1));
  // A frame's header that promises 2^40 bytes.
  const Bytes promise = {0x28, 0xb5, 0x2f, 0xfd, 0xe0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0};
  for (const Bytes& garbage : {Bytes{}, Bytes(100, 7), bomb, promise}) {
    CHECK_THAT(refusal_after([&](auto& row) { row.chain = garbage; }), holds_text("2"));
    CHECK_THAT(refusal_after([&](auto& row) { row.session = garbage; }), holds_text("2"));
  }
  CHECK_THAT(refusal_after([](auto& row) { row.row.head[0] ^= 1; }), holds_text("2"));
  CHECK_THAT(refusal_after([](auto& row) { row.row.end += 1; }), holds_text("2"));
  CHECK_THAT(refusal_after([](auto& row) { row.row.first = -1; }), holds_text("lab_a"));
  CHECK_THAT(refusal_after([](auto& row) {
               BundleHalf session = unpack_bundle(row.session, 2);
               session.events.at(3).body += " ";
               row.session = pack_bundle(session);
             }),
             holds_text("2") && holds_text("3"));
  CHECK_THAT(refusal_after([](auto& row) {
               BundleHalf session = unpack_bundle(row.session, 2);
               session.traces.back().second.back() ^= 1;
               row.session = pack_bundle(session);
             }),
             holds_text("2") && holds_text("3"));
  CHECK_THAT(refusal_after([](auto& row) {
               BundleHalf session = unpack_bundle(row.session, 2);
               session.keys.safety.reset();
               row.session = pack_bundle(session);
             }),
             holds_text("session 2"));
}

TEST_CASE("bytes that were cut off or flipped anywhere are unpacked or refused, and nothing else") {
  ServedLab lab;
  lab.send(lab.a);
  const Bytes packed = lab.table->kept.at(0).session;
  RandomStream random(3, "flipped bytes");
  for (std::size_t i = 0; i < 300; ++i) {
    Bytes bytes = packed;
    if (i % 3 == 0) bytes.resize(random.below(bytes.size()));
    if (!bytes.empty()) bytes[random.below(bytes.size())] ^= 1U << (i % 8);
    CHECK_NOTHROW(refusal_of([&] { static_cast<void>(unpack_bundle(bytes, 1)); }));
  }
  CHECK(unpack_bundle(packed, 1).traces.size() == 3);
}
