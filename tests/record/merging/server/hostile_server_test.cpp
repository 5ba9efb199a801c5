// Servers that accept a connection and then are silent, or never come to an end.
#include "core/errors.hpp"
#include "record/merging/postgres/server_connection.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace std::chrono_literals;

namespace {

std::string number32(std::uint32_t number) {
  const std::uint32_t bytes = htonl(number);
  return {reinterpret_cast<const char*>(&bytes), sizeof bytes};
}

/// A message of PostgreSQL's protocol, version 3.
std::string message(char type, const std::string& body) {
  return type + number32(static_cast<std::uint32_t>(body.size() + 4)) + body;
}

std::string parameter(const std::string& name, const std::string& value) {
  return message('S', name + '\0' + value + '\0');
}

/// Lets anybody in.
std::string welcome() {
  return message('R', number32(0)) + parameter("server_version", "15.0") +
         parameter("client_encoding", "UTF8") + parameter("standard_conforming_strings", "on") +
         message('K', number32(1) + number32(2)) + message('Z', "I");
}

/// The description of one column of text.
std::string one_column() {
  const std::string two_zeros(2, '\0');
  return message('T', std::string("\0\1", 2) + "text" + '\0' + number32(0) + two_zeros +
                          number32(25) + "\xff\xff" + number32(0xffffffffU) + two_zeros);
}

std::string one_row(const std::string& value) {
  return message(
      'D', std::string("\0\1", 2) + number32(static_cast<std::uint32_t>(value.size())) + value);
}

/// Listens on this machine, lets the first client in, and answers its first question as `answer`
/// says. Ends with the object.
class FakeServer {
 public:
  using Say = std::function<bool(const std::string&)>;  ///< false: nobody listens any more

  explicit FakeServer(std::function<void(const Say&)> answer)
      : answer_(std::move(answer)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    REQUIRE(::bind(listener_, reinterpret_cast<sockaddr*>(&place), size) == 0);
    REQUIRE(::listen(listener_, 8) == 0);
    REQUIRE(::getsockname(listener_, reinterpret_cast<sockaddr*>(&place), &size) == 0);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeServer() {
    ends_ = true;
    thread_.join();
    ::close(listener_);
  }
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  [[nodiscard]] ConnectionOptions options() const {
    return connection_options("postgresql://anna@127.0.0.1:" + std::to_string(port_) +
                              "/study?sslmode=disable&gssencmode=disable");
  }

 private:
  [[nodiscard]] bool waits_for(int socket, short events) const {
    while (!ends_) {
      pollfd there{.fd = socket, .events = events, .revents = 0};
      if (::poll(&there, 1, 20) > 0) return true;
    }
    return false;
  }

  /// Whatever the client says now.
  [[nodiscard]] bool hears(int socket) const {
    std::array<char, 65536> bytes{};
    return waits_for(socket, POLLIN) && ::recv(socket, bytes.data(), bytes.size(), 0) > 0;
  }

  [[nodiscard]] bool says(int socket, const std::string& text) const {
    std::size_t at = 0;
    while (at < text.size()) {
      if (!waits_for(socket, POLLOUT)) return false;
      const ssize_t sent =
          ::send(socket, text.data() + at, text.size() - at, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent <= 0) return false;
      at += static_cast<std::size_t>(sent);
    }
    return true;
  }

  void serve() const {
    if (!waits_for(listener_, POLLIN)) return;
    const int client = ::accept(listener_, nullptr, nullptr);
    if (hears(client) && says(client, welcome()) && hears(client)) {
      answer_([&](const std::string& text) { return says(client, text); });
      // Silence, until the client goes.
      while (hears(client)) {
      }
    }
    ::close(client);
  }

  std::function<void(const Say&)> answer_;
  int listener_;
  int port_ = 0;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

std::string refusal_by(const FakeServer& server, const AnswerLimits& limits) {
  return message_of<StoreError>(
      [&] { const ServerConnection connection(server.options(), limits); });
}

long max_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

}  // namespace

TEST_CASE(
    "a server that is silent, at once or in the middle of an answer, is given up in one line") {
  const FakeServer mute([](const FakeServer::Say&) {});
  const FakeServer stopping([](const FakeServer::Say& say) { say(one_column() + one_row("a")); });
  for (const FakeServer* const server : {&mute, &stopping}) {
    const std::string line = refusal_by(*server, {.silence = 300ms});
    CHECK_THAT(line, holds_text("127.0.0.1"));
    CHECK(line.find('\n') == std::string::npos);
  }
}

TEST_CASE("a server that sends a little for ever is given up") {
  const FakeServer server([](const FakeServer::Say& say) {
    if (!say(one_column())) return;
    while (say(one_row("a"))) std::this_thread::sleep_for(5ms);
  });
  CHECK_THAT(refusal_by(server, {.total = 500ms}), holds_text("127.0.0.1"));
}

TEST_CASE(
    "a server that sends rows without end, or one huge value, is given up in bounded memory") {
  const std::string many = [] {
    std::string rows;
    for (int i = 0; i < 1000; ++i) rows += one_row(std::string(200, 'x'));
    return rows;
  }();
  const std::string huge =
      'D' + number32(0x70000000U) + std::string("\0\1", 2) + number32(0x60000000U);
  for (const std::string& beginning : {many, huge}) {
    const long before = max_memory_mib();
    const FakeServer server([&](const FakeServer::Say& say) {
      if (!say(one_column() + beginning)) return;
      while (say(many)) {
      }
    });
    CHECK_THAT(refusal_by(server, {}), holds_text("127.0.0.1"));
    CHECK(max_memory_mib() - before < 768);
  }
}
