#include "app/run/attended_run.hpp"

#include "app/commands/device_words.hpp"
#include "core/errors.hpp"
#include "device/servo/servo_clock.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

using namespace std::chrono_literals;

/// Time between two live lines, which are overwritten on a terminal and scroll elsewhere.
constexpr std::chrono::nanoseconds kTerminalInterval = 250ms;
constexpr std::chrono::nanoseconds kPipeInterval = 1s;

/// Time between two polls of keys, signals and the servo.
constexpr auto kFrameInterval = 16ms;

/// Time between two checks for signals while an answer is typed.
constexpr int kAnswerPollMs = 100;

/// Longer than a held key takes to repeat, even the first time (660 ms by default in X).
constexpr std::chrono::nanoseconds kFreshPressDelay = 1s;

device::ServoOptions options_for(const device::SafetyLimits& limits, double rate_hz) {
  device::ServoOptions options;
  options.limits = limits;
  options.rate_hz = rate_hz;
  options.fade_ticks = std::llround(0.1 * rate_hz);
  return options;
}

/// \return nothing if a signal asked the program to end
/// \throws UsageError at the end of the input
std::optional<std::string> read_input_line() {
  std::string line;
  while (!device::StopOnSignals::stop_requested()) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (::poll(&input, 1, kAnswerPollMs) <= 0) continue;
    // Reads one character at a time, so that later lines stay in the input.
    char letter = 0;
    const ssize_t count = ::read(STDIN_FILENO, &letter, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      throw UsageError("standard input ended; answer every prompt");
    }
    if (letter == '\n') return line;
    line += letter;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> attended_answer(const std::string& question) {
  const bool has_keys = ::isatty(STDIN_FILENO) != 0;
  if (has_keys) ::tcflush(STDIN_FILENO, TCIFLUSH);
  std::fputs(question.c_str(), stderr);
  std::fflush(stderr);
  std::chrono::nanoseconds quiet_since = device::monotonic_now();
  bool is_announced = false;
  while (const std::optional<std::string> line = read_input_line()) {
    const std::chrono::nanoseconds now = device::monotonic_now();
    if (!has_keys || !line->empty() || now - quiet_since >= kFreshPressDelay) return line;
    quiet_since = now;
    if (!is_announced)
      std::fputs("release Enter, read the question, and press Enter again after a second\n",
                 stderr);
    is_announced = true;
  }
  return std::nullopt;
}

AttendedRun::AttendedRun(device::HapticDevice& device, const device::SafetyLimits& limits,
                         double rate_hz, bool reads_keys)
    : device_(device),
      options_(options_for(limits, rate_hz)),
      max_force_n_(limits.max_force_n),
      recorder_(kRecordedS, rate_hz),
      watchdog_(device, control_, heartbeat_, device::Watchdog::silence_for(device.info())),
      signals_(device, control_),
      is_on_terminal_(::isatty(STDERR_FILENO) != 0) {
  if (!reads_keys) return;
  device::StopOnSignals::set_crash_cleanup(TerminalKeys::restore);
  keys_.emplace();
}

AttendedRun::~AttendedRun() {
  keys_.reset();
  device::StopOnSignals::set_crash_cleanup(nullptr);
}

std::optional<device::ServoReport> AttendedRun::run(const PhaseName& phase,
                                                    device::ForceSource& force,
                                                    device::SampleSink& sink, double seconds,
                                                    const std::function<bool()>& is_done) {
  if (device::StopOnSignals::stop_requested()) stop_ = AttendedStop::signal;
  if (stop_ != AttendedStop::none) return std::nullopt;
  options_.limit_ticks = std::llround(seconds * options_.rate_hz);
  recorder_.clear();
  shown_tick_ = 0;
  shown_at_ = device::monotonic_now();
  device::ServoReport report;
  const device::WatchdogGuard guard(watchdog_);
  const device::ServoHooks hooks{.control = &control_,
                                 .state = &state_,
                                 .heartbeat = &heartbeat_,
                                 .recorder = &recorder_,
                                 .heat = &heat_,
                                 .parameters = &parameters_};
  device::RunningServo running(thread_, control_, [&] {
    device::PacedClock clock(device::PacedClock::default_spin(thread_.scheduling().policy));
    report = device::run_servo(device_, force, sink, options_, clock, hooks);
  });
  while (running.is_running()) {
    std::this_thread::sleep_for(kFrameInterval);
    handle_keys();
    if (is_done && is_done()) control_.finish();
    show(phase);
  }
  running.finish();
  clear_live_line();
  // A stop ends all later runs too, but finish() ends only one.
  if (stop_ == AttendedStop::none) control_.reset();
  return report;
}

void AttendedRun::wait_until_ready(double limit_s) {
  const device::DeviceReadiness readiness = device_.readiness();
  if (readiness == device::DeviceReadiness::ready) return;
  const std::string name = device_.info().name;
  const std::string advice = readiness_in_words(readiness);
  const bool needs_confirmation = readiness == device::DeviceReadiness::needs_reset;
  if (needs_confirmation && !keys_) {
    if (attended_answer(name + ": " + advice + "; then press Enter\n")) device_.calibrate();
  } else {
    std::fprintf(stderr, "%s: %s%s\n", name.c_str(), advice.c_str(),
                 needs_confirmation ? "; then press h" : "");
  }
  NoForce no_force;
  const auto report = run([](std::int64_t) { return "homing"; }, no_force, no_force, limit_s,
                          [&] { return device_.readiness() == device::DeviceReadiness::ready; });
  if (stop_ != AttendedStop::none) return;
  if (report && report->end == device::ServoEnd::fault) {
    throw DeviceError(name + ": fault while homing: " + fault_names(*report) +
                      "; check cable and power, then try again");
  }
  if (device_.readiness() != device::DeviceReadiness::ready) {
    throw DeviceError(fmt::format("{}: is not ready after {:.0f} s; {}", name, limit_s, advice));
  }
}

void AttendedRun::limit_force(double max_n) noexcept {
  options_.limits.max_force_n = std::min(max_force_n_, max_n);
}

std::string AttendedRun::flight_record() const {
  return device::flight_csv(recorder_.ticks());
}

void AttendedRun::handle_keys() {
  if (device::StopOnSignals::stop_requested()) stop_ = AttendedStop::signal;
  if (!keys_) return;
  for (auto key = keys_->next(); key; key = keys_->next()) {
    if (stop_ != AttendedStop::none) continue;
    if (*key == 'q' || *key == 'Q') {
      stop_ = AttendedStop::quit;
      control_.finish();
    } else if (*key == ' ') {
      stop_ = AttendedStop::comfort;
      control_.comfort_stop();
    } else if (*key == 'h') {
      device_.calibrate();
    } else if (has_strength_keys_) {
      handle_strength_key(*key);
    }
  }
}

void AttendedRun::handle_strength_key(char key) {
  if (key != '+' && key != '-') return;
  strength_tenths_ = std::clamp(strength_tenths_ + (key == '+' ? 1 : -1), 1, 10);
  parameters_.set({.force_share = 0.1 * strength_tenths_});
  clear_live_line();
  std::fprintf(stderr, "strength %d %%\n", 10 * strength_tenths_);
}

void AttendedRun::show(const PhaseName& phase) {
  const std::chrono::nanoseconds now = device::monotonic_now();
  if (now - shown_at_ < (is_on_terminal_ ? kTerminalInterval : kPipeInterval)) return;
  const device::ServoState newest = state_.get();
  const double elapsed_s = 1e-9 * static_cast<double>((now - shown_at_).count());
  const double rate_hz = static_cast<double>(newest.tick - shown_tick_) / elapsed_s;
  const Vec3 p = newest.sample.position_mm;
  const Vec3 f = newest.force_n;
  // Shorter than 80 columns, because a wrapped line cannot be overwritten.
  const std::string line = fmt::format(
      "{:<7} {:3.0f} s {:6.1f} {:6.1f} {:6.1f} mm {:5.2f} {:5.2f} {:5.2f} N {:5.0f}/s {:3.0f} us "
      "late",
      phase(newest.tick), static_cast<double>(newest.tick) / options_.rate_hz, p.x, p.y, p.z, f.x,
      f.y, f.z, rate_hz, std::min(newest.lateness_us, 9999.0));
  std::fprintf(stderr, is_on_terminal_ ? "\r%s\x1b[K" : "%s\n", line.c_str());
  std::fflush(stderr);
  shown_at_ = now;
  shown_tick_ = newest.tick;
}

void AttendedRun::clear_live_line() {
  if (is_on_terminal_) std::fputs("\r\x1b[K", stderr);
}

}  // namespace touchtrial::app
