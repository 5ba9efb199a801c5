#include "device/drivers/inverse3/service_link.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

namespace touchtrial::device::inverse3 {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxEvents = 256;

Clock::time_point deadline_after(std::chrono::nanoseconds timeout) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
}

[[noreturn]] void refuse(const ServiceAddress& where, const std::string& reason) {
  throw NoService(one_line("inverse3: no service answers at " + where.text() + " (" + reason +
                           "); start Haply's Inverse service (Haply Hub, or systemctl start "
                           "haply-inverse-service), or correct inverse3.host and inverse3.port"));
}

/// Runs the context until a condition holds.
/// \return false at the time limit
template <typename Condition>
bool run_until(asio::io_context& context, Clock::time_point deadline, Condition condition) {
  context.restart();
  while (!condition()) {
    if (context.run_one_until(deadline) == 0) return condition();
  }
  return true;
}

/// Runs one asynchronous operation.
/// \param start  starts the operation with the given handler
/// \param cancel  called at the deadline
template <typename Start, typename Cancel>
error_code await(asio::io_context& context, Clock::time_point deadline, Start start,
                 Cancel cancel) {
  std::optional<error_code> result;
  start([&result](error_code error, auto&&...) { result = error; });
  const auto has_ended = [&result] { return result.has_value(); };
  if (run_until(context, deadline, has_ended)) return *result;
  cancel();
  while (!has_ended() && context.run_one() > 0) {
  }
  return asio::error::timed_out;
}

/// \throws DeviceError if no service listens there
void connect(asio::io_context& context, Tcp::socket& socket, const ServiceAddress& where,
             Clock::time_point deadline) {
  error_code error;
  const auto endpoints =
      Tcp::resolver(context).resolve(where.host, std::to_string(where.port), error);
  if (error) refuse(where, error.message());
  error = await(
      context, deadline,
      [&](auto handler) { asio::async_connect(socket, endpoints, std::move(handler)); },
      [&] {
        error_code ignored;
        socket.close(ignored);
      });
  if (error) refuse(where, error.message());
  // Disables Nagle's algorithm, which delays small messages.
  socket.set_option(Tcp::no_delay(true), error);
}

/// One WebSocket with a continuous read.
class Channel {
 public:
  Channel(asio::io_context& context, const ServiceAddress& where, Clock::time_point deadline)
      : context_(context), stream_(context) {
    connect(context, stream_.next_layer(), where, deadline);
    stream_.read_message_max(kMaxMessage);
    const error_code error = run_operation(deadline, [&](auto handler) {
      stream_.async_handshake(where.text(), "/", std::move(handler));
    });
    if (error) refuse(where, error.message());
    stream_.text(true);
    read();
  }

  [[nodiscard]] error_code write(const std::string& message, Clock::time_point deadline) {
    return run_operation(deadline, [&](auto handler) {
      stream_.async_write(asio::buffer(message), std::move(handler));
    });
  }
  void close(Clock::time_point deadline) {
    (void)run_operation(deadline, [&](auto handler) {
      stream_.async_close(websocket::close_code::normal, std::move(handler));
    });
  }

  [[nodiscard]] std::uint64_t received_count() const noexcept { return received_; }
  [[nodiscard]] const error_code& end_reason() const noexcept { return end_reason_; }
  [[nodiscard]] const std::string& newest() const noexcept { return newest_; }
  /// Stores messages until they are taken, at most kMaxEvents.
  void store_messages() { stores_messages_ = true; }
  [[nodiscard]] std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

 private:
  template <typename Start>
  error_code run_operation(Clock::time_point deadline, Start start) {
    return await(context_, deadline, start, [this] {
      error_code ignored;
      stream_.next_layer().close(ignored);
    });
  }

  void read() {
    stream_.async_read(buffer_, [this](error_code error, std::size_t) {
      if (error) {
        end_reason_ = error;
        return;
      }
      newest_ = beast::buffers_to_string(buffer_.data());
      buffer_.consume(buffer_.size());
      ++received_;
      if (stores_messages_ && messages_.size() < kMaxEvents) messages_.push_back(newest_);
      read();
    });
  }

  asio::io_context& context_;
  websocket::stream<Tcp::socket> stream_;
  beast::flat_buffer buffer_;
  std::string newest_;
  std::vector<std::string> messages_;
  std::uint64_t received_ = 0;
  error_code end_reason_;
  bool stores_messages_ = false;
};

