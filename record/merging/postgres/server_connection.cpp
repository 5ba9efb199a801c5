#include "record/merging/postgres/server_connection.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>

#include <fmt/format.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace touchtrial::merging {
namespace {

/// Parses an address. Errors omit libpq's message, which repeats the address.
ConnectionOptions parse_address(const std::string& address) {
  const bool is_postgres =
      address.starts_with("postgresql://") || address.starts_with("postgres://");
  const std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)> all(
      is_postgres ? PQconninfoParse(address.c_str(), nullptr) : nullptr, PQconninfoFree);
  if (!all) {
    throw UsageError(
        "this is not the address of a PostgreSQL database; write postgresql://USER@HOST/DATABASE");
  }
  ConnectionOptions options;
  for (const PQconninfoOption* option = all.get(); option->keyword != nullptr; ++option) {
    if (option->val != nullptr) options[option->keyword] = option->val;
  }
  return options;
}

/// If an IP address is given (hostaddr), libpq connects to it, and uses the name only for the
/// certificate. A list of servers counts as another machine.
bool is_this_machine(const std::string& host, const std::string& ip_address) {
  const std::string& place = ip_address.empty() ? host : ip_address;
  const bool is_socket = place.empty() || place.front() == '/' || place.front() == '@';
  const bool is_list = place.find(',') != std::string::npos;
  return !is_list && (is_socket || place == "localhost" || place == "127.0.0.1" || place == "::1");
}

/// Returns 0 for a Unix socket, whose bytes the kernel does not count.
std::uint64_t bytes_received(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  return info.tcpi_bytes_received;
}

}  // namespace

ConnectionOptions connection_options(const std::string& address) {
  ConnectionOptions options = parse_address(address);
  for (const char* const name : {"password", "sslpassword", "service"}) {
    if (!options.contains(name)) continue;
    throw UsageError(
        "the address contains a password, which every user of this machine can read in the list of "
        "programs, or names a service; remove it, and put a new password into ~/.pgpass");
  }
  for (const char* const name : {"PGHOST", "PGHOSTADDR", "PGSERVICE"}) ::unsetenv(name);
  if (!is_this_machine(options["host"], options["hostaddr"])) {
    // Options in the address override the environment; GSSAPI would replace TLS.
    const bool is_verified =
        options.emplace("sslmode", "verify-full").first->second == "verify-full" &&
        options.emplace("gssencmode", "disable").first->second == "disable";
    if (!is_verified) {
      throw UsageError(
          "the address allows less than sslmode=verify-full to another machine, so that others "
          "could read and alter the study; write ?sslmode=verify-full without gssencmode, and "
          "&sslrootcert=FILE with the certificate of the authority that signed the server's");
    }
  }
  // libpq would wait forever if this were 0 or not a number.
  std::string& timeout = options["connect_timeout"];
  const int seconds = number_in<int>(timeout).value_or(0);
  timeout = std::to_string(seconds < 1 ? 10 : std::min(seconds, 60));
  return options;
}

ByteView value_at(const SqlRows& rows, int row, int column) {
  return {reinterpret_cast<const std::uint8_t*>(PQgetvalue(rows.get(), row, column)),
          static_cast<std::size_t>(PQgetlength(rows.get(), row, column))};
}

ServerConnection::ServerConnection(const ConnectionOptions& options, const AnswerLimits& limits)
    : limits_(limits) {
  std::vector<const char*> names;
  std::vector<const char*> values;
  for (const auto& [name, value] : options) {
    names.push_back(name.c_str());
    values.push_back(value.c_str());
  }
  names.push_back(nullptr);
  values.push_back(nullptr);
  connection_.reset(PQconnectdbParams(names.data(), values.data(), 0));
  PGconn* const connection = connection_.get();
  address_ =
      one_line(fmt::format("{}:{}/{}", PQhost(connection), PQport(connection), PQdb(connection)));
  if (PQstatus(connection) != CONNECTION_OK) {
    refuse(
        "cannot connect; check the address, that the server runs, user and password (~/.pgpass, "
        "PGPASSWORD), and for another machine the certificate (sslrootcert)",
        PQerrorMessage(connection));
  }
  PQsetnonblocking(connection, 1);
  execute("SET synchronous_commit = on");
  execute("SET client_min_messages = error");  // libpq would print notices
}

