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
class ServerAddress {
 public:
  /// \throws UsageError if `where` is no such address or holds a password; the message does not
  ///   repeat any of it
  explicit ServerAddress(const std::string& where);

  /// For libpq: "name='value' ...". It limits how long libpq waits, unless the address says
  /// otherwise.
  [[nodiscard]] const std::string& connection_string() const noexcept { return connection_; }
  /// For people: server and database without the user, on one line.
  [[nodiscard]] const std::string& shown() const noexcept { return shown_; }

 private:
  std::string connection_;
  std::string shown_;
};

}  // namespace touchtrial::collect
