#include "protocols/collect/answer_watch.hpp"

#include <fmt/format.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace touchtrial::collect {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{5};

std::string time_text(std::chrono::milliseconds time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time).count();
  return seconds >= 120 ? fmt::format("{} minutes", seconds / 60)
                        : fmt::format("{:.3g} s", static_cast<double>(time.count()) * 1e-3);
}

}  // namespace

// A descriptor of its own: libpq may close its own, and the system give the number to another file.
AnswerWatch::AnswerWatch(int socket, const AnswerLimits& limits)
    : socket_(::dup(socket)), limits_(limits), thread_([this] { watch(); }) {}

AnswerWatch::~AnswerWatch() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (socket_ >= 0) ::close(socket_);
}

std::string AnswerWatch::reason() const {
  const std::lock_guard lock(mutex_);
  return reason_;
}

void AnswerWatch::set_waiting(bool waiting) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = waiting;
    if (waiting) {
      first_ = last_ = traffic();
      began_ = moved_ = Clock::now();
    }
  }
  if (waiting) changed_.notify_one();
}

AnswerWatch::Traffic AnswerWatch::traffic() const {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket_, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  return {.sent = info.tcpi_bytes_acked, .received = info.tcpi_bytes_received};
}

std::string AnswerWatch::exceeded(Clock::time_point now) {
  const Traffic there = traffic();
  if (there != last_) moved_ = now;
  last_ = there;
  if (there.received - first_.received > limits_.bytes) {
    return fmt::format("sent more than {} MiB in answer to one question", limits_.bytes >> 20U);
  }
  if (now - moved_ > limits_.silence) {
    return "has been silent for " + time_text(limits_.silence);
  }
  if (now - began_ > limits_.whole) {
    return "has not come to the end of an answer in " + time_text(limits_.whole);
  }
  return {};
}

void AnswerWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    if (!waiting_) {
      changed_.wait(lock, [&] { return ends_ || waiting_; });
      continue;
    }
    const std::string fault = exceeded(Clock::now());
    if (!fault.empty()) {
      reason_ = "the server " + fault +
                ", and the connection was broken off; check that the address is the right one, and "
                "ask whoever keeps the server";
      ::shutdown(socket_, SHUT_RDWR);
      return;
    }
    changed_.wait_for(lock, kBetweenLooks);
  }
}

}  // namespace touchtrial::collect
