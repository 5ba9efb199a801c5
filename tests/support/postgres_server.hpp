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
  enum class Passwords { none_asked, scram };  ///< scram: asked of everybody but `kAdministrator`

  static constexpr const char* kAdministrator = "postgres";

  /// \throws std::runtime_error if PostgreSQL is not installed or does not start; with the remedy
  explicit PostgresServer(Writes writes = Writes::unsafe,
                          Passwords passwords = Passwords::none_asked);
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Makes a new, empty database.
  /// \param encoding  of its texts
  void make_database(const std::string& name, const std::string& encoding = "UTF8");
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
  /// After kill() or stop(): comes back with what it had on disk.
  void start();
  /// In good order, ending connections.
  void stop();

 private:
  void initialise() const;
  [[nodiscard]] pid_t launch(const std::vector<std::string>& arguments) const;
  void run(const std::vector<std::string>& arguments) const;
  [[nodiscard]] bool answers() const;

  Writes writes_;
  Passwords passwords_;
  TempFolder folder_;
  std::filesystem::path programs_;
  pid_t process_ = -1;
};

}  // namespace touchtrial::testing
