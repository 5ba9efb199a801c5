#include "app/run/session_end.hpp"

#include "app/console.hpp"
#include "app/run/session_entry.hpp"
#include "core/errors.hpp"
#include "device/platform/stop_signals.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

constexpr int kShellOffset = 128;
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
  // A second signal ends the program at once: whoever sends it does not want to wait.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &earlier[i]);
}

EndingSignals::~EndingSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &earlier[i], nullptr);
}

int EndingSignals::which() noexcept {
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

RunExperimenter::RunExperimenter(session::Experimenter& inner, std::function<std::string()> gone,
                                 std::function<std::optional<session::ExperimenterRequest>()> more)
    : inner_(inner), gone_(std::move(gone)), more_(std::move(more)) {}

std::optional<session::ExperimenterRequest> RunExperimenter::request() {
  std::string why = EndingSignals::message();
  if (why.empty()) why = gone_();
  if (!why.empty())
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::leave, why, ""};
  if (auto request = more_ ? more_() : std::nullopt) return request;
  return inner_.request();
}

void RunExperimenter::acknowledged(int trial) {
  print("trial " + std::to_string(trial) + " acknowledged\n");
  inner_.acknowledged(trial);
}

namespace {

std::string summary(const RunOptions& options, int session, const session::SessionTally& tally,
                    bool is_complete, const store::StudyStore& store) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tally.duration).count();
  const char* const end = tally.left ? "left open" : is_complete ? "complete" : "stopped";
  return fmt::format("{}session {} of participant {}: {}, {} trials answered, {} min {} s\n",
                     options.is_simulated() ? "SIMULATED: " : "", session, options.participant, end,
                     answered_trials(store, session), seconds / 60, seconds % 60);
}

}  // namespace

int conclude_session(const RunOptions& options, int session, const session::SessionTally& tally,
                     const store::StudyStore& store) {
  const bool is_complete =
      store.session_of(options.participant)->state == store::SessionState::completed;
  print(summary(options, session, tally, is_complete, store));
  if (tally.left) {
    std::fprintf(stderr,
                 "touchtrial: %s; the session stays open: go on with the same command and "
                 "--on-existing resume (participant %s)\n",
                 one_line(*tally.left).c_str(), options.participant.c_str());
  }
  if (EndingSignals::which() != 0) return kShellOffset + EndingSignals::which();
  return is_complete && !tally.left ? 0 : 1;
}

}  // namespace touchtrial::app
