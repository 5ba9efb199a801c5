/// \file One SQLite connection: opening, prepared statements, transactions and errors. Private to
/// record; the only header that includes SQLiteCpp.
#pragma once

#include "core/bytes.hpp"
#include "record/damage.hpp"

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

namespace touchtrial::record {

/// A prepared statement in use. Binds parameters from left to right, then steps through rows. Its
/// destructor resets the statement, so that no read transaction stays open. Blobs are not copied:
/// they must live until the last step.
class Query {
 public:
  explicit Query(SQLite::Statement& statement) : statement_(&statement) {}
  explicit Query(std::unique_ptr<SQLite::Statement> statement)
      : owned_(std::move(statement)), statement_(owned_.get()) {}
  ~Query() { statement_->tryReset(); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  template <std::integral Number>
  Query& bind(Number value) {
    statement_->bind(++bound_, std::int64_t{value});
    return *this;
  }
  Query& bind(std::string_view text) {
    statement_->bind(++bound_, std::string(text));
    return *this;
  }
  Query& bind(ByteView blob);
  /// Binds NULL if the value is empty.
  template <typename Value>
  Query& bind(const std::optional<Value>& value) {
    if (value) return bind(*value);
    statement_->bind(++bound_);
    return *this;
  }

  /// \return whether there is another row
  [[nodiscard]] bool step() { return statement_->executeStep(); }
  /// Runs a statement without rows.
  void run() { statement_->exec(); }

  [[nodiscard]] std::int64_t integer(int column) const {
    return statement_->getColumn(column).getInt64();
  }
  [[nodiscard]] std::string text(int column) const {
    return statement_->getColumn(column).getString();
  }
  [[nodiscard]] Bytes blob(int column) const {
    const ByteView bytes = blob_view(column);
    return {bytes.begin(), bytes.end()};
  }
  /// A view of the blob, valid until the next step or the next access to the column.
  [[nodiscard]] ByteView blob_view(int column) const;
  [[nodiscard]] bool is_null(int column) const { return statement_->isColumnNull(column); }

 private:
  std::unique_ptr<SQLite::Statement> owned_;
  SQLite::Statement* statement_;
  int bound_ = 0;
};

/// The version of databases, raised at every change of the tables or their content.
inline constexpr int kSchemaVersion = 8;

/// A connection to one database. Not thread-safe.
class Database {
 public:
  enum class Mode { read_only, read_write };

  /// Creates an empty database with Touchtrial's application id and no tables.
  /// \throws StoreError if the file exists
  [[nodiscard]] static Database create(const std::filesystem::path& path);

  /// Creates an empty private database in memory and an unnamed file, which is deleted with the
  /// connection.
  /// \param name  for messages
  [[nodiscard]] static Database temporary(const std::string& name);

  /// Opens an existing database. Reading a database without a log beside it leaves no files behind,
  /// and its folder need not be writable.
  /// \throws DamagedStore if it is truncated, has no version or cannot be read by SQLite
  /// \throws StoreError if it is missing, not a Touchtrial database, or of another version than
  ///   kSchemaVersion; it is then untouched
  [[nodiscard]] static Database open(const std::filesystem::path& path, Mode mode);

  Database(Database&&) = default;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] SQLite::Database& connection() const { return connection_; }

  /// A prepared statement, compiled once.
  /// \param sql  a string with static lifetime
  [[nodiscard]] Query query(const char* sql) const;
  /// A separate statement, for loops whose body may run other queries on this database.
  [[nodiscard]] Query separate_query(const char* sql) const;

  /// From now on, writes without a log and without syncing. For drafts, which are discarded if
  /// anything fails.
  void write_unsynced() const;
  /// Ends write_unsynced: syncs everything, and writes durably from now on.
  void write_safely() const;

  /// Moves the content of the write-ahead log into the file and empties the log.
  /// \return false if another program prevented it
  bool checkpoint() const;

  /// Writes a copy to a path.
  /// \throws StoreError if another program blocks reading
  void copy_to(const std::filesystem::path& path) const;

  /// Calls `work`; errors of SQLite and of events are rethrown as StoreError with file and remedy.
  template <typename Work>
  decltype(auto) run(Work&& work) const {
    try {
      return work();
    } catch (const SQLite::Exception& error) {
      refuse(error);
    } catch (const EventFault& fault) {
      throw StoreError(refusal(std::string(fault.what()) + "; restore it from a backup"));
    }
  }

  /// As `run`, in a transaction that holds the write lock from its beginning and is committed
  /// unless `work` throws.
  template <typename Work>
  void change(Work&& work) const {
    run([&] {
      SQLite::Transaction transaction(connection_, SQLite::TransactionBehavior::IMMEDIATE);
      work();
      transaction.commit();
    });
  }

  /// "<file>: <text>" on one line.
  [[nodiscard]] std::string refusal(const std::string& text) const;

 private:
  Database(std::filesystem::path path, SQLite::Database connection)
      : path_(std::move(path)), connection_(std::move(connection)) {}

  [[noreturn]] void refuse(const SQLite::Exception& error) const;

  std::filesystem::path path_;
  // mutable: reading changes the connection's state, but not the database.
  mutable SQLite::Database connection_;
  mutable std::map<std::string_view, SQLite::Statement> statements_;
};

}  // namespace touchtrial::record
