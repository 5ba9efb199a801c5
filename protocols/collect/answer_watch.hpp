/// \file Bounds the time and the size of a server's answers: a server may be broken or hostile, be
/// silent for ever or never come to an end. Private to protocols/collect.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace touchtrial::collect {

/// What one answer may take.
struct AnswerLimits {
  std::chrono::milliseconds silence =
      std::chrono::minutes(5);  ///< nothing sent and nothing received
  std::chrono::milliseconds whole = std::chrono::minutes(30);  ///< from the question to the end
  std::uint64_t bytes = std::uint64_t{64} << 20U;              ///< of one answer, as they travel
};

/// Breaks a connection off when an answer passes its limits: the call that waits for it then fails.
/// A thread of its own looks every few milliseconds, and only while somebody waits. The size is
/// known on TCP connections alone (the kernel counts it); a Unix socket's server is this machine's.
class AnswerWatch {
 public:
  /// Watches this socket, which may be closed meanwhile.
  AnswerWatch(int socket, const AnswerLimits& limits);
  ~AnswerWatch();
  AnswerWatch(const AnswerWatch&) = delete;
  AnswerWatch& operator=(const AnswerWatch&) = delete;

  /// An answer is waited for as long as this lives. Not to be nested.
  class Waiting {
   public:
    explicit Waiting(AnswerWatch& watch) : watch_(watch) { watch_.set_waiting(true); }
    ~Waiting() { watch_.set_waiting(false); }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;

   private:
    AnswerWatch& watch_;
  };

  /// Why the connection was broken off, and the remedy; empty if it was not.
  [[nodiscard]] std::string reason() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// Bytes since the connection was made.
  struct Traffic {
    std::uint64_t sent = 0;
    std::uint64_t received = 0;
    friend bool operator==(const Traffic&, const Traffic&) = default;
  };

  void set_waiting(bool waiting);
  void watch();
  [[nodiscard]] Traffic traffic() const;
  /// \pre mutex_ is locked
  [[nodiscard]] std::string exceeded(Clock::time_point now);

  int socket_;
  AnswerLimits limits_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool waiting_ = false;
  bool ends_ = false;
  std::string reason_;
  Traffic first_;  ///< when the waiting began
  Traffic last_;
  Clock::time_point began_;
  Clock::time_point moved_;  ///< when bytes last moved
  std::thread thread_;
};

}  // namespace touchtrial::collect
