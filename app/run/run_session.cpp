#include "app/run/run_session.hpp"

#include "app/console.hpp"
#include "app/run/ending_signals.hpp"
#include "app/run/run_database.hpp"
#include "app/run/run_experimenter.hpp"
#include "app/run/run_study.hpp"
#include "app/run/session_entry.hpp"
#include "app/simulated_study.hpp"
#include "app/texts/study_texts.hpp"
#include "core/errors.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/simulated_participant.hpp"
#include "protocols/store/session_lock.hpp"

#include <cstdio>
#include <memory>
#include <thread>

#include <fmt/format.h>

namespace touchtrial {
namespace {

/// How time goes in a session.
struct Course {
  std::unique_ptr<SessionClock> clock;
  std::unique_ptr<Explorer> explorer;
};

Course course_of(const RunOptions& options, std::chrono::nanoseconds start,
                 std::unique_ptr<Explorer> explorer) {
  if (options.real_time) {
    return {std::make_unique<SteadySessionClock>(start), std::move(explorer)};
  }
  return {std::make_unique<VirtualSessionClock>(start), std::move(explorer)};
}

std::string summary(const RunOptions& options, const EnteredSession& entered,
                    const SessionTally& tally, const StudyStore& store) {
  int answered = 0;
  for (const TrialRow& trial : store.trials()) {
    if (trial.session == entered.number && trial.state == TrialState::answered) ++answered;
  }
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tally.duration).count();
  const char* const end = tally.left ? "left open"
                          : store.session_of(options.participant)->state == SessionState::completed
                              ? "complete"
                              : "stopped";
  return fmt::format("{}session {} of participant {}: {}, {} trials answered, {} min {} s\n",
                     options.is_simulated() ? "SIMULATED: " : "", entered.number,
                     options.participant, end, answered, seconds / 60, seconds % 60);
}

int exit_code(const RunOptions& options, const SessionTally& tally, const StudyStore& store) {
  constexpr int kShellOffset = 128;
  if (EndingSignals::which() != 0) return kShellOffset + EndingSignals::which();
  if (tally.left) return 1;
  return store.session_of(options.participant)->state == SessionState::completed ? 0 : 1;
}

void tell_how_it_ended(const RunOptions& options, const SessionTally& tally) {
  if (!tally.left) return;
  std::fprintf(stderr,
               "touchtrial: %s; the session stays open: go on with the same command and "
               "--on-existing resume (participant %s)\n",
               one_line(*tally.left).c_str(), options.participant.c_str());
}

void describe_simulated(SessionOpening& opening, const RunOptions& options,
                        const RealTimeExplorer* explorer) {
  opening.device = "simulated";
  opening.simulated = true;
  if (!options.real_time) return;
  const DeviceInfo device{"simulated", "", HandOptions{}.max_force_n, true};
  describe_station(opening, device, explorer->scheduling(), kServoRateHz, "");
  opening.simulated = true;
}

/// A simulated participant with a hand of their own, without any window.
int run_headless(const RunOptions& options, const RunStudy& study, StudyStore& store) {
  const StimulusSource source(study.pack, study.key.study.rendering);
  const SubjectModel subject = subject_for(*options.subject, study.key.study);
  const FeltKnowledge knowledge = learn_by_feeling(
      LabelledFields(study.key, source), subject, study.key.study.rendering.max_force_n,
      options.seed, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  std::unique_ptr<Explorer> explorer;
  RealTimeExplorer* real_time = nullptr;
  if (options.real_time) {
    auto made = std::make_unique<RealTimeExplorer>();
    real_time = made.get();
    explorer = std::move(made);
  } else {
    explorer = std::make_unique<VirtualExplorer>();
  }
  const EnteredSession entered = enter_session(options, study, store, [&](SessionOpening& opening) {
    describe_simulated(opening, options, real_time);
  });
  const Course course = course_of(options, entered.clock, std::move(explorer));
  SimulatedParticipant participant(subject, knowledge, options.seed, entered.enrolment);
  AlwaysReady devices;
  RunExperimenter experimenter(no_experimenter(), {});
  const SessionTexts texts = session_texts(study.key.study);
  const SessionTally tally =
      run_session(*entered.session,
                  {study.key, source, participant, *course.clock, *course.explorer, devices,
                   kServoRateHz, experimenter, texts, nullptr, options.participant, "simulated"});
  print(summary(options, entered, tally, store));
  tell_how_it_ended(options, tally);
  return exit_code(options, tally, store);
}

}  // namespace

int run_study_session(const RunOptions& options) {
  const EndingSignals signals;
  const RunStudy study = run_study_for(options);
  const SessionLock lock(options.database, options.participant);
  StudyStore store = run_database_for(options, study);
  return run_headless(options, study, store);
}

}  // namespace touchtrial
