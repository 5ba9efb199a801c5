#include "protocols/store/schema.hpp"

#include "core/files.hpp"

#include <array>
#include <string>

#include <SQLiteCpp/Backup.h>
#include <sqlite3.h>

namespace touchtrial::store {
namespace {

// Events and traces are only ever added. REPLACE deletes without a delete trigger, so that inserts
// over an existing row are refused as well.
constexpr const char* kEvidence = R"sql(
CREATE TABLE events(
  session  INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  kind     TEXT NOT NULL,
  at_ns    INTEGER NOT NULL,
  body     TEXT NOT NULL,
  sealed   BLOB NOT NULL,
  previous BLOB NOT NULL,
  hash     BLOB NOT NULL,
  PRIMARY KEY(session, sequence)
) STRICT, WITHOUT ROWID;
CREATE TABLE traces(
  session INTEGER NOT NULL,
  trial   INTEGER NOT NULL,
  box     BLOB NOT NULL,
  PRIMARY KEY(session, trial)
) STRICT;
CREATE TABLE participant_keys(
  session INTEGER PRIMARY KEY,
  wrapped BLOB NOT NULL
) STRICT;

CREATE TRIGGER events_no_update BEFORE UPDATE ON events
  BEGIN SELECT RAISE(ABORT, 'events are append-only'); END;
CREATE TRIGGER events_no_delete BEFORE DELETE ON events
  BEGIN SELECT RAISE(ABORT, 'events are append-only'); END;
CREATE TRIGGER events_no_replace BEFORE INSERT ON events
  WHEN EXISTS(SELECT 1 FROM events WHERE session = NEW.session AND sequence = NEW.sequence)
  BEGIN SELECT RAISE(ABORT, 'events are append-only'); END;
CREATE TRIGGER traces_no_update BEFORE UPDATE ON traces
  BEGIN SELECT RAISE(ABORT, 'traces are append-only'); END;
CREATE TRIGGER traces_no_delete BEFORE DELETE ON traces
  BEGIN SELECT RAISE(ABORT, 'traces are append-only'); END;
CREATE TRIGGER traces_no_replace BEFORE INSERT ON traces
  WHEN EXISTS(SELECT 1 FROM traces WHERE session = NEW.session AND trial = NEW.trial)
  BEGIN SELECT RAISE(ABORT, 'traces are append-only'); END;
)sql";

constexpr const char* kDerived = R"sql(
CREATE TABLE sessions(
  session     INTEGER PRIMARY KEY,
  participant TEXT NOT NULL UNIQUE,
  enrolment   INTEGER NOT NULL UNIQUE,
  state       TEXT NOT NULL,
  simulated   INTEGER NOT NULL,
  pilot       INTEGER NOT NULL,
  excluded    INTEGER NOT NULL,
  withdrawn   INTEGER NOT NULL,
  device      TEXT NOT NULL
) STRICT;
CREATE TABLE trials(
  session         INTEGER NOT NULL REFERENCES sessions(session),
  trial           INTEGER NOT NULL,
  block           INTEGER NOT NULL,
  state           TEXT NOT NULL,
  presented_at_ns INTEGER NOT NULL,
  contact_at_ns   INTEGER,
  valid           INTEGER NOT NULL,
  overruns        INTEGER NOT NULL,
  samples         INTEGER NOT NULL,
  rate_hz         REAL NOT NULL,
  PRIMARY KEY(session, trial)
) STRICT, WITHOUT ROWID;
CREATE TABLE responses(
  session        INTEGER NOT NULL,
  trial          INTEGER NOT NULL,
  answered_at_ns INTEGER NOT NULL,
  position       INTEGER NOT NULL,
  first_position INTEGER,
  confidence     INTEGER,
  PRIMARY KEY(session, trial),
  FOREIGN KEY(session, trial) REFERENCES trials(session, trial)
) STRICT, WITHOUT ROWID;
)sql";

void make_first_version(SQLite::Database& database) {
  database.exec(kEvidence);
  database.exec(kDerived);
}

