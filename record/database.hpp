/// \file One SQLite connection: how it is opened, its prepared statements, transactions and errors.
/// Private to record: the only header here that shows SQLiteCpp.
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
  explicit Query(std::unique_ptr<SQLite::Statement> owned)
      : owned_(std::move(owned)), statement_(owned_.get()) {}
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
  /// Empty: NULL.
  template <typename Value>
  Query& bind(const std::optional<Value>& value) {
    if (value) return bind(*value);
    statement_->bind(++bound_);
    return *this;
  }

  /// \return whether there is another row
  [[nodiscard]] bool step() { return statement_->executeStep(); }
  /// For statements without rows.
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
  /// Without a copy: until the next step, or until the column is asked for again.
  [[nodiscard]] ByteView blob_view(int column) const;
  [[nodiscard]] bool is_null(int column) const { return statement_->isColumnNull(column); }

 private:
  std::unique_ptr<SQLite::Statement> owned_;
  SQLite::Statement* statement_;
  int bound_ = 0;
};

/// The version of databases, raised at every change of the tables or their content.
inline constexpr int kSchemaVersion = 8;

/// Not to be shared between threads.
class Database {
 public:
  enum class Mode { read_only, read_write };

  /// A new, empty database with our application id, without tables.
  /// \throws StoreError if the file exists
  [[nodiscard]] static Database create(const std::filesystem::path& path);

  /// An empty private database in memory and in an unnamed file, which disappears with the
  /// connection or the program.
  /// \param name  for messages
  [[nodiscard]] static Database temporary(const std::string& name);

  /// An existing database. If it is opened for reading and no log lies beside it, no files are left
  /// behind and its folder need not be writable.
  /// \throws DamagedStore if it is truncated, has no version or cannot be read by SQLite
  /// \throws StoreError if it is missing, not a Touchtrial database, or of another version than
  ///   kSchemaVersion; it is then untouched
  [[nodiscard]] static Database open(const std::filesystem::path& path, Mode mode);

  Database(Database&&) = default;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] SQLite::Database& connection() const { return connection_; }

  /// A prepared statement, compiled once.
  /// \param sql  lives as long as the program
  [[nodiscard]] Query query(const char* sql) const;
  /// A separate statement, for loops whose body may run other queries on this database.
  [[nodiscard]] Query separate_query(const char* sql) const;

  /// For filling a draft, which is discarded if anything fails: without a log, and without waiting
  /// for the disk.
  void write_unsynced() const;
  /// After write_unsynced: syncs everything, and writes durably from now on.
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
