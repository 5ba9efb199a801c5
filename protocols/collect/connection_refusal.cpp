#include "protocols/collect/connection_refusal.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include <libpq-fe.h>
#include <poll.h>

namespace touchtrial::collect {
namespace {

constexpr std::chrono::seconds kLongestAttempt{10};

using Connection = std::unique_ptr<PGconn, decltype(&PQfinish)>;

/// Until it stands, has failed, or the time is over.
void establish(PGconn* connection) {
  const auto end = std::chrono::steady_clock::now() + kLongestAttempt;
  PostgresPollingStatusType next = PGRES_POLLING_WRITING;
  while (next == PGRES_POLLING_READING || next == PGRES_POLLING_WRITING) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return;
    const auto events = static_cast<short>(next == PGRES_POLLING_READING ? POLLIN : POLLOUT);
    pollfd socket{.fd = PQsocket(connection), .events = events, .revents = 0};
    if (poll(&socket, 1, static_cast<int>(left.count())) <= 0) return;
    next = PQconnectPoll(connection);
  }
}

/// "FATAL:  28P01" ends with the server's code; what libpq says itself ends otherwise.
std::string code_at_end(std::string_view line) {
  while (line.ends_with(' ')) line.remove_suffix(1);
  if (line.size() < 6 || line[line.size() - 6] != ' ') return {};
  const std::string code(line.substr(line.size() - 5));
  const bool is_code = std::all_of(code.begin(), code.end(), [](char each) {
    return (each >= '0' && each <= '9') || (each >= 'A' && each <= 'Z');
  });
  return is_code ? code : "";
}

/// Of the last of several servers; libpq may add a remark of its own.
std::string code_in(std::string_view text) {
  std::string code;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string found = code_at_end(text.substr(0, end));
    if (!found.empty()) code = found;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return code;
}

}  // namespace

ConnectionRefusal refusal_by(const ServerAddress& address) {
  const Connection connection(PQconnectStart(address.connection_string().c_str()), PQfinish);
  if (!connection) return ConnectionRefusal::unreached;
  PQsetErrorVerbosity(connection.get(), PQERRORS_SQLSTATE);
  if (PQstatus(connection.get()) != CONNECTION_BAD) establish(connection.get());
  if (PQstatus(connection.get()) == CONNECTION_OK) return ConnectionRefusal::unreached;
  if (PQconnectionNeedsPassword(connection.get()) != 0) return ConnectionRefusal::credentials;
  const std::string code = code_in(PQerrorMessage(connection.get()));
  if (code == "53300") return ConnectionRefusal::too_many;
  const bool is_final = code.starts_with("28") || code == "3D000" || code == "42501";
  return is_final ? ConnectionRefusal::credentials : ConnectionRefusal::unreached;
}

}  // namespace touchtrial::collect