LinkOutcome outcome_of(const error_code& error) {
  if (!error) return LinkOutcome::ok;
  if (error == asio::error::timed_out) return LinkOutcome::silent;
  const bool is_nonsense = error == websocket::condition::protocol_violation ||
                           error == websocket::error::message_too_big;
  return is_nonsense ? LinkOutcome::nonsense : LinkOutcome::closed;
}

}  // namespace

HttpAnswer query_service(const ServiceAddress& service, const std::string& path,
                         std::chrono::nanoseconds timeout) {
  const Clock::time_point deadline = deadline_after(timeout);
  asio::io_context context;
  Tcp::socket socket(context);
  connect(context, socket, service, deadline);
  http::request<http::empty_body> request(http::verb::get, path, 11);
  request.set(http::field::host, service.text());
  request.set(http::field::connection, "close");
  const auto cancel = [&] {
    error_code ignored;
    socket.close(ignored);
  };
  error_code error = await(
      context, deadline,
      [&](auto handler) { http::async_write(socket, request, std::move(handler)); }, cancel);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(kMaxMessage);
  if (!error) {
    error = await(
        context, deadline,
        [&](auto handler) { http::async_read(socket, buffer, parser, std::move(handler)); },
        cancel);
  }
  if (error) refuse(service, error.message());
  return {parser.get().result_int(), std::move(parser.get().body())};
}

struct ServiceLink::Channels {
  Channels(const ServiceAddress& service, Clock::time_point deadline)
      : simulation(context, service, deadline) {}

  /// \return ok once every message has its answer
  LinkOutcome wait_for_answer(Clock::time_point deadline) {
    const auto is_answered = [this] {
      return simulation.received_count() >= expected_answers || simulation.end_reason();
    };
    if (!run_until(context, deadline, is_answered)) return LinkOutcome::silent;
    if (simulation.end_reason()) return outcome_of(simulation.end_reason());
    return simulation.received_count() == expected_answers ? LinkOutcome::ok
                                                           : LinkOutcome::nonsense;
  }

  asio::io_context context;
  Channel simulation;
  std::optional<Channel> events;
  /// The number of answers expected since connecting. It begins with 1, because the service first
  /// sends its inventory.
  std::uint64_t expected_answers = 1;
};

ServiceLink::ServiceLink(const ServiceAddress& service, std::chrono::nanoseconds timeout)
    : channels_(std::make_unique<Channels>(service, deadline_after(timeout))) {
  const LinkOutcome outcome = channels_->wait_for_answer(deadline_after(timeout));
  if (outcome == LinkOutcome::silent)
    refuse(service, "it accepts connections, but does not answer");
  if (outcome != LinkOutcome::ok) refuse(service, "it ends the connection");
}

ServiceLink::~ServiceLink() = default;

void ServiceLink::listen_to(const ServiceAddress& events, std::chrono::nanoseconds timeout) {
  channels_->events.emplace(channels_->context, events, deadline_after(timeout));
  channels_->events->store_messages();
}

LinkOutcome ServiceLink::exchange(const std::string& message,
                                  std::chrono::nanoseconds timeout) noexcept {
  try {
    Channels& channels = *channels_;
    const Clock::time_point deadline = deadline_after(timeout);
    // A message received since the last exchange was not requested.
    channels.context.restart();
    channels.context.poll();
    if (channels.simulation.end_reason()) return outcome_of(channels.simulation.end_reason());
    if (channels.simulation.received_count() != channels.expected_answers)
      return LinkOutcome::nonsense;
    ++channels.expected_answers;
    const error_code error = channels.simulation.write(message, deadline);
    return error ? outcome_of(error) : channels.wait_for_answer(deadline);
  } catch (const std::exception&) {
    return LinkOutcome::closed;
  }
}

void ServiceLink::post(const std::string& message, std::chrono::nanoseconds timeout) noexcept {
  try {
    ++channels_->expected_answers;
    (void)channels_->simulation.write(message, deadline_after(timeout));
  } catch (const std::exception&) {
    // The connection is closed, so there is no force.
  }
}

void ServiceLink::close(std::chrono::nanoseconds timeout) noexcept {
  try {
    const Clock::time_point deadline = deadline_after(timeout);
    channels_->simulation.close(deadline);
    if (channels_->events) channels_->events->close(deadline);
  } catch (const std::exception&) {
    // Errors do not matter, because the connection is being closed.
  }
}

const std::string& ServiceLink::answer() const noexcept {
  return channels_->simulation.newest();
}

std::vector<std::string> ServiceLink::take_events() {
  return channels_->events ? channels_->events->take_messages() : std::vector<std::string>();
}

bool ServiceLink::events_ended() const noexcept {
  return channels_->events && channels_->events->end_reason();
}

}  // namespace touchtrial::device::inverse3