SqlRows ServerConnection::execute(const std::string& statement,
                                  const std::vector<ByteView>& values) {
  std::vector<const char*> starts;
  std::vector<int> lengths;
  const std::vector<int> formats(values.size(), 1);
  for (const ByteView value : values) {
    // A null pointer would be NULL.
    starts.push_back(value.empty() ? "" : reinterpret_cast<const char*>(value.data()));
    lengths.push_back(static_cast<int>(value.size()));
  }
  const std::jthread guard = abort_if_too_large();
  request_start_ = last_activity_ = Clock::now();
  PQsendQueryParams(connection_.get(), statement.c_str(), static_cast<int>(values.size()), nullptr,
                    starts.data(), lengths.data(), formats.data(), 1);
  SqlRows rows = next_result();
  const ExecStatusType status = PQresultStatus(rows.get());
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) {
    const char* const reason = PQresultErrorField(rows.get(), PG_DIAG_MESSAGE_PRIMARY);
    refuse(
        "the server refused a statement; run the same command again, which continues from there, "
        "or ask its administrator for the rights listed in docs/several-stations.md",
        reason != nullptr ? reason : PQerrorMessage(connection_.get()));
  }
  if (next_result()) refuse("check that the address is the right one", "it sent two answers");
  return rows;
}

/// Replaces PQgetResult, which has no timeout.
SqlRows ServerConnection::next_result() {
  constexpr int kPollMs = 100;  // bytes that TLS has buffered do not wake the socket
  while (true) {
    const int unsent = PQflush(connection_.get());
    if (unsent < 0 || PQconsumeInput(connection_.get()) != 1) {
      require_within_limits();
      refuse("the connection was lost; run the same command again, which continues from there",
             PQerrorMessage(connection_.get()));
    }
    if (unsent == 0 && PQisBusy(connection_.get()) == 0) break;
    require_within_limits();
    pollfd socket{.fd = PQsocket(connection_.get()), .events = POLLIN, .revents = 0};
    if (unsent == 1) socket.events |= POLLOUT;
    if (::poll(&socket, 1, kPollMs) > 0) last_activity_ = Clock::now();
  }
  return {PQgetResult(connection_.get()), PQclear};
}

void ServerConnection::require_within_limits() const {
  const Clock::time_point now = Clock::now();
  const char* reason = nullptr;
  if (now - last_activity_ > limits_.silence) reason = "it has been silent for too long";
  if (now - request_start_ > limits_.total) reason = "its answer takes too long";
  if (is_too_large_) reason = "its answer is too large";
  if (reason == nullptr) return;
  refuse("the connection to the server was interrupted; check that the address is the right one",
         reason);
}

/// Runs on another thread, because libpq reads a message to its end, which may be 2 GB later.
std::jthread ServerConnection::abort_if_too_large() {
  const int socket = PQsocket(connection_.get());
  const std::uint64_t limit = bytes_received(socket) + limits_.bytes;
  return std::jthread([this, socket, limit](const std::stop_token& is_answered) {
    constexpr std::chrono::milliseconds kPollInterval{5};
    const auto is_over = [&] { return bytes_received(socket) > limit; };
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any answered;
    while (!answered.wait_for(lock, is_answered, kPollInterval, is_over)) {
      if (is_answered.stop_requested()) return;
    }
    is_too_large_ = true;
    ::shutdown(socket, SHUT_RDWR);
  });
}

void ServerConnection::refuse(const std::string& what, const char* reason) const {
  const std::string text = reason;
  throw StoreError(fmt::format("{}: {} ({})", address_, what,
                               one_line(text.substr(0, text.find_last_not_of(" \n") + 1))));
}

}  // namespace touchtrial::merging
