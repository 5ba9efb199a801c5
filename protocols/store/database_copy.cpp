#include "protocols/store/database_copy.hpp"

#include "protocols/store/database.hpp"
#include "protocols/store/tables.hpp"

#include <system_error>

#include <SQLiteCpp/Backup.h>
#include <sqlite3.h>

namespace touchtrial::store {
namespace {

void write_copy(const Database& database, const std::filesystem::path& to) {
  SQLite::Database target(to.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  if (SQLite::Backup(target, database.connection()).executeStep(-1) != SQLITE_DONE) {
    throw StoreError(database.refusal(
        "cannot be copied, because another program uses it; close it there, and try again"));
  }
}

}  // namespace

void copy_database(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Database database = Database::open(from, Database::Mode::read_only, kSchemaVersion);
  std::filesystem::path draft = to;
  draft += ".part";
  std::error_code error;
  std::filesystem::remove(draft, error);  // of a copy that was broken off
  database.run([&] { write_copy(database, draft); });
  std::filesystem::rename(draft, to, error);
  if (error) {
    throw StoreError(one_line(to.string()) + ": cannot be written (" + error.message() +
                     "); give another folder or change its permissions");
  }
}

}  // namespace touchtrial::store
