#include "device/platform/stop_signals.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include <signal.h>
#include <time.h>

namespace touchtrial::device {
namespace {

constexpr long kZeroForceWaitNs = 20'000'000;
constexpr int kSignalExitBase = 128;
// These include the signals that suspend a program, because the motors would hold their last force.
constexpr std::array kStopSignals = {SIGINT,  SIGTERM, SIGHUP,  SIGPIPE,
                                     SIGXCPU, SIGTSTP, SIGTTIN, SIGTTOU};
constexpr std::array kCrashSignals = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGQUIT};

// Handlers access only lock-free atomics.
std::atomic<HapticDevice*> device_to_halt{nullptr};
std::atomic<ServoControl*> servo_to_stop{nullptr};
std::atomic<int> first_signal{0};
std::atomic<void (*)() noexcept> crash_cleanup{nullptr};
static_assert(std::atomic<HapticDevice*>::is_always_lock_free);
static_assert(std::atomic<ServoControl*>::is_always_lock_free);
static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<void (*)() noexcept>::is_always_lock_free);

struct PreviousHandlers {
  std::array<struct sigaction, kStopSignals.size()> stop{};
  std::array<struct sigaction, kCrashSignals.size()> crash{};
  std::terminate_handler terminate = nullptr;
};
PreviousHandlers previous_handlers;

void halt() noexcept {
  HapticDevice* device = device_to_halt.load();
  ServoControl* servo = servo_to_stop.load();
  if (device != nullptr) device->halt();
  if (servo != nullptr) servo->emergency_stop();
}

void run_crash_cleanup() noexcept {
  void (*const cleanup)() noexcept = crash_cleanup.load();
  if (cleanup != nullptr) cleanup();
}

void wait_for_driver() noexcept {
  timespec remaining{0, kZeroForceWaitNs};
  while (nanosleep(&remaining, &remaining) != 0 && errno == EINTR) {
  }
}

template <std::size_t n>
void restore_handlers(const std::array<int, n>& signals,
                      const std::array<struct sigaction, n>& actions) noexcept {
  for (std::size_t i = 0; i < n; ++i) sigaction(signals[i], &actions[i], nullptr);
}

extern "C" void on_stop_signal(int signal) {
  const int error = errno;
  halt();
  int expected = 0;
  if (!first_signal.compare_exchange_strong(expected, signal)) {
    wait_for_driver();
    run_crash_cleanup();
    restore_handlers(kStopSignals, previous_handlers.stop);
    raise(signal);  // delivered when this handler returns
  }
  errno = error;
}

extern "C" void on_crash_signal(int signal) {
  halt();
  wait_for_driver();
  run_crash_cleanup();
  restore_handlers(kCrashSignals, previous_handlers.crash);
  raise(signal);
}

[[noreturn]] void on_terminate() {
  halt();
  wait_for_driver();
  run_crash_cleanup();
  if (previous_handlers.terminate != nullptr) previous_handlers.terminate();
  std::abort();
}

template <std::size_t n>
void install_handlers(const std::array<int, n>& signals, void (*handler)(int),
                      std::array<struct sigaction, n>& previous) noexcept {
  struct sigaction action {};
  action.sa_handler = handler;
  sigfillset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < n; ++i) sigaction(signals[i], &action, &previous[i]);
}

}  // namespace

StopOnSignals::StopOnSignals(HapticDevice& device, ServoControl& control) {
  HapticDevice* expected = nullptr;
  if (!device_to_halt.compare_exchange_strong(expected, &device)) {
    throw std::logic_error("StopOnSignals: only one may exist at a time");
  }
  servo_to_stop.store(&control);
  first_signal.store(0);
  previous_handlers.terminate = std::set_terminate(on_terminate);
  install_handlers(kStopSignals, on_stop_signal, previous_handlers.stop);
  install_handlers(kCrashSignals, on_crash_signal, previous_handlers.crash);
}

StopOnSignals::~StopOnSignals() {
  restore_handlers(kCrashSignals, previous_handlers.crash);
  restore_handlers(kStopSignals, previous_handlers.stop);
  std::set_terminate(previous_handlers.terminate);
  servo_to_stop.store(nullptr);
  device_to_halt.store(nullptr);
}

void StopOnSignals::set_crash_cleanup(void (*cleanup)() noexcept) noexcept {
  crash_cleanup.store(cleanup);
}

bool StopOnSignals::stop_requested() noexcept {
  return first_signal.load() != 0;
}

int StopOnSignals::exit_code() noexcept {
  const int signal = first_signal.load();
  return signal == 0 ? 0 : kSignalExitBase + signal;
}

std::string StopOnSignals::message() {
  switch (first_signal.load()) {
    case 0:
      return {};
    case SIGINT:
      return "stopped by SIGINT (Ctrl-C); the force is zero";
    case SIGTERM:
      return "stopped by SIGTERM; the force is zero";
    case SIGHUP:
      return "stopped by SIGHUP (the terminal was closed); the force is zero";
    case SIGPIPE:
      return "stopped by SIGPIPE (the output's reader has exited); the force is zero";
    case SIGXCPU:
      return "stopped by SIGXCPU (processor time limit); the force is zero";
    default:
      return "stopped instead of suspended, because a suspended program cannot switch the force "
             "off; the force is zero";
  }
}

}  // namespace touchtrial::device
