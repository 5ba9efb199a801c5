/// \file A database as the first schema had it, made by SQL as it stood then.
#pragma once

#include "protocols/store/store_fixture.hpp"

#include <filesystem>
#include <string>

#include <SQLiteCpp/Database.h>

namespace touchtrial::fixture {

inline constexpr const char* kFirstSchema = R"sql(
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

/// A study of the first schema with what `study` holds, which must be closed and hold nothing that
/// came later.
inline void write_first_version(const std::filesystem::path& path,
                                const std::filesystem::path& study) {
  SQLite::Database old(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  old.exec("PRAGMA page_size = 8192; PRAGMA application_id = 0x5454524c; PRAGMA user_version = 1;");
  old.exec("PRAGMA journal_mode = WAL");
  old.exec(kFirstSchema);
  old.exec("ATTACH DATABASE '" + study.string() + "' AS now");
  old.exec(
      "INSERT INTO main.events SELECT session, sequence, kind, at_ns, body, sealed, previous, hash "
      "FROM now.events");
  for (const char* const table : {"traces", "participant_keys"}) {
    old.exec(std::string("INSERT INTO main.") + table + " SELECT * FROM now." + table);
  }
  old.exec(
      "INSERT INTO main.sessions SELECT session, participant, enrolment, state, simulated, pilot, "
      "excluded, withdrawn, device FROM now.sessions;"
      "INSERT INTO main.trials SELECT session, trial, block, state, presented_at_ns, "
      "contact_at_ns, valid, overruns, samples, rate_hz FROM now.trials;"
      "INSERT INTO main.responses SELECT * FROM now.responses;");
}

}  // namespace touchtrial::fixture
