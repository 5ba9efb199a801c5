#include "app/run/run_session.hpp"

#include "app/commands/device_words.hpp"
#include "app/commands/participant_ids.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/run/database_watch.hpp"
#include "app/run/participant_dialogue.hpp"
#include "app/run/run_study.hpp"
#include "app/run/session_bounds.hpp"
#include "app/run/session_device.hpp"
#include "app/run/session_instruments.hpp"
#include "app/sound/session_sound.hpp"
#include "app/texts/study_texts.hpp"
#include "app/windows/experimenter/experimenter_desk.hpp"
#include "app/windows/experimenter/terminal_face.hpp"
#include "app/windows/participant/page_layout.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/model/workspace_fit.hpp"
#include "engine/image_file.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_clock.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/session_stages.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/trial_course.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

/// The first image of every class by its label, including the classes of practice, and the pictures
/// of the instructions.
std::map<std::string, GreyImage> answer_pictures(const study::Study& study) {
  std::map<std::string, GreyImage> pictures;
  const auto add = [&](const std::vector<study::StudyClass>& classes) {
    for (const study::StudyClass& shown : classes) {
      pictures.emplace(shown.label, engine::read_grey_image(study.folder / shown.images.front()));
    }
  };
  add(study.classes);
  add(study.practice.classes);
  for (const std::string& file : study::picture_files(study.session)) {
    pictures.emplace(page_picture(file), engine::read_grey_image(study.folder / file));
  }
  return pictures;
}

}  // namespace

ParticipantWindowOptions window_options(const RunOptions& options, const study::Study& study) {
  ParticipantWindowOptions window;
  window.monitor = options.monitor;
  window.size_px = options.window_px;
  window.session = study.session;
  window.session.text_scale = options.text_scale.value_or(study.session.text_scale);
  window.session.high_contrast = study.session.high_contrast || options.high_contrast;
  window.pictures = answer_pictures(study);
  window.pitch_mm = study.rendering.pitch_mm;
  window.has_several_methods = study.presented_methods() > 1;
  window.min_touch = study.trials.answer_after;
  window.ask = study::ask_of(study);
  window.stiffness_n_per_mm = study.rendering.stiffness_n_per_mm;
  return window;
}

namespace {

std::string window_end_reason(const ParticipantWindow& window) {
  const auto end_reason = window.end_reason();
  if (!end_reason || *end_reason == WindowEnd::signal) return "";
  return *end_reason == WindowEnd::closed ? "the participant's window was closed"
                                          : "the participant's monitor was unplugged";
}

/// While another program locks the database: shows why the session waits.
/// \return whether to continue waiting
bool waits(const std::string& why, const std::function<void()>& show) {
  spdlog::warn("{}; the session waits", why);
  show();
  return EndingSignals::which() == 0;
}

/// The record of a wait for a locked database.
std::optional<session::ExperimenterRequest> wait_to_record(PatientSink& sink) {
  const auto waited = sink.take_delay();
  if (!waited) return std::nullopt;
  const double seconds = std::chrono::duration<double>(*waited).count();
  return session::ExperimenterRequest{session::ExperimenterRequest::Kind::delay,
                                      fmt::format("waited {:.1f} s for the database", seconds),
                                      "database-locked"};
}

/// Pauses the session when a plane is on but the participant's keys do not reach the window, and
/// resumes it once they do. Belongs to the session's thread.
class FocusWatch {
 public:
  explicit FocusWatch(ParticipantWindow& window) : window_(window) {}

  [[nodiscard]] std::optional<session::ExperimenterRequest> request() {
    using Kind = session::ExperimenterRequest::Kind;
    constexpr std::chrono::milliseconds kFocusTimeout{500};
    const std::chrono::milliseconds lost = window_.out_of_reach();
    if (window_.take_out_of_reach() && !std::exchange(is_recorded_, true)) {
      return session::ExperimenterRequest{Kind::deviation, kWhat, "focus-lost"};
    }
    const bool is_in_trial = window_.is_exploring() || window_.is_answering();
    if (lost >= kFocusTimeout && is_in_trial && !std::exchange(has_paused_, true)) {
      return session::ExperimenterRequest{Kind::pause, kWhat, ""};
    }
    if (lost > std::chrono::milliseconds{}) return std::nullopt;
    is_recorded_ = false;
    if (!std::exchange(has_paused_, false)) return std::nullopt;
    return session::ExperimenterRequest{Kind::resume, "", ""};
  }

