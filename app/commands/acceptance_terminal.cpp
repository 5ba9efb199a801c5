#include "app/commands/acceptance_terminal.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"
#include "device/drivers/registry.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <iostream>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

constexpr double kNewtonsPerGram = 0.001 * device::kStandardGravityMS2;
/// Extra time, so that a run never ends before its last sample.
constexpr double kExtraTimeS = 2.0;

/// Suspends this program for two seconds, three seconds from now, through a separate shell.
class Suspension {
 public:
  Suspension() {
    const std::string script = fmt::format("sleep 3; kill -STOP {0}; sleep 2; kill -CONT {0}",
                                           static_cast<long>(::getpid()));
    std::string shell = "sh";
    std::string option = "-c";
    std::string text = script;
    const std::array<char*, 4> words = {shell.data(), option.data(), text.data(), nullptr};
    has_child_ = ::posix_spawnp(&child_, "sh", nullptr, nullptr, words.data(), environ) == 0;
  }
  ~Suspension() {
    if (has_child_) ::waitpid(child_, nullptr, 0);
  }
  Suspension(const Suspension&) = delete;
  Suspension& operator=(const Suspension&) = delete;
  [[nodiscard]] bool has_started() const noexcept { return has_child_; }

 private:
  pid_t child_ = -1;
  bool has_child_ = false;
};

/// Disables the check for frozen encoders: the position of a handle that hangs from a spring may
/// not change by one bit. Frozen encoders end the acceptance anyway, because the handle does not
/// follow a push.
device::SafetyLimits limits_of(device::HapticDevice& device, const device::DeviceUse& use) {
  device::SafetyLimits limits =
      device::limits_on(device.info(), device::stricter_of({}, use.limits));
  limits.frozen_s = std::numeric_limits<double>::infinity();
  return limits;
}
device::HapticDevice& require_motors(device::HapticDevice& device) {
  const device::DeviceInfo info = device.info();
  if (info.simulated || info.visual || !info.workspace) {
    throw DeviceError(
        info.name +
        ": has no motors; name a connected device from `touchtrial device list`, or rehearse "
        "without one with `touchtrial device accept --emulate MODEL`");
  }
  return device;
}

std::optional<double> newtons_in(const std::string& line) {
  if (line.ends_with('N')) return number_in<double>(line.substr(0, line.size() - 1));
  const auto mass_g = number_in<double>(line);
  if (!mass_g) return std::nullopt;
  return *mass_g * kNewtonsPerGram;
}

const char* instruction_for(device::DeviceAxis axis) {
  switch (axis) {
    case device::DeviceAxis::x:
      return "Lead a string horizontally to the right, over a pulley at the handle's height, and "
             "hang a weight on its end; or pull to the right with a spring scale.";
    case device::DeviceAxis::y:
      return "Hang a weight straight down from the handle; or pull down with a spring scale.";
    case device::DeviceAxis::z:
      break;
  }
  return "Lead a string horizontally towards you, over a pulley at the handle's height, and hang "
         "a weight on its end; or pull towards you with a spring scale.";
}

std::string ask_person(const std::string& question) {
  const std::optional<std::string> answer = attended_answer(question);
  if (!answer) throw AcceptanceStopped{};
  return *answer;
}

std::atomic<pid_t> acceptance_process{-1};

extern "C" void forward_to_acceptance(int signal) {
  const pid_t process = acceptance_process.load();
  if (process > 0) ::kill(process, signal);
}

}  // namespace

AcceptanceTerminal::AcceptanceTerminal(const std::string& driver,
                                       const device::DeviceSettings& settings)
    : device_(device::open_device(driver, settings)),
      limits_(limits_of(*device_, settings.use_of(driver))),
      run_(require_motors(*device_), limits_, device::kServoRateHz, false) {
  show(
      "Each step is described before it starts. Enter continues, s skips the step, q ends.\nCtrl-C "
      "switches the force off at once, at any time.\n");
  run_.wait_until_ready(kReadyLimitS);
  require_not_aborted();
  info_ = device_->info();
}

