/// \file The way to Haply's Inverse service: HTTP questions, and the WebSockets of the simulation
/// channel and the events channel, with time limits. Only its source knows Boost.Beast.
#pragma once

#include "core/errors.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::device::inverse3 {

/// The longest answer that is read, bytes; a service with many devices says some tens of thousands.
inline constexpr std::size_t kMaxMessage = 1U << 20U;

/// Where a service listens.
struct ServiceAddress {
  std::string host;
  int port = 0;

  [[nodiscard]] std::string text() const { return host + ':' + std::to_string(port); }
};

/// Nothing answers where a service should.
class NoService : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

/// The answer to an HTTP question.
struct HttpAnswer {
  unsigned status = 0;  ///< 200: as asked
  std::string body;
};

/// Asks GET `path`. Blocks for `patience` at the most, and for the system's search for the host.
/// \throws NoService with the remedy if nothing answers
[[nodiscard]] HttpAnswer ask_service(const ServiceAddress& service, const std::string& path,
                                     std::chrono::nanoseconds patience);

/// How an exchange ended.
enum class LinkOutcome {
  ok,
  silent,   ///< no answer in time; this link is of no further use
  closed,   ///< the service has ended the connection
  nonsense  ///< too large, no text, or more answers than questions
};

/// The simulation channel and, beside it, the events channel. The service answers each message with
/// exactly one; the link keeps count, so that an answer never passes for that to a later message.
/// Belongs to one thread.
class ServiceLink {
 public:
  /// Connects, and waits for the inventory with which the service begins.
  /// \throws DeviceError with the remedy
  ServiceLink(const ServiceAddress& service, std::chrono::nanoseconds patience);
  ~ServiceLink();
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  /// Listens to events too.
  /// \throws DeviceError with the remedy
  void listen_to(const ServiceAddress& events, std::chrono::nanoseconds patience);

  /// Sends a message and waits for its answer.
  [[nodiscard]] LinkOutcome exchange(const std::string& message,
                                     std::chrono::nanoseconds patience) noexcept;
  /// Sends a message and does not wait for the answer, before `close`.
  void post(const std::string& message, std::chrono::nanoseconds patience) noexcept;
  /// Says goodbye.
  void close(std::chrono::nanoseconds patience) noexcept;

  /// The newest answer, at first the inventory.
  [[nodiscard]] const std::string& answer() const noexcept;
  /// \return events that came in since the last call, at most some hundreds, oldest first
  [[nodiscard]] std::vector<std::string> take_events();
  /// \return whether the events channel was opened and has ended
  [[nodiscard]] bool events_ended() const noexcept;

 private:
  struct Channels;
  std::unique_ptr<Channels> channels_;
};

}  // namespace touchtrial::device::inverse3
