/// \file One connection to a PostgreSQL server, whose answers are bounded in time and size: a server
/// may be broken or hostile, be silent for ever or never come to an end. Private to
/// record/merging.
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

/// By libpq's keywords.
using ConnectionOptions = std::map<std::string, std::string>;

/// What an address says. To another machine the connection is encrypted, and the server proves its
/// name with a certificate (sslmode=verify-full); connections by a Unix socket, or to localhost,
/// 127.0.0.1 and ::1, are as libpq makes them. The address alone says where the server is:
/// PGHOST, PGHOSTADDR and PGSERVICE are taken out of the environment, which no other thread may
/// read.
/// \throws UsageError if `where` is no such address, holds a password, or asks for less than
///   verify-full to another machine; the message does not repeat any of it
[[nodiscard]] ConnectionOptions connection_options(const std::string& where);

/// What one answer may take.
struct AnswerLimits {
  std::chrono::milliseconds silence = std::chrono::minutes(5);  ///< nothing sent or received
  std::chrono::milliseconds whole = std::chrono::minutes(30);   ///< from the question to the end
  std::uint64_t bytes = std::uint64_t{129} << 20U;              ///< as they travel
};

using SqlRows = std::unique_ptr<PGresult, decltype(&PQclear)>;
/// A text or BYTEA, as long as the rows live.
[[nodiscard]] ByteView value_at(const SqlRows& rows, int row, int column);

/// Not to be shared between threads, nor to be used after it threw. Every function throws
/// StoreError, naming server and remedy, if the server cannot be reached or refuses, does not prove
/// its name, or passes the limits.
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
  [[nodiscard]] std::jthread break_off_too_large();
  [[noreturn]] void refuse(const std::string& what, const char* reason) const;

  AnswerLimits limits_;
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_{nullptr, PQfinish};
  std::string shown_;
  // Of the question that is waited for.
  std::atomic<bool> is_too_large_{false};
  Clock::time_point began_;
  Clock::time_point moved_;  ///< when the socket was last ready
};

}  // namespace touchtrial::merging