  /// SessionStatus::alert.
  [[nodiscard]] std::string alert() const {
    constexpr std::chrono::seconds kAlarming{1};
    if (window_.out_of_reach() < kAlarming) return "";
    return "another window has the keyboard; click on the participant's window";
  }

 private:
  static constexpr const char* kWhat = "another window had the keyboard during a trial";

  ParticipantWindow& window_;
  bool is_recorded_ = false;
  bool has_paused_ = false;
};

/// A visual device makes no sound that would need masking.
study::MaskingPlan masking_of(const study::Study& study, const device::DeviceInfo& device) {
  study::MaskingPlan plan = study.session.masking;
  plan.wanted = plan.wanted && !device.visual;
  return plan;
}

/// Deviations that are known before the session begins, and notes on the participant.
std::vector<session::ExperimenterRequest> known_deviations(const RunOptions& options,
                                                           const RunStudy& study,
                                                           const SessionDevice& device) {
  std::vector<session::ExperimenterRequest> known = device.to_record();
  if (!options.remark.empty()) {
    known.push_back({session::ExperimenterRequest::Kind::note, options.remark, ""});
  }
  if (options.no_consent) {
    spdlog::warn("participant {} has not signed the consent form; the record says so",
                 options.participant);
    known.push_back({session::ExperimenterRequest::Kind::deviation,
                     "answered so in the dialogue at the start", "no-consent"});
  }
  if (!study.key_in_reach.empty()) {
    known.push_back({session::ExperimenterRequest::Kind::deviation,
                     "the investigator's key lies beside the study", "key-at-station"});
  }
  if (study.key.study.session.masking.wanted && !options.sound && !device.info().visual) {
    known.push_back(
        {session::ExperimenterRequest::Kind::deviation, "--no-sound", "no-masking-noise"});
  }
  return known;
}

/// Notes on the participant's screen settings, for the session's record.
std::vector<session::ExperimenterRequest> notes_on_screens(const RunOptions& options,
                                                           const study::Study& study) {
  std::vector<session::ExperimenterRequest> notes;
  const auto note = [&notes](const std::string& text) {
    notes.push_back({session::ExperimenterRequest::Kind::note, text, ""});
  };
  if (const std::string draft = study::draft_notice(study.session.language); !draft.empty()) {
    spdlog::warn("{}", draft);
    note(draft);
  }
  if (options.text_scale) note("size of the letters: " + number_text(*options.text_scale));
  if (options.high_contrast) note("high contrast");
  return notes;
}

/// A visual device needs no warm-up, no curtain and no headphones.
session::SessionTexts texts_for(const study::Study& study, const device::DeviceInfo& device) {
  session::SessionTexts texts = session_texts(study);
  if (device.visual) texts.day_sheet.clear();
  return texts;
}

void require_blind(const RunOptions& options, const device::DeviceInfo& device) {
  if (!device.visual || options.pilot) return;
  throw UsageError("run: device '" + device.name +
                   "' is seen on a screen and not felt, which is not blind; give --pilot and a "
                   "pilot's database, or choose a device that is felt");
}

/// Without a known screen size, the true size of pictures is unknown.
void warn_of_unknown_size(const RunOptions& options, const study::Study& study,
                          const ParticipantWindow& window) {
  if (study.session.sight == study::Sight::blindfold || window.screen().is_known) return;
  const study::Ask ask = study::ask_of(study);
  if (!ask.has_pictures() && ask.scales().empty()) return;
  spdlog::warn(
      "window: the size of this screen and of the pictures is unknown; measure it once "
      "with `touchtrial screen calibrate{}`",
      options.monitor > 1 ? " --monitor " + std::to_string(options.monitor) : "");
}

/// \throws as device::check_stiffness
void warn_of_stiffness(const engine::RenderingOptions& rendering,
                       const device::DeviceInfo& device) {
  const std::string warning = device::check_stiffness(rendered_stiffness(rendering), device);
  if (!warning.empty()) spdlog::warn("{}", warning);
}

record::ScreenRecord record_of(const ScreenScale& screen) {
  return {screen.mm_per_unit, screen.is_measured ? "measured"
                              : screen.is_known  ? "stated"
                                                 : "assumed"};
}

/// Whether the experimenter has a keyboard at the terminal, or a window.
bool is_attended(const RunOptions& options) {
  return options.console || ::isatty(STDIN_FILENO) != 0;
}

/// Refuses a session in which the experimenter could not consent to force.
void require_consent(const RunOptions& options, const device::DeviceInfo& device) {
  if (device.visual || is_attended(options)) return;
  throw UsageError(
      "run: standard input is not a terminal, which the experimenter needs to switch on the force; "
      "start it from a terminal, or with --console");
}

/// A person's session with a device and a window.
class PersonsSession {
 public:
  PersonsSession(const RunOptions& options, const RunStudy& study)
      : options_(options),
        study_(study),
        database_(options, study),
        source_(study.source),
        desk_(is_attended(options)),
        terminal_(desk_, standard_terminal()),
        device_(options, source_.plane(), desk_),
        instruments_(session_instruments(device_.instruments(), device::kServoRateHz)) {
    require_blind(options, device_.info());
    require_consent(options, device_.info());
    device_.require_stable_wall(study.key.study.rendering.stiffness_n_per_mm);
    warn_of_stiffness(study.key.study.rendering, device_.info());
    if (options.sound) {
      sound_.emplace(masking_of(study.key.study, device_.info()), study.key.study.seed);
      if (!sound_->trouble().empty()) spdlog::warn("{}", sound_->trouble());
    }
    for (const session::ExperimenterRequest& known : known_deviations(options, study, device_)) {
      desk_.add(known);
    }
    for (const auto& note : notes_on_screens(options, study.key.study)) desk_.add(note);
  }