// Participants may be replaced, which leaves their rows: who is unique is so among the others.
// Sessions began to be restarted, and trials explored again or voided, with this version.
constexpr const char* kSecondDerived = R"sql(
CREATE TABLE sessions(
  session     INTEGER PRIMARY KEY,
  participant TEXT NOT NULL,
  enrolment   INTEGER NOT NULL,
  state       TEXT NOT NULL,
  simulated   INTEGER NOT NULL,
  pilot       INTEGER NOT NULL,
  excluded    INTEGER NOT NULL,
  withdrawn   INTEGER NOT NULL,
  device      TEXT NOT NULL,
  replaced_by TEXT
) STRICT;
CREATE TABLE trials(
  session         INTEGER NOT NULL REFERENCES sessions(session),
  trial           INTEGER NOT NULL,
  block           INTEGER NOT NULL,
  state           TEXT NOT NULL,
  presented_at_ns INTEGER NOT NULL,
  contact_at_ns   INTEGER,
  valid           INTEGER NOT NULL,
  overruns        INTEGER NOT NULL,
  samples         INTEGER NOT NULL,
  rate_hz         REAL NOT NULL,
  explorations    INTEGER NOT NULL,
  PRIMARY KEY(session, trial)
) STRICT, WITHOUT ROWID;
CREATE TABLE responses(
  session        INTEGER NOT NULL,
  trial          INTEGER NOT NULL,
  answered_at_ns INTEGER NOT NULL,
  position       INTEGER NOT NULL,
  first_position INTEGER,
  confidence     INTEGER,
  PRIMARY KEY(session, trial),
  FOREIGN KEY(session, trial) REFERENCES trials(session, trial)
) STRICT, WITHOUT ROWID;
CREATE UNIQUE INDEX sessions_participant ON sessions(participant) WHERE replaced_by IS NULL;
CREATE UNIQUE INDEX sessions_enrolment ON sessions(enrolment) WHERE replaced_by IS NULL;
)sql";

/// The tables are made anew; their rows are carried over and not derived again, so that a database
/// that was tampered with is still found out afterwards.
void make_second_version(SQLite::Database& database) {
  database.exec(
      "ALTER TABLE responses RENAME TO old_responses;"
      "ALTER TABLE trials RENAME TO old_trials;"
      "ALTER TABLE sessions RENAME TO old_sessions;");
  database.exec(kSecondDerived);
  database.exec(
      "INSERT INTO sessions SELECT session, participant, enrolment, state, simulated, pilot, "
      "excluded, withdrawn, device, NULL FROM old_sessions;"
      "INSERT INTO trials SELECT session, trial, block, state, presented_at_ns, contact_at_ns, "
      "valid, overruns, samples, rate_hz, 1 FROM old_trials;"
      "INSERT INTO responses SELECT session, trial, answered_at_ns, position, first_position, "
      "confidence FROM old_responses;"
      "DROP TABLE old_responses; DROP TABLE old_trials; DROP TABLE old_sessions;");
}

/// Several stations' files may be collected into one, where sessions get other numbers. No row is
/// written anew: NULL stands for the number that a session has here.
void make_third_version(SQLite::Database& database) {
  database.exec(
      "ALTER TABLE events ADD COLUMN own_session INTEGER;"
      "ALTER TABLE sessions ADD COLUMN own_session INTEGER;"
      "ALTER TABLE sessions ADD COLUMN station INTEGER NOT NULL DEFAULT 0;");
}

constexpr std::array<Migration, kSchemaVersion> kMigrations = {
    make_first_version, make_second_version, make_third_version};

/// A backup that is there is whole; one that a broken-off migration left, and that is equal to what
/// it would be now, stands.
void back_up(const Database& database, int version) {
  const std::filesystem::path copy = backup_path(database.path(), version);
  const std::filesystem::path draft = copy.string() + ".part";
  std::filesystem::remove(draft);  // of a migration that was broken off
  write_copy(database, draft);
  if (!std::filesystem::exists(copy)) {
    std::filesystem::rename(draft, copy);
    return;
  }
  const bool same = read_file(draft) == read_file(copy);
  std::filesystem::remove(draft);
  if (!same) {
    throw StoreError(database.refusal("cannot be brought to this version: its backup " +
                                      copy.string() + " exists already; move that away"));
  }
}

}  // namespace

void write_copy(const Database& database, const std::filesystem::path& to) {
  SQLite::Database target(to.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  if (SQLite::Backup(target, database.connection()).executeStep(-1) != SQLITE_DONE) {
    throw StoreError(database.refusal(
        "cannot be copied, because another program uses it; close it there, and try again"));
  }
}

std::span<const Migration> migrations() {
  return kMigrations;
}

int schema_version(const Database& database) {
  return database.connection().execAndGet("PRAGMA user_version").getInt();
}

std::filesystem::path backup_path(const std::filesystem::path& database, int version) {
  return database.string() + ".v" + std::to_string(version) + ".backup";
}

void migrate(const Database& database, std::span<const Migration> steps) {
  database.run([&] {
    const int version = schema_version(database);
    if (version >= static_cast<int>(steps.size())) return;
    if (version > 0) back_up(database, version);
    SQLite::Transaction transaction = database.write_transaction();
    for (const Migration step : steps.subspan(static_cast<std::size_t>(version))) {
      step(database.connection());
    }
    database.connection().exec("PRAGMA user_version = " + std::to_string(steps.size()));
    transaction.commit();
    if (version > 0) database.checkpoint();
  });
}

}  // namespace touchtrial::store