device::SafetyLimits AcceptanceTerminal::limits() const {
  device::SafetyLimits limits = limits_;
  limits.max_force_n = std::min(limits.max_force_n, max_n_);
  return limits;
}

void AcceptanceTerminal::limit_force(double max_n) {
  max_n_ = max_n;
  run_.limit_force(max_n);
}

device::ServoReport AcceptanceTerminal::run(const std::string& name,
                                            device::Measurement& measurement) {
  const auto report =
      run_.run([&](std::int64_t) { return name; }, measurement, measurement,
               measurement.seconds() + kExtraTimeS, [&] { return measurement.done(); });
  if (!report) throw AcceptanceStopped{};
  require_not_aborted();
  return *report;
}

std::optional<device::ServoReport> AcceptanceTerminal::run_suspended(
    device::Measurement& measurement) {
  const Suspension suspension;
  if (!suspension.has_started()) return std::nullopt;
  return run("suspend", measurement);
}

device::Consent AcceptanceTerminal::ready(const device::Prompt& prompt) {
  while (true) {
    const std::string answer = ask_person("\n" + prompt.text + "\n[Enter, s, q] ");
    if (answer.empty()) {
      device_->rearm();  // a fault of the previous run halted it
      return device::Consent::go;
    }
    if (answer == "s") return device::Consent::skip;
    if (answer == "q") throw AcceptanceStopped{};
    show("press Enter to continue, s to skip this, or q to end\n");
  }
}

std::optional<double> AcceptanceTerminal::weight_n(device::DeviceAxis axis, double min_n,
                                                   double max_n) {
  const std::string range =
      fmt::format("{:.0f} to {:.0f} g, or {:.2f} to {:.2f} N", min_n / kNewtonsPerGram,
                  std::floor(max_n / kNewtonsPerGram), min_n, max_n);
  show(fmt::format("\nAxis {}. {}\n", device::name_of(axis), instruction_for(axis)));
  while (true) {
    const std::string line = ask_person(fmt::format(
        "weight in g, or reading of a spring scale in N as in 1.2N ({}; s: none): ", range));
    if (line == "s") return std::nullopt;
    if (line == "q") throw AcceptanceStopped{};
    if (const auto force_n = newtons_in(line);
        force_n && *force_n >= min_n * (1.0 - 1e-9) && *force_n <= max_n) {
      return force_n;
    }
    show("that is not a weight in this range\n");
  }
}

std::optional<double> AcceptanceTerminal::temperature_c(const std::string& question) {
  while (true) {
    const std::string line = ask_person(question + " (Enter: no thermometer): ");
    if (line.empty()) return std::nullopt;
    const auto value = number_in<double>(line);
    if (value && *value > -50.0 && *value < 200.0) return value;
    show("that is not a temperature\n");
  }
}

std::string AcceptanceTerminal::ask_observation(const std::string& question) {
  const std::string answer = one_line(ask_person(question));
  if (answer == "q") throw AcceptanceStopped{};
  return answer;
}

void AcceptanceTerminal::show(const std::string& text) {
  std::cerr << text << (text.ends_with('\n') || text.ends_with(' ') ? "" : "\n") << std::flush;
}

void AcceptanceTerminal::require_not_aborted() const {
  if (run_.stop() != AttendedStop::none) throw AcceptanceStopped{};
}

int run_in_child_process(const std::function<int()>& work) {
  static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads it");
  const pid_t process = ::fork();
  if (process <= 0) return work();
  acceptance_process.store(process);
  // The terminal sends these signals to both processes.
  for (const int signal : {SIGINT, SIGQUIT, SIGTSTP}) {
    static_cast<void>(std::signal(signal, SIG_IGN));
  }
  for (const int signal : {SIGTERM, SIGHUP}) {
    static_cast<void>(std::signal(signal, forward_to_acceptance));
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int kSignalExitBase = 128;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalExitBase + WTERMSIG(status);
}

}  // namespace touchtrial::app