  int run() {
    ParticipantWindowOptions wanted = window_options(options_, study_.key.study);
    wanted.device = [this]() -> device::HapticDevice& { return device_.device(); };
    wanted.pointer = device_.pointer();
    if (sound_) wanted.cues = &*sound_;
    if (options_.console) wanted.console = &desk_;
    if (options_.console_monitor > 0) wanted.console_monitor = options_.console_monitor;
    ParticipantWindow window(wanted);
    warn_of_unknown_size(options_, study_.key.study, window);
    screen_ = record_of(window.screen());
    int code = 1;
    run_beside(window, [&] { code = run_before(window); });
    return code;
  }

 private:
  int run_before(ParticipantWindow& window) {
    session::RealTimeExplorer explorer;
    const EnteredSession entered =
        enter_session(options_, study_, database_, [&](record::SessionOpening& opening) {
          session::describe_station(opening, device_.info(), explorer.scheduling(),
                                    device::kServoRateHz, device_.certificate());
          opening.station->screen = screen_;
        });
    if (!study_.key_in_reach.empty()) {
      spdlog::warn(
          "{}: the investigator's key lies at this station, which is recorded as a deviation; move "
          "it to another medium",
          study_.key_in_reach.string());
    }
    session::SteadySessionClock clock(entered.clock);
    SpokenAnswers spoken(window, desk_);
    DatabaseWatch watch(options_.database);
    FocusWatch focus(window);
    RunExperimenter experimenter(
        desk_,
        [&] {
          const std::string trouble = watch.trouble();
          return trouble.empty() ? window_end_reason(window) : trouble;
        },
        [&] { return recorded_by_itself(*entered.sink, focus); }, [&] { return focus.alert(); });
    entered.sink->set_waiting([&](const std::string& why) {
      return waits(why, [&] { static_cast<void>(spoken.attend(session::PauseStep{})); });
    });
    const session::SessionTexts texts = texts_for(study_.key.study, device_.info());
    const session::SessionTally tally = session::run_session(
        *entered.session,
        {.key = study_.key,
         .source = source_,
         .participant = spoken,
         .clock = clock,
         .explorer = explorer,
         .devices = device_.station(),
         .experimenter = experimenter,
         .texts = texts,
         .practice =
             [&](int round) { return study::practice_of(study_.key.study, entered.draw, round); },
         .participant_name = options_.participant,
         .device_name = device_.shown_name(),
         .limits = device_.limits(),
         .instruments = instruments_.get()});
    terminal_.end_line();
    return conclude_session(options_, entered.number, tally, database_.made(), watch.trouble());
  }

  /// The program's own records (sound, window, database), one request at a time.
  [[nodiscard]] std::optional<session::ExperimenterRequest> recorded_by_itself(PatientSink& sink,
                                                                               FocusWatch& focus) {
    if (auto request = wait_to_record(sink)) return request;
    if (auto request = focus.request()) return request;
    return sound_ ? sound_->to_record() : std::nullopt;
  }

