#include "device/safety/watchdog.hpp"

#include "device/platform/realtime.hpp"

#include <algorithm>
#include <stdexcept>

namespace touchtrial::device {
namespace {

constexpr int kChecksPerSilence = 5;
constexpr int kPriority = 85;  ///< of SCHED_FIFO, above the servo's

class SystemTime final : public WatchdogTime {
 public:
  [[nodiscard]] Time now() noexcept override { return monotonic_now(); }
  void pause(Time time) noexcept override { sleep_until(monotonic_now() + time); }
};

}  // namespace

WatchdogTime& system_watchdog_time() noexcept {
  static SystemTime time;
  return time;
}

Watchdog::Watchdog(HapticDevice& device, ServoControl& control,
                   const std::atomic<std::int64_t>& heartbeat, std::chrono::nanoseconds silence,
                   WatchdogTime& time)
    : device_(device),
      control_(control),
      heartbeat_(heartbeat),
      silence_(silence),
      pause_(std::max(silence / kChecksPerSilence, std::chrono::nanoseconds(1))),
      time_(time) {
  if (silence <= std::chrono::nanoseconds(0)) {
    throw std::invalid_argument("Watchdog: the silence must be > 0");
  }
  thread_ = std::thread([this] { watch(); });
}

Watchdog::~Watchdog() {
  stop_requested_.store(true, std::memory_order_release);
  thread_.join();
}

void Watchdog::arm() {
  const std::lock_guard lock(mutex_);
  is_armed_ = true;
  has_tripped_ = false;
  is_beating_ = false;
  last_beat_ = heartbeat_.load(std::memory_order_acquire);
  elapsed_silence_ = {};
}

bool Watchdog::disarm() {
  const std::lock_guard lock(mutex_);
  is_armed_ = false;
  return has_tripped_;
}

void Watchdog::watch() noexcept {
  // If refused, it runs as an ordinary thread.
  static_cast<void>(request_scheduling(
      {.policy = SchedulingPolicy::fifo, .priority = kPriority, .lock_memory = false}));
  WatchdogTime::Time last = time_.now();
  while (!stop_requested_.load(std::memory_order_acquire)) {
    time_.pause(pause_);
    const WatchdogTime::Time now = time_.now();
    check_heartbeat(now - last);
    last = now;
  }
}

void Watchdog::check_heartbeat(WatchdogTime::Time elapsed) noexcept {
  const std::lock_guard lock(mutex_);
  const std::int64_t beat = heartbeat_.load(std::memory_order_acquire);
  const bool is_new = beat != last_beat_;
  last_beat_ = beat;
  is_beating_ = (is_beating_ || is_new) && beat != kServoAtRest;
  elapsed_silence_ = is_new || !is_beating_ ? WatchdogTime::Time{}
                                            : elapsed_silence_ + std::min(elapsed, 2 * pause_);
  if (!is_armed_ || has_tripped_ || elapsed_silence_ < silence_) return;
  has_tripped_ = true;
  device_.halt();
  control_.stall();
}

}  // namespace touchtrial::device
