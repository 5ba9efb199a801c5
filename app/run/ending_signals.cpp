#include "app/run/ending_signals.hpp"

#include "device/platform/stop_signals.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace touchtrial::app {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::array kNames = {"SIGINT", "SIGTERM", "SIGHUP"};

std::atomic<int> came{0};
std::array<struct sigaction, kSignals.size()> earlier{};

extern "C" void remember(int signal) {
  came.store(signal);
}

}  // namespace

EndingSignals::EndingSignals() {
  came.store(0);
  struct sigaction action {};
  action.sa_handler = remember;
  // A second one ends the program at once: whoever sends it does not want to wait.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &earlier[i]);
}

EndingSignals::~EndingSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &earlier[i], nullptr);
}

int EndingSignals::which() noexcept {
  constexpr int kShellOffset = 128;
  if (device::StopOnSignals::asked()) return device::StopOnSignals::exit_code() - kShellOffset;
  return came.load();
}

std::string EndingSignals::message() {
  if (device::StopOnSignals::asked()) return device::StopOnSignals::message();
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i] == came.load()) return std::string("stopped by ") + kNames[i];
  }
  return "";
}

}  // namespace touchtrial::app
