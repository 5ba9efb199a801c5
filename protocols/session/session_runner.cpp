#include "protocols/session/session_runner.hpp"

#include "protocols/session/session_desk.hpp"
#include "protocols/session/session_stages.hpp"
#include "protocols/session/trial_run.hpp"

namespace touchtrial::session {
namespace {

// In virtual time; people take the time that they take.
constexpr std::chrono::seconds kBreak{60};
constexpr std::chrono::seconds kBetweenTrials{2};

void take_break(SessionDesk& desk) {
  Session& session = desk.session();
  session.take_break(desk.now());
  desk.enter("break");
  desk.parts().clock.pass(kBreak);
  const int done = session.presentations_begun();
  static_cast<void>(desk.attend(BreakStep{done, done + session.presentations_left()}));
}

void run_trials(SessionDesk& desk) {
  Session& session = desk.session();
  TrialRun trials(desk);
  const int most_interruptions = session.presentations_left();
  while (desk.goes_on() && session.phase() == SessionPhase::ready) {
    if (!desk.await_device()) continue;
    desk.parts().clock.pass(kBetweenTrials);
    if (session.break_due()) take_break(desk);
    if (!desk.goes_on() || session.phase() != SessionPhase::ready) continue;
    trials.run();
    static_cast<void>(desk.obey());
    if (desk.interruptions() > most_interruptions && session.accepts(SessionInput::stop)) {
      session.stop(desk.now(), "too many faults");
    }
  }
}

/// Nothing is asked any more that could be lost; whoever has seen it may go.
void show_end(SessionDesk& desk) {
  desk.enter("end");
  const auto asked_to_end = [&] {
    const auto request = desk.parts().experimenter.request();
    return request && (request->kind == ExperimenterRequest::Kind::leave ||
                       request->kind == ExperimenterRequest::Kind::abort);
  };
  while (!asked_to_end() && !desk.parts().participant.attend(EndStep{})) {
  }
}

}  // namespace

Experimenter& no_experimenter() {
  static Experimenter nobody;
  return nobody;
}

const SessionTexts& no_texts() {
  static const SessionTexts none;
  return none;
}

SessionTally run_session(Session& session, const SessionParts& parts) {
  SessionDesk desk(session, parts);
  if (run_opening_stages(desk)) run_trials(desk);
  if (session.phase() == SessionPhase::finished) ask_closing_questions(desk);
  if (!desk.tally().left) session.close(desk.now());
  desk.tally().duration = desk.now();
  if (!desk.tally().left) show_end(desk);
  return desk.tally();
}

SessionTally run_session_in_virtual_time(Session& session, const design::StudyKey& key,
                                         const StimulusSource& source, Participant& participant) {
  VirtualSessionClock clock;
  VirtualExplorer explorer;
  AlwaysReady devices;
  return run_session(session, {key, source, participant, clock, explorer, devices});
}

}  // namespace touchtrial::session
