// Every way out of the program, each in a child process whose device reports the forces that it
// sent.
#include "device/platform/stop_signals.hpp"

#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial {
namespace {

using namespace device;

/// Sends from a thread of its own into a pipe: 'F' for force, 'z' for zero.
class PipeDevice final : public HapticDevice {
 public:
  explicit PipeDevice(int pipe) : sender_([this, pipe] { send_to(pipe); }) { wait_for_sends(1); }
  ~PipeDevice() override {
    ends_.store(true);
    sender_.join();
  }
  [[nodiscard]] DeviceInfo info() const override { return {"pipe", "", 3.3, true}; }
  [[nodiscard]] DeviceStatus read(DeviceSample&) noexcept override { return DeviceStatus::ok; }
  [[nodiscard]] DeviceStatus write(Vec3) noexcept override { return DeviceStatus::ok; }
  void halt() noexcept override {
    halted_at_.store(std::chrono::steady_clock::now());
    halted_.store(true);
  }
  void rearm() noexcept override { halted_.store(false); }

  [[nodiscard]] std::chrono::nanoseconds since_halt() const noexcept {
    return std::chrono::steady_clock::now() - halted_at_.load();
  }
  /// After two sends since a halt, the last one is zero: the first may have been decided before.
  void wait_for_sends(int count) const noexcept {
    const int before = sends_.load();
    while (sends_.load() - before < count) std::this_thread::yield();
  }

 private:
  void send_to(int pipe) noexcept {
    while (!ends_.load()) {
      const char sent = halted_.load() ? 'z' : 'F';
      if (::write(pipe, &sent, 1) != 1) return;
      sends_.fetch_add(1);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  std::atomic<bool> halted_{false};
  std::atomic<bool> ends_{false};
  std::atomic<int> sends_{0};
  std::atomic<std::chrono::steady_clock::time_point> halted_at_{};
  std::thread sender_;
};

struct WayOut {
  std::string sent;
  int status = 0;
};

const std::map<std::string, int>& asking_signals() {
  static const std::map<std::string, int> signals = {
      {"SIGTERM", SIGTERM}, {"SIGINT", SIGINT},   {"SIGHUP", SIGHUP},   {"SIGPIPE", SIGPIPE},
      {"SIGXCPU", SIGXCPU}, {"SIGTSTP", SIGTSTP}, {"SIGTTIN", SIGTTIN}, {"SIGTTOU", SIGTTOU}};
  return signals;
}

void put_things_in_order(const ServoControl& control) {
  while (!control.emergency_stop_requested()) std::this_thread::yield();
}

void leave_by(const std::string& way, const ServoControl& control, const PipeDevice& device) {
  if (const auto asked = asking_signals().find(way); asked != asking_signals().end()) {
    std::raise(asked->second);
    put_things_in_order(control);
    device.wait_for_sends(2);
    ::_exit(StopOnSignals::exit_code());
  }
  if (way == "SIGTERM twice") {
    std::raise(SIGTERM);
    put_things_in_order(control);
    std::raise(SIGTERM);  // Before the driver could send: then it is waited for.
  }
  if (way == "abort") std::abort();
  if (way == "terminate") std::terminate();
  if (way == "SIGSEGV") std::raise(SIGSEGV);
  if (way == "SIGFPE") std::raise(SIGFPE);
  if (way == "SIGQUIT") std::raise(SIGQUIT);
}

constexpr std::chrono::milliseconds kTimeToSend{20};  ///< as stop_signals.hpp promises

int pipe_to_tell = -1;  ///< the child reports its last act here
const PipeDevice* device_in_use = nullptr;

/// Reports only if the driver has had its time. On a busy machine its thread may still wait for a
/// processor.
void last_act() noexcept {
  const bool had_its_time = device_in_use->since_halt() >= kTimeToSend;
  device_in_use->wait_for_sends(2);
  const char last = 'L';
  if (had_its_time && ::write(pipe_to_tell, &last, 1) != 1) ::_exit(98);
}

[[noreturn]] void be_the_child(const std::string& way, int pipe) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::close(STDERR_FILENO);
  // Restores the signal handling that a shell gives a program: the test program may have changed
  // it.
  for (const auto& [name, signal] : asking_signals()) std::signal(signal, SIG_DFL);
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGQUIT}) std::signal(signal, SIG_DFL);
  std::set_terminate(nullptr);
  PipeDevice device(pipe);
  ServoControl control;
  const StopOnSignals stop(device, control);
  pipe_to_tell = pipe;
  device_in_use = &device;
  StopOnSignals::set_crash_cleanup(last_act);
  leave_by(way, control, device);
  ::_exit(99);
}

WayOut take(const std::string& way) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(way, ends[1]);
  }
  ::close(ends[1]);
  WayOut out;
  char sent = 0;
  while (::read(ends[0], &sent, 1) == 1) out.sent += sent;
  ::close(ends[0]);
  REQUIRE(::waitpid(child, &out.status, 0) == child);
  return out;
}

char last_sent(const WayOut& out) {
  return out.sent[out.sent.find_last_not_of('L')];
}

TEST_CASE(
    "a program that is asked to end sends zero and leaves with the code that a shell expects") {
  const auto& [way, signal] = *std::next(asking_signals().begin(), GENERATE(range(0, 8)));
  const WayOut out = take(way);
  CAPTURE(way, out.sent);
  CHECK(out.sent.front() == 'F');
  CHECK(out.sent.back() == 'z');
  CHECK(out.sent.find('L') == std::string::npos);
  REQUIRE(WIFEXITED(out.status));
  CHECK(WEXITSTATUS(out.status) == 128 + signal);
}

TEST_CASE("a program that is asked twice ends at once, with the force at zero") {
  const WayOut out = take("SIGTERM twice");
  CHECK(last_sent(out) == 'z');
  CHECK(out.sent.find('L') != std::string::npos);
  REQUIRE(WIFSIGNALED(out.status));
  CHECK(WTERMSIG(out.status) == SIGTERM);
}

TEST_CASE("a crash sends zero before the program dies of it") {
  const auto [way, signal] = GENERATE(table<std::string, int>({{"abort", SIGABRT},
                                                               {"terminate", SIGABRT},
                                                               {"SIGSEGV", SIGSEGV},
                                                               {"SIGFPE", SIGFPE},
                                                               {"SIGQUIT", SIGQUIT}}));
  const WayOut out = take(way);
  CAPTURE(way, out.sent);
  CHECK(out.sent.front() == 'F');
  CHECK(last_sent(out) == 'z');
  CHECK(out.sent.find('L') != std::string::npos);
  REQUIRE(WIFSIGNALED(out.status));
  CHECK(WTERMSIG(out.status) == signal);
}

TEST_CASE("without a signal there is no exit code, and only one handler may exist") {
  RestingDevice device;
  ServoControl control;
  const StopOnSignals stop(device, control);
  CHECK_FALSE(StopOnSignals::stop_requested());
  CHECK(StopOnSignals::exit_code() == 0);
  CHECK(StopOnSignals::message().empty());
  CHECK_THROWS_AS(StopOnSignals(device, control), std::logic_error);
}

TEST_CASE("a program that was asked to end reports the signal") {
  RestingDevice device;
  ServoControl control;
  const StopOnSignals stop(device, control);
  std::raise(SIGTERM);
  CHECK(StopOnSignals::stop_requested());
  CHECK_THAT(StopOnSignals::message(), names("SIGTERM"));
  CHECK(control.emergency_stop_requested());
  CHECK(device.halts == 1);
}

}  // namespace
}  // namespace touchtrial
