/// \file Connection to Haply's Inverse service: HTTP queries, and the WebSockets of the simulation
///   and events channels, with timeouts.
#pragma once

#include "core/errors.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::device::inverse3 {

/// The maximum length of an answer, bytes; a service with many devices sends some tens of
/// thousands.
inline constexpr std::size_t kMaxMessage = 1U << 20U;

/// The address of a service.
struct ServiceAddress {
  std::string host;
  int port = 0;

  [[nodiscard]] std::string text() const { return host + ':' + std::to_string(port); }
};

/// No service answers at the address.
class NoService : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

/// The answer to an HTTP query.
struct HttpAnswer {
  unsigned status = 0;  ///< HTTP status; 200: success
  std::string body;
};

/// Sends GET `path`. Blocks for at most `timeout`, plus name resolution.
/// \throws NoService with the remedy if there is no answer
[[nodiscard]] HttpAnswer query_service(const ServiceAddress& service, const std::string& path,
                                       std::chrono::nanoseconds timeout);

/// The result of an exchange.
enum class LinkOutcome {
  ok,
  silent,   ///< no answer in time; the link is unusable
  closed,   ///< the service has ended the connection
  nonsense  ///< too large, not text, or more answers than messages
};

/// The simulation channel and, optionally, the events channel. The service sends exactly one answer
/// to each message; the link counts answers, so that a late answer is not mistaken for the answer
/// to a later message. Belongs to one thread.
class ServiceLink {
 public:
  /// Connects, and waits for the inventory, which the service sends first.
  /// \throws DeviceError with the remedy
  ServiceLink(const ServiceAddress& service, std::chrono::nanoseconds timeout);
  ~ServiceLink();
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  /// Also connects to the events channel.
  /// \throws DeviceError with the remedy
  void listen_to(const ServiceAddress& events, std::chrono::nanoseconds timeout);

  /// Sends a message and waits for its answer.
  [[nodiscard]] LinkOutcome exchange(const std::string& message,
                                     std::chrono::nanoseconds timeout) noexcept;
  /// Sends a message without waiting for the answer; only before `close`.
  void post(const std::string& message, std::chrono::nanoseconds timeout) noexcept;
  /// Closes the connection properly.
  void close(std::chrono::nanoseconds timeout) noexcept;

  /// \return the newest answer, initially the inventory
  [[nodiscard]] const std::string& answer() const noexcept;
  /// \return at most some hundred events since the last call, oldest first
  [[nodiscard]] std::vector<std::string> take_events();
  /// \return whether the events channel was opened and has ended
  [[nodiscard]] bool events_ended() const noexcept;

 private:
  struct Channels;
  std::unique_ptr<Channels> channels_;
};

}  // namespace touchtrial::device::inverse3
