#include "protocols/store/database.hpp"

#include "protocols/store/damaged_store.hpp"
#include "protocols/store/database_header.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>

#include <sqlite3.h>
#include <unistd.h>

namespace touchtrial::store {
namespace {

constexpr int kBusyTimeoutMs = 2000;

/// Absolute, because SQLite gives names such as ":memory:" a meaning of their own.
std::string absolute_name(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  return (error ? path : absolute.lexically_normal()).string();
}

bool may_write(const std::filesystem::path& path) {
  const std::filesystem::path file = absolute_name(path);
  return ::access(file.c_str(), W_OK) == 0 &&
         ::access(file.parent_path().c_str(), W_OK | X_OK) == 0;
}

/// For a file that nobody is writing to: read without locks and without files beside it.
std::string immutable_uri(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : absolute_name(path)) {
    std::array<char, 4> escaped{c};
    if (c == '%' || c == '?' || c == '#') {
      std::snprintf(escaped.data(), escaped.size(), "%%%02X", static_cast<unsigned>(c));
    }
    uri += escaped.data();
  }
  return uri + "?immutable=1";
}

/// Reading a database in WAL mode takes a log and its index beside it. Where we may write, SQLite
/// makes and removes them, and what other programs add is seen; where we may not, a file without a
/// log is complete and can be read as it is.
SQLite::Database connected(const std::filesystem::path& path, Database::Mode mode) {
  if (mode == Database::Mode::read_write || may_write(path)) {
    return {absolute_name(path), SQLite::OPEN_READWRITE, kBusyTimeoutMs};
  }
  if (!has_log(path)) {
    return {immutable_uri(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI, kBusyTimeoutMs};
  }
  return {absolute_name(path), SQLite::OPEN_READONLY, kBusyTimeoutMs};
}

/// SQLite does not refuse a setting that it cannot have: it says which one it has.
void require_setting(const Database& database, const std::string& name, const std::string& wanted,
                     const std::string& remedy) {
  const std::string had = database.connection().execAndGet("PRAGMA " + name).getString();
  if (had == wanted) return;
  throw StoreError(database.refusal("cannot be written safely (" + name + " gives " + had +
                                    ", not " + wanted + "); " + remedy));
}

/// An event that is acknowledged must be on the disk: see docs/durability.md.
void set_up_for_writing(const Database& database) {
  database.connection().exec("PRAGMA synchronous = FULL; PRAGMA secure_delete = ON;");
  require_setting(database, "journal_mode = WAL", "wal", "keep it in a folder on a local disk");
  const std::string remedy = "use a program whose SQLite has this setting";
  require_setting(database, "synchronous", "2", remedy);
  require_setting(database, "secure_delete", "1", remedy);
}

void set_up_for_all(const Database& database) {
  database.connection().exec(
      "PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;");
}

void set_up(const Database& database, Database::Mode mode) {
  set_up_for_all(database);
  if (mode == Database::Mode::read_only) {
    database.connection().exec("PRAGMA query_only = ON;");
  } else {
    set_up_for_writing(database);
  }
}

/// What failed and what to do about it, from SQLite's primary result code.
std::string explanation(int code, const std::string& message) {
  switch (code) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is in use by another program; close it there, or wait, and try again";
    case SQLITE_READONLY:
      return "cannot be written; open it for writing, and check its permissions and those of its "
             "folder";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "is damaged (" + message + "); restore it from a backup";
    case SQLITE_FULL:
      return "cannot grow; free space on its disk";
    case SQLITE_CANTOPEN:
      return "cannot be opened; check that its folder exists and may be written, and no -wal file "
             "was left beside it";
    case SQLITE_IOERR:
      return "reading or writing failed (" + message + "); check the disk";
    default:
      return "refused by the database (" + message +
             "); it may be damaged, restore it from a backup";
  }
}

[[noreturn]] void rethrow(const std::filesystem::path& path, const SQLite::Exception& error) {
  const int primary_code = error.getErrorCode() & 0xff;
  const std::string line = one_line(path.string() + ": " + explanation(primary_code, error.what()));
  if (primary_code == SQLITE_CORRUPT || primary_code == SQLITE_NOTADB) throw DamagedStore(line);
  throw StoreError(line);
}

/// Made exclusively: of two programs that create it at once, one is refused.
void make_empty_file(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "wbx");
  if (file == nullptr) {
    const bool exists = errno == EEXIST;
    throw StoreError(one_line(path.string()) +
                     (exists
                          ? ": exists already; choose another name or continue with it"
                          : ": cannot be made; check that its folder exists and may be written"));
  }
  std::fclose(file);
}

/// Nothing of it is repeated: there may be a password in it.
void refuse_address(const std::filesystem::path& path) {
  if (path.string().find("://") == std::string::npos) return;
  throw StoreError(
      "an address is no file: a study on a server is written by sync, and read by report, export, "
      "verify and merge");
}

}  // namespace

Database Database::create(const std::filesystem::path& path) {
  refuse_address(path);
  make_empty_file(path);
  try {
    Database database(path, connected(path, Mode::read_write));
    // Large pages suit large traces; the application_id tells our files from others. A file that
    // holds nothing need not be safe yet: the first transaction's sync covers this.
    database.connection_.exec("PRAGMA synchronous = OFF; PRAGMA page_size = 8192;");
    database.connection_.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
    set_up(database, Mode::read_write);
    return database;
  } catch (const SQLite::Exception& error) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    rethrow(path, error);
  }
}

Database Database::temporary(const std::string& name) {
  try {
    Database database(name, SQLite::Database("", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE));
    database.connection_.exec("PRAGMA page_size = 8192;");
    set_up_for_all(database);
    database.write_carelessly();
    return database;
  } catch (const SQLite::Exception& error) {
    rethrow(name, error);
  }
}

Database Database::open(const std::filesystem::path& path, Mode mode, int newest_version) {
  refuse_address(path);
  check_header(path, newest_version);
  try {
    Database database(path, connected(path, mode));
    if (mode == Mode::read_write &&
        sqlite3_db_readonly(database.connection_.getHandle(), "main") == 1) {
      throw StoreError(
          database.refusal("cannot be written; check its permissions and those of its folder"));
    }
    set_up(database, mode);
    // SQLite opens files lazily: what is wrong with this one shows when its schema is read.
    database.connection_.execAndGet("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const SQLite::Exception& error) {
    rethrow(path, error);
  }
}

Query Database::query(const char* sql) const {
  auto found = statements_.find(sql);
  if (found == statements_.end()) {
    found = statements_.try_emplace(sql, connection_, sql).first;
  }
  return Query(found->second);
}

Query Database::separate_query(const char* sql) const {
  return Query(std::make_unique<SQLite::Statement>(connection_, sql));
}

void Database::write_carelessly() const {
  connection_.exec("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
}

void Database::write_safely() const {
  // The first of these makes the change to the second reach the disk, and all before it.
  connection_.exec("PRAGMA synchronous = FULL;");
  set_up_for_writing(*this);
}

SQLite::Transaction Database::write_transaction() const {
  return SQLite::Transaction(connection_, SQLite::TransactionBehavior::IMMEDIATE);
}

bool Database::checkpoint() const {
  Query query = separate_query("PRAGMA wal_checkpoint(TRUNCATE)");
  return query.step() && query.integer(0) == 0;
}

std::string Database::refusal(const std::string& text) const {
  return one_line(path_.string() + ": " + text);
}

void Database::refuse(const SQLite::Exception& error) const {
  rethrow(path_, error);
}

}  // namespace touchtrial::store
