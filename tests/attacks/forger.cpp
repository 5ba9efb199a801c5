#include "attacks/forger.hpp"

#include "analysis/verification/study_files.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/head_file.hpp"
#include "record/rows.hpp"
#include "record/schema.hpp"
#include "record/store_fixture.hpp"
#include "study/protocol.hpp"

#include <array>
#include <cstdlib>
#include <fstream>
#include <utility>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <nlohmann/json.hpp>

namespace touchtrial::attacks {
namespace {

using nlohmann::json;
using record::EventKind;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::string failed_checks(const analysis::Verification& verification) {
  std::string failed;
  for (const analysis::Check& check : verification.checks) {
    if (check.state == analysis::CheckState::failed) {
      failed += (failed.empty() ? "" : "; ") + check.name + ": " + check.detail;
    }
  }
  return failed;
}

std::string setting(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

AttackedStudy::AttackedStudy(int answered)
    : FakeStudy(study::identification::classification(),
                {.simulated = false, .trials = R"({"repeats": 2})", .with_pack = true}),
      station_(study::station_key(key(), key().stations.front().name)) {
  study::save_study_key(key_file(), key());
  study::save_station_key(station_file(), station_);
  fs::create_directory(folder() / "elsewhere");
  open();
  store().record_heads(fs::weakly_canonical(second_head().parent_path()).string(), seconds(0));
  add({.participant = "P01", .enrolment = 1, .answers = always_right()});
  store().sign_with(key().signer());
  store().unblind(seconds(1), "planned", /*interim=*/true);
  store().sign_with(station_.signer());
  store().exclude(1, seconds(2), "after outcomes were seen: fell asleep");
  add({.participant = "P02", .enrolment = 2, .answers = confusing(0, 1)});
  add({.participant = "P03", .enrolment = 3, .answers = confusing(1, 2)});
  if (answered == 0) return;
  begin_open_session();
  answer(answered);
}

void AttackedStudy::open() {
  store() = record::StudyStore::open(database(), record::StudyStore::Access::read_write);
  const Signer signer = station_.signer();
  store().sign_with(signer);
  const record::HeadFiles heads(database(), {key().investigator_signature, signer.public_half()},
                                folder() / "elsewhere");
  store().set_head_writer(
      [heads, signer](const record::HeadChange& change) { heads.update(signer, change); });
}

void AttackedStudy::close() {
  recorder_.reset();
  sink_.reset();
  const record::StudyStore closed = std::move(store());
}

void AttackedStudy::begin_open_session() {
  constexpr int kEnrolment = 4;
  own_ = SystemEntropy().secret("participant key");
  sink_ = store().begin_session(
      open_session(), record::wrap_participant_key(station_.investigator_box, open_session(), own_),
      [] { return seconds(3); },
      record::seal_station_copy(station_.station.secret, open_session(), own_));
  recorder_.emplace(open_session(), own_, *sink_);
  schedule_ =
      study::make_schedule(station_.study, station_.draw_of(kEnrolment, study::Draws::people));
  record::SessionOpening opening{.participant = "P04",
                                 .enrolment = kEnrolment,
                                 .study_id = station_.study_id,
                                 .seal = station_.seal,
                                 .device = "simulated"};
  recorder_->opened({}, opening, study::schedule_to_json(schedule_, station_));
}

void AttackedStudy::answer(int trials) {
  const record::Trace trace = fixture::stroking(20, 0.05);
  for (int i = 0; i < trials; ++i) {
    const study::Trial& shown = schedule_.trials.at(static_cast<std::size_t>(answered_++));
    const seconds at(10 * answered_);
    recorder_->presented(at, shown.place.trial, shown.place.block);
    recorder_->first_contact(at + seconds(1), shown.place.trial);
    recorder_->answered(
        at + seconds(4), {shown.place.trial, ChoiceAnswer{answered_ % 3}, std::nullopt},
        recorder_->pack_evidence({.trial = shown.place.trial, .rate_hz = 1000.0, .trace = {}}, {},
                                 trace));
  }
}

std::string AttackedStudy::found() const {
  return failed_checks(analysis::verify_files({.database = database(),
                                               .key = key_file(),
                                               .key_named = true,
                                               .heads = {second_head()},
                                               .pack = pack_folder()},
                                              {}));
}

std::string AttackedStudy::found(const fs::path& elsewhere) const {
  return failed_checks(analysis::verify_files({.database = elsewhere,
                                               .key = key_file(),
                                               .key_named = true,
                                               .heads = {},
                                               .pack = pack_folder()},
                                              {}));
}

std::string AttackedStudy::found_without_key() const {
  return failed_checks(
      analysis::verify_files({.database = database(), .key = {}, .heads = {}, .pack = {}}, {}));
}

std::string AttackedStudy::found_by_head(const Digest& head) const {
  return failed_checks(analysis::verify_files(
      {.database = database(), .key = {}, .heads = {}, .pack = {}}, to_hex(head)));
}

Forgery::Forgery(const fs::path& database) : path(database) {
  const record::Database read = record::Database::open(path, record::Database::Mode::read_only);
  record::for_each_event(read, record::EventFilter{}, [&](const record::Event& event) {
    chains[event.session].push_back(event);
  });
  for (const auto& [session, chain] : chains) {
    if (session > 0) keys[session] = record::read_keys(read, session);
  }
  record::Query copies = read.query("SELECT session, kept FROM station_keys");
  while (copies.step()) kept[static_cast<int>(copies.integer(0))] = copies.blob(1);
  record::Query query = read.query("SELECT session, trial, box FROM traces");
  while (query.step()) {
    traces.push_back({.session = static_cast<int>(query.integer(0)),
                      .trial = static_cast<int>(query.integer(1)),
                      .box = query.blob(2)});
  }
}

record::Event& Forgery::first(int session, EventKind kind) {
  for (record::Event& event : chains.at(session)) {
    if (event.kind == kind) return event;
  }
  throw StoreError("no such event to forge");
}

void Forgery::drop(int session) {
  chains.erase(session);
  keys.erase(session);
  kept.erase(session);
  std::erase_if(traces, [&](const record::SealedTrace& trace) { return trace.session == session; });
  std::erase_if(file(), [&](const record::Event& event) {
    return event.kind != EventKind::study_committed && record::session_about(event) == session;
  });
}

void Forgery::relink(const Signer* signer) {
  for (auto chain = chains.rbegin(); chain != chains.rend(); ++chain) {  // the file's comes last
    Digest previous{};
    std::int64_t sequence = 0;
    for (record::Event& event : chain->second) {
      const int about = chain->first == 0 ? record::session_about(event) : 0;
      if (event.kind == EventKind::session_opened) {
        set(event, "first", json(to_hex(chains.at(about).front().hash)).dump());
        set(event, "key", json(to_hex(sha256(keys.at(about).participant.value()))).dump());
        set(event, "safety_key", json(to_hex(sha256(keys.at(about).safety.value()))).dump());
      }
      if (event.kind == EventKind::session_closed) {
        set(event, "head", json(to_hex(chains.at(about).back().hash)).dump());
        set(event, "length", json(chains.at(about).size()).dump());
      }
      event.sequence = sequence++;
      event.previous = previous;
      previous = event.hash = record::event_hash(event);
      if (chain->first == 0 && signer != nullptr) event = record::signed_event(event, *signer);
    }
  }
}

void Forgery::write() const {
  const record::Database database =
      record::Database::open(path, record::Database::Mode::read_write);
  fixture::without_triggers(database.connection(), [&] {
    database.change([&] {
      for (const std::string table : record::kTables) {
        database.connection().exec("DELETE FROM " + table);
      }
      for (auto chain = chains.rbegin(); chain != chains.rend(); ++chain) {
        for (const record::Event& event : chain->second) record::insert_event(database, event);
      }
      for (const auto& [session, own] : keys) record::insert_keys(database, session, own);
      for (const auto& [session, one] : kept) record::insert_station_key(database, session, one);
      for (const record::SealedTrace& trace : traces) record::insert_trace(database, trace);
    });
  });
}

void set(record::Event& event, const std::string& member, const std::string& value) {
  json body = json::parse(event.body);
  body[member] = json::parse(value);
  event.body = body.dump();
}

void with_sql(const fs::path& database, const std::string& sql) {
  SQLite::Database raw(database.string(), SQLite::OPEN_READWRITE);
  raw.exec("PRAGMA foreign_keys = OFF");
  fixture::without_triggers(raw, [&] { raw.exec(sql); });
}

std::string rows_of(const fs::path& database) {
  std::string rows;
  try {
    SQLite::Database raw(database.string(), SQLite::OPEN_READONLY);
    for (const std::string table : record::kTables) {
      const std::string columns =
          raw.execAndGet(
                 "SELECT group_concat('quote(' || name || ')', ' || '','' || ') FROM "
                 "pragma_table_info('" +
                 table + "')")
              .getString();
      SQLite::Statement query(raw, "SELECT " + columns + " FROM " + table + " NOT INDEXED");
      while (query.executeStep()) rows += query.getColumn(0).getString() + '\n';
      rows += '\n';
    }
  } catch (const SQLite::Exception& error) {
    return error.what();
  }
  return rows;
}

void flip(const fs::path& file, std::uintmax_t at, unsigned bit) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(at));
  const int byte = stream.get();
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(static_cast<unsigned>(byte) ^ (1U << bit)));
}

void note(const std::string& attack, Outcome outcome, int count) {
  constexpr std::array<const char*, 4> kNames = {"refused", "named", "changes no row", "possible"};
  const std::string file = setting("TOUCHTRIAL_ATTACKS");
  if (file.empty() || count == 0) return;
  std::ofstream(file, std::ios::app)
      << attack << '\t' << kNames.at(static_cast<std::size_t>(outcome)) << '\t' << count << '\n';
}

int places(int of_ctest) {
  const std::string wanted = setting("TOUCHTRIAL_ATTACK_PLACES");
  return wanted.empty() ? of_ctest : std::stoi(wanted);
}

RandomStream places_of(const std::string& attack) {
  const std::string seed = setting("TOUCHTRIAL_ATTACK_SEED");
  return RandomStream(seed.empty() ? 1 : std::stoull(seed), attack);
}

}  // namespace touchtrial::attacks
