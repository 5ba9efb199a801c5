#include "app/run/session_end.hpp"

#include "app/console.hpp"
#include "app/run/ending_signals.hpp"
#include "core/errors.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

std::string summary(const RunOptions& options, int session, const session::SessionTally& tally,
                    const store::StudyStore& store) {
  int answered = 0;
  for (const store::TrialRow& trial : store.trials()) {
    if (trial.session == session && trial.state == store::TrialState::answered) ++answered;
  }
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tally.duration).count();
  const char* const end =
      tally.left                                                                       ? "left open"
      : store.session_of(options.participant)->state == store::SessionState::completed ? "complete"
                                                                                       : "stopped";
  return fmt::format("{}session {} of participant {}: {}, {} trials answered, {} min {} s\n",
                     options.is_simulated() ? "SIMULATED: " : "", session, options.participant, end,
                     answered, seconds / 60, seconds % 60);
}

int exit_code(const RunOptions& options, const session::SessionTally& tally,
              const store::StudyStore& store) {
  constexpr int kShellOffset = 128;
  if (EndingSignals::which() != 0) return kShellOffset + EndingSignals::which();
  if (tally.left) return 1;
  return store.session_of(options.participant)->state == store::SessionState::completed ? 0 : 1;
}

void tell_how_it_ended(const RunOptions& options, const session::SessionTally& tally) {
  if (!tally.left) return;
  std::fprintf(stderr,
               "touchtrial: %s; the session stays open: go on with the same command and "
               "--on-existing resume (participant %s)\n",
               one_line(*tally.left).c_str(), options.participant.c_str());
}

}  // namespace

int conclude_session(const RunOptions& options, int session, const session::SessionTally& tally,
                     const store::StudyStore& store) {
  print(summary(options, session, tally, store));
  tell_how_it_ended(options, tally);
  return exit_code(options, tally, store);
}

}  // namespace touchtrial::app
