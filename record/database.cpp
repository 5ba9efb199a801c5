#include "record/database.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>

#include <SQLiteCpp/Backup.h>
#include <sqlite3.h>
#include <unistd.h>

namespace touchtrial::record {
namespace {

constexpr int kBusyTimeoutMs = 2000;
/// A connection is used by one thread at a time.
constexpr int kNoMutex = SQLITE_OPEN_NOMUTEX;
/// Distinguishes Touchtrial's databases from other SQLite files: "TTRL" in SQLite's application_id.
constexpr std::int32_t kApplicationId = 0x5454524c;

// The first hundred bytes of an SQLite file, read without SQLite.
// Source: "Database File Format", section 1.3, https://www.sqlite.org/fileformat2.html
constexpr char kSqliteMagic[] = "SQLite format 3";  // its final zero is part of it
using Header = std::array<unsigned char, 100>;

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& reason) {
  throw StoreError(one_line(path.string()) + ": " + reason);
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, const std::string& reason) {
  throw DamagedStore(one_line(path.string()) + ": " + reason + "; restore it from a backup");
}

Header read_header(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    refuse_file(path,
                "no such database; check the name; `touchtrial run` and `touchtrial simulate` "
                "create one [no-database]");
  }
  if (std::filesystem::is_directory(status))
    refuse_file(path, "is a folder; name a database in it");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_file(path, "cannot be read; check its permissions");
  Header header{};
  file.read(reinterpret_cast<char*>(header.data()), header.size());
  const bool is_complete = file.gcount() == static_cast<std::streamsize>(header.size());
  if (!is_complete || std::memcmp(header.data(), kSqliteMagic, sizeof kSqliteMagic) != 0) {
    refuse_file(path, "is not a Touchtrial database; check the name [not-a-database]");
  }
  return header;
}

std::uint32_t big_endian_32(const Header& header, std::size_t offset) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = (number << 8U) | header[offset + i];
  return number;
}

std::uintmax_t size_in_header(const Header& header) {
  const unsigned stored = (unsigned{header[16]} << 8U) | header[17];
  const std::uintmax_t page_size = stored == 1 ? 65536 : stored;
  return page_size * big_endian_32(header, 28);
}

/// Whether there is a non-empty write-ahead log beside the database.
bool has_log(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path.string() + "-wal", error);
  return !error && size > 0;
}

/// Checks a file before SQLite opens it, so that a foreign or truncated file, or one of another
/// version, is refused untouched.
void check_header(const std::filesystem::path& path) {
  const Header header = read_header(path);
  if (big_endian_32(header, 68) != static_cast<std::uint32_t>(kApplicationId)) {
    refuse_file(path,
                "is an SQLite database, but not Touchtrial's; check the name [not-a-database]");
  }
  const std::uint32_t version = big_endian_32(header, 60);
  if (version == 0) refuse_damaged(path, "has no version, so it is damaged");
  if (version != std::uint32_t{kSchemaVersion}) {
    refuse_file(path, "is a database of version " + std::to_string(version) + ", not " +
                          std::to_string(kSchemaVersion) + "; use the program that wrote it");
  }
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  // A log may hold pages that are not in the file yet.
  if (!error && size < size_in_header(header) && !has_log(path)) {
    refuse_damaged(path, "is truncated [truncated]");
  }
}

/// Makes a path absolute, because names such as ":memory:" are special in SQLite.
std::string absolute_name(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  return (error ? path : absolute.lexically_normal()).string();
}

bool is_writable(const std::filesystem::path& path) {
  const std::filesystem::path file = absolute_name(path);
  return ::access(file.c_str(), W_OK) == 0 &&
         ::access(file.parent_path().c_str(), W_OK | X_OK) == 0;
}

/// The URI of a file without writers, for which SQLite needs neither locks nor files beside it.
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

/// To read a database in WAL mode, SQLite needs a log and its index beside it. In a writable folder
/// it creates and removes them, and we see what other programs add. In a read-only folder, a file
/// without a log is complete and can be read as it is.
SQLite::Database open_connection(const std::filesystem::path& path, Database::Mode mode) {
  if (mode == Database::Mode::read_write || is_writable(path)) {
    return {absolute_name(path), SQLite::OPEN_READWRITE | kNoMutex, kBusyTimeoutMs};
  }
  if (!has_log(path)) {
    return {immutable_uri(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI | kNoMutex,
            kBusyTimeoutMs};
  }
  return {absolute_name(path), SQLite::OPEN_READONLY | kNoMutex, kBusyTimeoutMs};
}

/// Requires that a setting is in force. SQLite does not refuse an unsupported setting, but reports
/// the one in force.
void require_setting(const Database& database, const std::string& name, const std::string& expected,
                     const std::string& remedy) {
  const std::string actual = database.connection().execAndGet("PRAGMA " + name).getString();
  if (actual == expected) return;
  throw StoreError(database.refusal("cannot be written safely (" + name + " gives " + actual +
                                    ", not " + expected + "); " + remedy));
}

/// Makes commits durable, because acknowledged events must be on the disk (docs/evidence.md).
void set_up_for_writing(const Database& database) {
  // A whole session fits into the cache (KiB), so that no page is written before its commit.
  database.connection().exec(
      "PRAGMA synchronous = FULL; PRAGMA secure_delete = ON; PRAGMA cache_size = -16384;");
  require_setting(database, "journal_mode = WAL", "wal", "keep it in a folder on a local disk");
  const std::string remedy = "use a program whose SQLite has this setting";
  require_setting(database, "synchronous", "2", remedy);
  require_setting(database, "secure_delete", "1", remedy);
}

void set_up_common(const Database& database) {
  database.connection().exec(
      "PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;");
}

void set_up(const Database& database, Database::Mode mode) {
  set_up_common(database);
  if (mode == Database::Mode::read_only) {
    // A report reads nearly every page only once, so a larger cache would only use more memory.
    database.connection().exec("PRAGMA query_only = ON; PRAGMA cache_size = 64;");
  } else {
    set_up_for_writing(database);
  }
}

/// Describes what failed, and the remedy.
/// \param code  SQLite's primary result code
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
      return "cannot be opened; check that its folder exists and is writable, and that no -wal "
             "file "
             "is left beside it";
    case SQLITE_NOMEM:
      return "needs more memory than there is; close other programs";
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
  if (primary_code == SQLITE_BUSY || primary_code == SQLITE_LOCKED) throw LockedStore(line);
  throw StoreError(line);
}

