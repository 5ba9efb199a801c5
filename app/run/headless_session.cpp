#include "app/run/headless_session.hpp"

#include "app/run/run_database.hpp"
#include "app/run/run_experimenter.hpp"
#include "app/run/session_end.hpp"
#include "app/run/session_entry.hpp"
#include "app/run/simulated_sitter.hpp"
#include "app/texts/study_texts.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/simulated_participant.hpp"

namespace touchtrial::app {

int run_headless(const RunOptions& options, const RunStudy& study) {
  store::StudyStore store = run_database_for(options, study);
  const session::StimulusSource source(study.pack, study.key.study.rendering);
  const SimulatedSitter sitter = simulated_sitter_for(options, study, source);
  const SimulatedCourse course = simulated_course(options);
  const EnteredSession entered = enter_session(
      options, study, store, [&](store::SessionOpening& opening) { course.describe(opening); });
  const std::unique_ptr<session::SessionClock> clock = course.clock(entered.clock);
  session::SimulatedParticipant participant(sitter.subject, sitter.knowledge, options.seed,
                                            entered.enrolment);
  session::AlwaysReady devices;
  RunExperimenter experimenter(session::no_experimenter(), {});
  const session::SessionTexts texts = session_texts(study.key.study);
  const session::SessionTally tally =
      session::run_session(*entered.session, {.key = study.key,
                                              .source = source,
                                              .participant = participant,
                                              .clock = *clock,
                                              .explorer = *course.explorer,
                                              .devices = devices,
                                              .experimenter = experimenter,
                                              .texts = texts,
                                              .participant_name = options.participant,
                                              .device_name = "simulated"});
  return conclude_session(options, entered.number, tally, store);
}

}  // namespace touchtrial::app
