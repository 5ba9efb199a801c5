/// \file Where a PostgreSQL server is: postgresql:// addresses, without passwords.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial::collect {

/// Whether a place is an address and not a file: everything with "://" is. So no address with a
/// mistyped scheme is taken for a file name and repeated with its password.
[[nodiscard]] bool is_address(std::string_view where);

/// A postgresql:// address, as libpq reads it, without a password: libpq takes that from
/// PGPASSWORD, PGPASSFILE, ~/.pgpass or a service file.
///
/// To another machine the connection is encrypted, and the server proves its name with a
/// certificate (sslmode=verify-full), whatever environment and service files say. Source:
/// PostgreSQL 15, "34.19. SSL Support". Connections by a Unix socket, or to localhost, 127.0.0.0/8
/// and ::1, stay on this machine, and are as libpq makes them.
class ServerAddress {
 public:
  /// Not to be called while another thread reads the environment.
  /// \throws UsageError if `where` is no such address, holds a password, or asks for less than
  ///   verify-full to another machine; the message does not repeat any of it
  /// \throws FileError if others may read the file of passwords or a service file with one
  explicit ServerAddress(const std::string& where);

  /// For libpq: "name='value' ...". It limits how long libpq waits for a connection.
  [[nodiscard]] const std::string& connection_string() const noexcept { return connection_; }
  /// For people: server and database without the user, on one line.
  [[nodiscard]] const std::string& shown() const noexcept { return shown_; }
  /// Whether every server of the address is this machine.
  [[nodiscard]] bool is_local() const noexcept { return is_local_; }

 private:
  std::string connection_;
  std::string shown_;
  bool is_local_ = false;
};

}  // namespace touchtrial::collect