/// Creates the file exclusively: if two programs create it at once, one of them is refused.
void make_empty_file(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "wbx");
  if (file == nullptr) {
    const bool exists = errno == EEXIST;
    throw StoreError(one_line(path.string()) +
                     (exists
                          ? ": already exists; choose another name or continue with it"
                          : ": cannot be created; check that its folder exists and is writable"));
  }
  std::fclose(file);
}

/// Refuses a file with several names, because the log is beside only one of them. Opened by another
/// name, the database would lack acknowledged events.
void refuse_second_name(const std::filesystem::path& path) {
  std::error_code error;
  const auto names = std::filesystem::hard_link_count(path, error);
  if (error || names == 1) return;
  refuse_file(path, "has " + std::to_string(names) +
                        " names (hard links), and cannot be used for recording; copy it to a new "
                        "file, and move that to this name");
}

/// Refuses an address in place of a file. The message does not repeat the address, which may
/// contain a password.
void refuse_address(const std::filesystem::path& path) {
  if (path.string().find("://") == std::string::npos) return;
  throw StoreError(
      "an address is not a file: create one with `touchtrial merge ADDRESS -o "
      "all.db`");
}

}  // namespace

Query& Query::bind(ByteView blob) {
  if (blob.size() > std::size_t{std::numeric_limits<int>::max()}) {
    throw StoreError("a trace is larger than a database can hold; shorten trials.explore_limit_s");
  }
  // A null pointer would be stored as NULL, which our columns do not allow.
  const void* data = blob.empty() ? static_cast<const void*>("") : blob.data();
  statement_->bindNoCopy(++bound_, data, static_cast<int>(blob.size()));
  return *this;
}

ByteView Query::blob_view(int column) const {
  const SQLite::Column value = statement_->getColumn(column);
  // The pointer is read first, because reading the size may convert a value of another type.
  const auto* data = static_cast<const std::uint8_t*>(value.getBlob());
  const auto size = static_cast<std::size_t>(value.getBytes());
  return data == nullptr ? ByteView() : ByteView(data, size);
}

Database Database::create(const std::filesystem::path& path) {
  refuse_address(path);
  make_empty_file(path);
  try {
    Database database(path, open_connection(path, Mode::read_write));
    // Large pages suit large traces. An empty file need not be durable yet: the first transaction's
    // sync covers it.
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
    set_up_common(database);
    database.write_unsynced();
    return database;
  } catch (const SQLite::Exception& error) {
    rethrow(name, error);
  }
}

Database Database::open(const std::filesystem::path& path, Mode mode) {
  refuse_address(path);
  check_header(path);
  if (mode == Mode::read_write) refuse_second_name(path);
  try {
    Database database(path, open_connection(path, mode));
    if (mode == Mode::read_write &&
        sqlite3_db_readonly(database.connection_.getHandle(), "main") == 1) {
      throw StoreError(
          database.refusal("cannot be written; check its permissions and those of its folder"));
    }
    set_up(database, mode);
    // SQLite opens files lazily: reading the schema reveals faults of the file.
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

void Database::write_unsynced() const {
  connection_.exec("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
}

void Database::write_safely() const {
  // With this setting, the change of journal mode below syncs everything written before.
  connection_.exec("PRAGMA synchronous = FULL;");
  set_up_for_writing(*this);
}

bool Database::checkpoint() const {
  Query query = separate_query("PRAGMA wal_checkpoint(TRUNCATE)");
  return query.step() && query.integer(0) == 0;
}

void Database::copy_to(const std::filesystem::path& path) const {
  SQLite::Database target(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  if (SQLite::Backup(target, connection_).executeStep(-1) != SQLITE_DONE) {
    throw StoreError(refusal(
        "cannot be copied, because another program uses it; close it there, and try again"));
  }
}

std::string Database::refusal(const std::string& text) const {
  return one_line(path_.string() + ": " + text);
}

void Database::refuse(const SQLite::Exception& error) const {
  rethrow(path_, error);
}

}  // namespace touchtrial::record