  const RunOptions& options_;
  const RunStudy& study_;
  RunDatabase database_;
  const session::StimulusSource& source_;
  ExperimenterDesk desk_;
  TerminalFace terminal_;
  SessionDevice device_;
  std::unique_ptr<session::Instruments> instruments_;
  record::ScreenRecord screen_;
  std::optional<SessionSound> sound_;  ///< empty with --no-sound
};

/// Time in a simulated participant's session is virtual unless the options ask for real time.
std::unique_ptr<session::Explorer> explorer_for(const RunOptions& options) {
  if (options.real_time) return std::make_unique<session::RealTimeExplorer>();
  return std::make_unique<session::VirtualExplorer>();
}

/// There are no instruments in virtual time.
std::unique_ptr<session::Instruments> instruments_for(const RunOptions& options) {
  if (!options.real_time) return nullptr;
  return session_instruments(device::device_settings_for(options.settings).instruments,
                             device::kServoRateHz);
}

std::unique_ptr<session::SessionClock> clock_for(const session::Explorer& explorer,
                                                 std::chrono::nanoseconds start) {
  if (explorer.in_real_time()) return std::make_unique<session::SteadySessionClock>(start);
  return std::make_unique<session::VirtualSessionClock>(start);
}

/// Describes the simulated device in the session's first event.
void describe_simulated(const session::Explorer& explorer, const device::DeviceModel& held,
                        record::SessionOpening& opening) {
  if (const auto* const real_time = dynamic_cast<const session::RealTimeExplorer*>(&explorer)) {
    const device::DeviceInfo device{"simulated", "", device::HandOptions{}.max_force_n, true};
    session::describe_station(opening, device, real_time->scheduling(), device::kServoRateHz, "");
  }
  opening.device = device::words_of_simulated(held);
  opening.simulated = true;
}

/// A simulated participant's session.
class SimulatedSession {
 public:
  /// Trains the subject on the study's classes, which takes about half a second.
  /// \throws as subject_for
  SimulatedSession(const RunOptions& options, const RunStudy& study)
      : options_(options),
        study_(study),
        database_(options, study),
        source_(study.source),
        instruments_(instruments_for(options)),
        subject_(subject_for(*options.subject, study.key.study, options.on)),
        population_(simulation::population_of(
            {study.key, source_, subject_, options.seed,
             static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))})) {}

  int run() {
    const std::unique_ptr<session::Explorer> explorer = explorer_for(options_);
    const EnteredSession entered =
        enter_session(options_, study_, database_, [&](record::SessionOpening& opening) {
          describe_simulated(*explorer, subject_.device, opening);
        });
    const std::unique_ptr<session::SessionClock> clock = clock_for(*explorer, entered.clock);
    const std::unique_ptr<simulation::SimulatedParticipant> simulated =
        population_->participant(entered.enrolment);
    simulated->start_visit(
        options_.visit,
        simulation::course_of(study_.key.study,
                              study::make_schedule(study_.key.study, entered.draw)));
    session::AlwaysReady devices;
    DatabaseWatch watch(options_.database);
    RunExperimenter experimenter(
        session::no_experimenter(), [&] { return watch.trouble(); },
        [&] { return wait_to_record(*entered.sink); });
    entered.sink->set_waiting([](const std::string& why) { return waits(why, [] {}); });
    const session::SessionTexts texts = session_texts(study_.key.study);
    const session::SessionTally tally =
        session::run_session(*entered.session, {.key = study_.key,
                                                .source = source_,
                                                .participant = *simulated,
                                                .clock = *clock,
                                                .explorer = *explorer,
                                                .devices = devices,
                                                .experimenter = experimenter,
                                                .texts = texts,
                                                .participant_name = options_.participant,
                                                .device_name = "simulated",
                                                .instruments = instruments_.get()});
    return conclude_session(options_, entered.number, tally, database_.made(), watch.trouble());
  }

 private:
  const RunOptions& options_;
  const RunStudy& study_;
  RunDatabase database_;
  const session::StimulusSource& source_;
  std::unique_ptr<session::Instruments> instruments_;
  simulation::SubjectModel subject_;
  std::unique_ptr<const simulation::Population> population_;
};

}  // namespace

int run_study_session(const RunOptions& given) {
  if (!given.participant.empty()) {
    confirm_id("run", given.database, given.participant, given.yes);
  }
  const EndingSignals signals;
  RunStudy study = run_study_for(given);
  confirm_enrolment(given, study.key);
  const RunOptions options = given.participant.empty() ? with_participant(given, study.key) : given;
  if (options.is_simulated()) return SimulatedSession(options, study).run();
  return PersonsSession(options, study).run();
}

}  // namespace touchtrial::app
