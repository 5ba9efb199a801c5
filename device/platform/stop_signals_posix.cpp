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

constexpr long kTimeToSendNs = 20'000'000;
constexpr int kExitBySignal = 128;
// Including signals that would suspend the program, because the motors would hold their last force.
constexpr std::array kAskSignals = {SIGINT,  SIGTERM, SIGHUP,  SIGPIPE,
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

struct Earlier {
  std::array<struct sigaction, kAskSignals.size()> of_asks{};
  std::array<struct sigaction, kCrashSignals.size()> of_crashes{};
  std::terminate_handler terminate = nullptr;
};
Earlier earlier;

void halt() noexcept {
  HapticDevice* device = device_to_halt.load();
  ServoControl* servo = servo_to_stop.load();
  if (device != nullptr) device->halt();
  if (servo != nullptr) servo->emergency_stop();
}

void run_crash_cleanup() noexcept {
  void (*const act)() noexcept = crash_cleanup.load();
  if (act != nullptr) act();
}

void wait_for_driver() noexcept {
  timespec left{0, kTimeToSendNs};
  while (nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

template <std::size_t n>
void put_back(const std::array<int, n>& signals,
              const std::array<struct sigaction, n>& actions) noexcept {
  for (std::size_t i = 0; i < n; ++i) sigaction(signals[i], &actions[i], nullptr);
}

extern "C" void on_ask(int signal) {
  const int error = errno;
  halt();
  int none = 0;
  if (!first_signal.compare_exchange_strong(none, signal)) {
    wait_for_driver();
    run_crash_cleanup();
    put_back(kAskSignals, earlier.of_asks);
    raise(signal);  // delivered when this handler returns
  }
  errno = error;
}

extern "C" void on_crash(int signal) {
  halt();
  wait_for_driver();
  run_crash_cleanup();
  put_back(kCrashSignals, earlier.of_crashes);
  raise(signal);
}

[[noreturn]] void on_terminate() {
  halt();
  wait_for_driver();
  run_crash_cleanup();
  if (earlier.terminate != nullptr) earlier.terminate();
  std::abort();
}

template <std::size_t n>
void handle(const std::array<int, n>& signals, void (*handler)(int),
            std::array<struct sigaction, n>& before) noexcept {
  struct sigaction action {};
  action.sa_handler = handler;
  sigfillset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < n; ++i) sigaction(signals[i], &action, &before[i]);
}

}  // namespace

StopOnSignals::StopOnSignals(HapticDevice& device, ServoControl& control) {
  HapticDevice* none = nullptr;
  if (!device_to_halt.compare_exchange_strong(none, &device)) {
    throw std::logic_error("StopOnSignals: there is another one");
  }
  servo_to_stop.store(&control);
  first_signal.store(0);
  earlier.terminate = std::set_terminate(on_terminate);
  handle(kAskSignals, on_ask, earlier.of_asks);
  handle(kCrashSignals, on_crash, earlier.of_crashes);
}

StopOnSignals::~StopOnSignals() {
  put_back(kCrashSignals, earlier.of_crashes);
  put_back(kAskSignals, earlier.of_asks);
  std::set_terminate(earlier.terminate);
  servo_to_stop.store(nullptr);
  device_to_halt.store(nullptr);
}

void StopOnSignals::set_crash_cleanup(void (*put_back)() noexcept) noexcept {
  crash_cleanup.store(put_back);
}

bool StopOnSignals::asked() noexcept {
  return first_signal.load() != 0;
}

int StopOnSignals::exit_code() noexcept {
  const int signal = first_signal.load();
  return signal == 0 ? 0 : kExitBySignal + signal;
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
      return "stopped by SIGHUP (the terminal went away); the force is zero";
    case SIGPIPE:
      return "stopped by SIGPIPE (the output's reader has exited); the force is zero";
    case SIGXCPU:
      return "stopped by SIGXCPU (the limit of processor time); the force is zero";
    default:
      return "stopped instead of suspended, because a suspended program cannot switch the force "
             "off; the force is zero";
  }
}

}  // namespace touchtrial::device
