/// \file One SQLite connection: how it is opened, its prepared statements, its errors.
/// Private to protocols/store: with query.hpp the only headers here that show SQLiteCpp.
#pragma once

#include "core/errors.hpp"
#include "protocols/store/event_fault.hpp"
#include "protocols/store/query.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Transaction.h>

namespace touchtrial::store {

/// Not to be shared between threads.
class Database {
 public:
  enum class Mode { read_only, read_write };

  /// A new, empty database of ours, without tables. \throws StoreError if the file exists
  [[nodiscard]] static Database create(const std::filesystem::path& path);

  /// An empty one that SQLite keeps to itself, in memory and in a file without a name, which is
  /// gone with the connection or the program. \param name  for messages
  [[nodiscard]] static Database temporary(const std::string& name);

  /// An existing one. For reading it leaves no files behind and works in a folder that cannot be
  /// written, if the file has no log beside it.
  /// \param newest_version  the newest schema that the program knows
  /// \throws StoreError if it is missing, none of ours, damaged, newer or too old (see
  ///   check_header)
  [[nodiscard]] static Database open(const std::filesystem::path& path, Mode mode,
                                     int newest_version);

  Database(Database&&) = default;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] SQLite::Database& connection() const { return connection_; }

  /// A prepared statement, compiled once. \param sql  lives as long as the program
  [[nodiscard]] Query query(const char* sql) const;
  /// One of its own, for loops whose body may ask anything else of this database.
  [[nodiscard]] Query separate_query(const char* sql) const;

  /// For filling a file that nobody knows yet, and that is thrown away if anything fails: without a
  /// log, and without waiting for the disk.
  void write_carelessly() const;
  /// After write_carelessly: from now on as every database of ours, with all of it on the disk.
  void write_safely() const;

  /// A transaction that holds the write lock from its beginning; rolled back unless committed.
  [[nodiscard]] SQLite::Transaction write_transaction() const;

  /// Moves what the write-ahead log holds into the file and empties the log.
  /// \return whether nobody else kept it from doing so
  bool checkpoint() const;

  /// Calls `work`; errors of SQLite and of events come out as StoreError with file and remedy.
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

  /// "<file>: <text>" on one line.
  [[nodiscard]] std::string refusal(const std::string& text) const;

 private:
  Database(std::filesystem::path path, SQLite::Database connection)
      : path_(std::move(path)), connection_(std::move(connection)) {}

  [[noreturn]] void refuse(const SQLite::Exception& error) const;

  std::filesystem::path path_;
  // Reading changes a connection's state, but not what it stands for.
  mutable SQLite::Database connection_;
  mutable std::map<std::string_view, SQLite::Statement> statements_;
};

}  // namespace touchtrial::store
