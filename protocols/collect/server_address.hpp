/// \file Where a PostgreSQL server is: postgresql:// addresses, without passwords.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial::collect {

/// Whether a place is an address and no file: everything with "://" is, so that a scheme that was
/// mistyped is not taken for a file name and repeated, password and all.
[[nodiscard]] bool is_address(std::string_view where);

/// A postgresql:// address, as libpq reads it. The password is not part of it: libpq takes that
/// from PGPASSWORD, PGPASSFILE, ~/.pgpass or a service file.
class ServerAddress {
 public:
  /// \throws UsageError if `where` is no such address or holds a password; the message repeats
  ///   nothing of it
  explicit ServerAddress(const std::string& where);

  /// For libpq: "name='value' ...". Bounded in how long it waits, unless the address says
  /// otherwise.
  [[nodiscard]] const std::string& connection_string() const noexcept { return connection_; }
  /// For people: server and database, without user. One line.
  [[nodiscard]] const std::string& shown() const noexcept { return shown_; }

 private:
  std::string connection_;
  std::string shown_;
};

}  // namespace touchtrial::collect
