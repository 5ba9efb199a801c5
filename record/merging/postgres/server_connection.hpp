/// \file One connection to a PostgreSQL server, with limits on the time and size of answers,
/// because a server may be broken or hostile. Private to record/merging.
#pragma once

#include "core/bytes.hpp"
#include "core/errors.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <libpq-fe.h>

namespace touchtrial::merging {

/// Options of a connection, by libpq's keywords.
using ConnectionOptions = std::map<std::string, std::string>;

/// Parses an address. Connections to another machine are encrypted, and a certificate verifies the
/// server's name (sslmode=verify-full). Connections by a Unix socket, or to localhost, 127.0.0.1 or
/// ::1, use libpq's defaults. Only the address locates the server: PGHOST, PGHOSTADDR and PGSERVICE
/// are removed from the environment, which no other thread may read meanwhile.
/// \throws UsageError, without the address, if it is invalid, contains a password, or allows less
///   than verify-full to another machine
[[nodiscard]] ConnectionOptions connection_options(const std::string& address);

/// Limits of one answer.
struct AnswerLimits {
  std::chrono::milliseconds silence = std::chrono::minutes(5);  ///< without traffic
  std::chrono::milliseconds total = std::chrono::minutes(30);   ///< from the request to the end
  std::uint64_t bytes = std::uint64_t{129} << 20U;              ///< on the wire
};

using SqlRows = std::unique_ptr<PGresult, decltype(&PQclear)>;
/// The value of a column of type text or BYTEA; valid as long as `rows`.
[[nodiscard]] ByteView value_at(const SqlRows& rows, int row, int column);

/// A connection to a server. Not thread-safe, and unusable after an exception. Every function
/// throws StoreError, with server and remedy, if the server cannot be reached, refuses, does not
/// verify its name, or exceeds the limits.
class ServerConnection {
 public:
  explicit ServerConnection(const ConnectionOptions& options, const AnswerLimits& limits = {});
  /// Executes one statement, in its own transaction.
  /// \param values  BYTEAs for $1, $2, ...
  SqlRows execute(const std::string& statement, const std::vector<ByteView>& values = {});
  /// Host, port and database, for messages.
  [[nodiscard]] const std::string& address() const noexcept { return address_; }

 private:
  using Clock = std::chrono::steady_clock;
  SqlRows next_result();
  void require_within_limits() const;
  /// Watches the answer until the thread is destroyed, and ends the connection if it is too large.
  [[nodiscard]] std::jthread abort_if_too_large();
  [[noreturn]] void refuse(const std::string& what, const char* reason) const;

  AnswerLimits limits_;
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_{nullptr, PQfinish};
  std::string address_;
  // The state of the pending request.
  std::atomic<bool> is_too_large_{false};
  Clock::time_point request_start_;
  Clock::time_point last_activity_;  ///< when the socket was last ready
};

}  // namespace touchtrial::merging
