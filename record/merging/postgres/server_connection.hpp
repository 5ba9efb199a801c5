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

/// Keyed by libpq's keywords.
using ConnectionOptions = std::map<std::string, std::string>;

/// Parses an address. To another machine the connection is encrypted, and a certificate verifies
/// the server's name (sslmode=verify-full); connections by a Unix socket, or to localhost,
/// 127.0.0.1 and ::1, have libpq's defaults. Only the address locates the server: PGHOST,
/// PGHOSTADDR and PGSERVICE are removed from the environment, which no other thread may read
/// meanwhile.
/// \throws UsageError if `where` is not such an address, holds a password, or allows less than
///   verify-full to another machine; the message does not repeat any of it
[[nodiscard]] ConnectionOptions connection_options(const std::string& where);

/// Limits of one answer.
struct AnswerLimits {
  std::chrono::milliseconds silence = std::chrono::minutes(5);  ///< nothing sent or received
  std::chrono::milliseconds whole = std::chrono::minutes(30);   ///< from the request to the end
  std::uint64_t bytes = std::uint64_t{129} << 20U;              ///< on the wire
};

using SqlRows = std::unique_ptr<PGresult, decltype(&PQclear)>;
/// A text or BYTEA, as long as the rows live.
[[nodiscard]] ByteView value_at(const SqlRows& rows, int row, int column);

/// Not to be shared between threads, nor to be used after it threw. Every function throws
/// StoreError, naming server and remedy, if the server cannot be reached or refuses, does not
/// verify its name, or exceeds the limits.
class ServerConnection {
 public:
  explicit ServerConnection(const ConnectionOptions& options, const AnswerLimits& limits = {});
  /// Runs one statement, in a transaction of its own.
  /// \param values  BYTEAs, $1 and following
  SqlRows ask(const std::string& statement, const std::vector<ByteView>& values = {});
  /// For messages: host, port and database.
  [[nodiscard]] const std::string& shown() const noexcept { return shown_; }

 private:
  using Clock = std::chrono::steady_clock;
  SqlRows next_result();
  void require_within_limits() const;
  /// Ends the connection once the answer is too large. It lasts as long as the result.
  [[nodiscard]] std::jthread abort_if_too_large();
  [[noreturn]] void refuse(const std::string& what, const char* reason) const;

  AnswerLimits limits_;
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_{nullptr, PQfinish};
  std::string shown_;
  // Of the pending request.
  std::atomic<bool> is_too_large_{false};
  Clock::time_point began_;
  Clock::time_point moved_;  ///< when the socket was last ready
};

}  // namespace touchtrial::merging
