#include "app/run/attended_session.hpp"

#include "app/experimenter/console_experimenter.hpp"
#include "app/experimenter/spoken_answers.hpp"
#include "app/experimenter/terminal_experimenter.hpp"
#include "app/participant/participant_window.hpp"
#include "app/participant/window_subject.hpp"
#include "app/run/answer_pictures.hpp"
#include "app/run/practice_of.hpp"
#include "app/run/run_database.hpp"
#include "app/run/run_experimenter.hpp"
#include "app/run/session_device.hpp"
#include "app/run/session_end.hpp"
#include "app/run/session_entry.hpp"
#include "app/run/simulated_sitter.hpp"
#include "app/sound/session_sound.hpp"
#include "app/texts/study_texts.hpp"
#include "core/errors.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/simulated_participant.hpp"

#include <optional>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

ParticipantWindowOptions window_options(const RunOptions& options, const design::Study& study) {
  ParticipantWindowOptions window;
  window.monitor = options.monitor;
  window.size_px = options.window_px;
  window.language = study.session.language;
  window.sight = study.session.sight;
  window.pictures = answer_pictures(study);
  window.pitch_mm = study.rendering.pitch_mm;
  return window;
}

std::string why_gone(const ParticipantWindow& window) {
  const auto gone = window.gone();
  if (!gone || *gone == WindowGone::signal) return "";
  return *gone == WindowGone::closed ? "the participant's window was closed"
                                     : "the participant's monitor was unplugged";
}

/// What a person hears. A device that is only seen makes no sound that would have to be covered.
design::MaskingPlan masking_of(const RunOptions& options, const design::Study& study,
                               const device::DeviceInfo& device) {
  design::MaskingPlan plan = study.session.masking;
  plan.wanted = plan.wanted && options.sound && !device.visual;
  return plan;
}

/// What was not as the study asks before the session began.
std::vector<session::ExperimenterRequest> known_deviations(const RunOptions& options,
                                                           const design::Study& study,
                                                           const SessionDevice& device) {
  std::vector<session::ExperimenterRequest> known = device.to_record();
  if (study.session.masking.wanted && !options.sound && !device.info().visual) {
    known.push_back(
        {session::ExperimenterRequest::Kind::deviation, "--no-sound", "no-masking-noise"});
  }
  return known;
}

/// A device that is only seen needs no warming up, no curtain and no headphones.
session::SessionTexts texts_for(const design::Study& study, const device::DeviceInfo& device) {
  session::SessionTexts texts = session_texts(study);
  if (device.visual) texts.day_sheet.clear();
  return texts;
}

/// Force never comes on by itself.
void require_consent(const device::DeviceInfo& device) {
  if (device.visual || ::isatty(STDIN_FILENO) != 0) return;
  throw UsageError(
      "run: standard input is no terminal, where the experimenter lets the force on; start it from "
      "a terminal");
}

/// Everything around one person's session.
class PersonsSession {
 public:
  PersonsSession(const RunOptions& options, const RunStudy& study)
      : options_(options),
        study_(study),
        source_(study.pack, study.key.study.rendering),
        terminal_(standard_terminal()),
        device_(options, source_.plane(), terminal_),
        store_(run_database_for(options, study)),
        sound_(masking_of(options, study.key.study, device_.info()), study.key.study.seed) {
    require_consent(device_.info());
    if (!sound_.trouble().empty()) spdlog::warn("{}", sound_.trouble());
    for (const session::ExperimenterRequest& known :
         known_deviations(options, study.key.study, device_)) {
      terminal_.add(known);
    }
  }

  int run() {
    ParticipantWindowOptions wanted = window_options(options_, study_.key.study);
    wanted.device = [this]() -> device::HapticDevice& { return device_.device(); };
    wanted.pointer = device_.pointer();
    if (options_.sound) wanted.cues = &sound_;
    if (options_.console) wanted.console = &console_;
    if (options_.console_monitor > 0) wanted.console_monitor = options_.console_monitor;
    ParticipantWindow window(wanted);
    int code = 1;
    run_beside(window, [&] { code = run_before(window); });
    return code;
  }

 private:
  int run_before(ParticipantWindow& window) {
    session::RealTimeExplorer explorer;
    const EnteredSession entered =
        enter_session(options_, study_, store_, [&](store::SessionOpening& opening) {
          session::describe_station(opening, device_.info(), explorer.scheduling(),
                                    device::kServoRateHz, device_.certificate());
        });
    session::SteadySessionClock clock(entered.clock);
    const ParticipantPractice practice(study_, source_.plane(), entered.enrolment);
    SpokenAnswers spoken(window, terminal_);
    const bool speaks = study_.key.study.session.sight == design::Sight::blindfold;
    RunExperimenter experimenter(
        console_, [&] { return why_gone(window); }, [this] { return sound_.to_record(); });
    const session::SessionTexts texts = texts_for(study_.key.study, device_.info());
    const session::SessionTally tally = session::run_session(
        *entered.session,
        {.key = study_.key,
         .source = source_,
         .participant = speaks ? static_cast<session::Participant&>(spoken) : window,
         .clock = clock,
         .explorer = explorer,
         .devices = device_.station(),
         .experimenter = experimenter,
         .texts = texts,
         .practice = practice.textures(),
         .participant_name = options_.participant,
         .device_name = device_.driver(),
         .limits = device_.limits()});
    return conclude_session(options_, entered.number, tally, store_);
  }

  const RunOptions& options_;
  const RunStudy& study_;
  session::StimulusSource source_;
  TerminalExperimenter terminal_;
  ConsoleExperimenter console_{terminal_};
  SessionDevice device_;
  store::StudyStore store_;  ///< not made for nothing: the device is there
  SessionSound sound_;
};

}  // namespace

int run_attended(const RunOptions& options, const RunStudy& study) {
  return PersonsSession(options, study).run();
}

int run_simulated_at_window(const RunOptions& options, const RunStudy& study) {
  store::StudyStore store = run_database_for(options, study);
  const session::StimulusSource source(study.pack, study.key.study.rendering);
  const SimulatedSitter sitter = simulated_sitter_for(options, study, source);
  const session::SessionTexts texts = session_texts(study.key.study);
  ParticipantWindow window(window_options(options, study.key.study));
  int code = 1;
  run_beside(window, [&] {
    const SimulatedCourse course = simulated_course(options);
    const EnteredSession entered = enter_session(
        options, study, store, [&](store::SessionOpening& opening) { course.describe(opening); });
    const std::unique_ptr<session::SessionClock> clock = course.clock(entered.clock);
    session::SimulatedParticipant mind(sitter.subject, sitter.knowledge, options.seed,
                                       entered.enrolment);
    WindowSubject participant(window, mind, options.real_time);
    session::AlwaysReady devices;
    RunExperimenter experimenter(session::no_experimenter(), [&] { return why_gone(window); });
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
    code = conclude_session(options, entered.number, tally, store);
  });
  return code;
}

}  // namespace touchtrial::app
