/// \file A real PostgreSQL server for tests: a cluster in a temporary folder that listens only on a
/// Unix socket.
#pragma once

#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchtrial::testing {

/// Runs during the object's lifetime, and never outlives the test's process. For root it runs as
/// the user postgres, because PostgreSQL refuses root.
class PostgresServer {
 public:
  enum class Writes { safe, unsafe };  ///< unsafe: without fsync, for tests without kill()

  static constexpr const char* kAdministrator = "postgres";

  /// \throws std::runtime_error if PostgreSQL is not installed or does not start; with the remedy
  explicit PostgresServer(Writes writes = Writes::unsafe);
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Creates an empty database.
  void make_database(const std::string& name);
  /// Executes statements in a database as the administrator.
  /// \return the first column of the result's rows
  std::vector<std::string> ask(const std::string& database, const std::string& sql) const;

  /// postgresql:// address of a database.
  [[nodiscard]] std::string url(const std::string& database,
                                const std::string& user = kAdministrator) const;
  [[nodiscard]] std::filesystem::path socket_folder() const { return folder_.path() / "socket"; }

  /// Kills all its processes, as a power cut would.
  void kill();
  /// Restarts after kill() with the data on disk.
  void start();

 private:
  void initialise() const;
  [[nodiscard]] pid_t launch(const std::vector<std::string>& arguments) const;
  void run(const std::vector<std::string>& arguments) const;
  [[nodiscard]] bool accepts_connections() const;

  Writes writes_;
  TempFolder folder_;
  std::filesystem::path programs_;
  pid_t process_ = -1;
};

}  // namespace touchtrial::testing
