#include "device/platform/realtime.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <system_error>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace touchtrial::device {
namespace {

constexpr std::size_t kPrefaultedStackBytes = std::size_t{256} * 1024;
constexpr long kNanosecondsPerSecond = 1'000'000'000;

std::string errno_message(int error) {
  return std::generic_category().message(error);
}

void add_reason(SchedulingObtained& obtained, const std::string& reason) {
  obtained.reason += (obtained.reason.empty() ? "" : "; ") + reason;
}

/// Prefaults the pages of the stack below this call, which the loop will use.
[[gnu::noinline]] void touch_stack() noexcept {
  std::array<volatile std::byte, kPrefaultedStackBytes> stack;
  constexpr std::size_t kMinPage = 4096;
  for (std::size_t i = 0; i < stack.size(); i += kMinPage) stack[i] = std::byte{};
}

void request_fifo(int priority, SchedulingObtained& obtained) {
  sched_param param{};
  param.sched_priority =
      std::clamp(priority, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
  if (error != 0) {
    add_reason(obtained, "SCHED_FIFO was refused (" + errno_message(error) +
                             "): give the user an rtprio limit in /etc/security/limits.d");
    return;
  }
  obtained.policy = SchedulingPolicy::fifo;
  obtained.priority = param.sched_priority;
}

/// With a limit, later mappings beyond it would fail, so only current memory is locked. A
/// privileged process removes the limit.
int choose_lock_flags() noexcept {
  const rlimit no_limit{RLIM_INFINITY, RLIM_INFINITY};
  rlimit limit{};
  const bool unlimited =
      setrlimit(RLIMIT_MEMLOCK, &no_limit) == 0 ||
      (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  return unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT;
}

void lock_memory(SchedulingObtained& obtained) {
  if (mlockall(choose_lock_flags()) == 0) {
    obtained.memory_locked = true;
    return;
  }
  add_reason(obtained, "memory could not be locked (" + errno_message(errno) +
                           "): raise the user's memlock limit in /etc/security/limits.d");
}

/// Disables the timer slack, by which the system wakes ordinary threads up to 50 us late to save
/// power.
void sharpen_timers() noexcept {
#ifdef __linux__
  static_cast<void>(prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL));
#endif
}

}  // namespace

SchedulingObtained request_scheduling(const SchedulingRequest& request) {
  SchedulingObtained obtained;
  if (request.policy == SchedulingPolicy::fifo) request_fifo(request.priority, obtained);
  if (obtained.policy == SchedulingPolicy::other) sharpen_timers();
  if (request.lock_memory) lock_memory(obtained);
  touch_stack();
  return obtained;
}

std::chrono::nanoseconds monotonic_now() noexcept {
  timespec now{};
  static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &now));
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

void sleep_until(std::chrono::nanoseconds time) noexcept {
  timespec until{};
  until.tv_sec = static_cast<time_t>(time.count() / kNanosecondsPerSecond);
  until.tv_nsec = static_cast<long>(time.count() % kNanosecondsPerSecond);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace touchtrial::device
