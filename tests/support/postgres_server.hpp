/// \file A real PostgreSQL server for tests: a cluster of its own in a temporary folder, on a Unix
/// socket and nothing else.
#pragma once

#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchtrial::testing {

/// Starts with the object and ends with it, and with the test's process however that ends. Run as
/// root it belongs to the user postgres, as PostgreSQL refuses root.
class PostgresServer {
 public:
  enum class Writes { safe, unsafe };  ///< unsafe: without fsync, for tests that kill nothing

  static constexpr const char* kAdministrator = "postgres";

  /// \throws std::runtime_error if PostgreSQL is not installed or does not start; with the remedy
  explicit PostgresServer(Writes writes = Writes::unsafe);
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Makes a new, empty database.
  void make_database(const std::string& name);
  /// Executes statements in a database as the administrator.
  /// \return the first column of the result's rows
  std::vector<std::string> ask(const std::string& database, const std::string& sql) const;

  /// postgresql:// address of a database.
  [[nodiscard]] std::string url(const std::string& database,
                                const std::string& user = kAdministrator) const;
  /// Where its socket lies.
  [[nodiscard]] std::filesystem::path socket_folder() const { return folder_.path() / "socket"; }

  /// Every process of it dies at once, as if by a power cut.
  void kill();
  /// After kill(): comes back with what it had on disk.
  void start();

 private:
  void initialise() const;
  [[nodiscard]] pid_t launch(const std::vector<std::string>& arguments) const;
  void run(const std::vector<std::string>& arguments) const;
  [[nodiscard]] bool answers() const;

  Writes writes_;
  TempFolder folder_;
  std::filesystem::path programs_;
  pid_t process_ = -1;
};

}  // namespace touchtrial::testing
