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
    for (const study::StudyClass& texture : classes) {
      pictures.emplace(texture.label,
                       engine::read_grey_image(study.folder / texture.images.front()));
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
  window.trial_question = study::trial_question_of(study);
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

/// Called while another program locks the database: shows why the session waits.
/// \return whether to continue waiting
bool show_wait_reason(const std::string& reason, const std::function<void()>& show) {
  spdlog::warn("{}; the session waits", reason);
  show();
  return EndingSignals::signal_number() == 0;
}

/// The record of a wait for a locked database.
std::optional<session::ExperimenterRequest> wait_entry(PatientSink& sink) {
  const auto wait_time = sink.take_delay();
  if (!wait_time) return std::nullopt;
  const double seconds = std::chrono::duration<double>(*wait_time).count();
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
    const std::chrono::milliseconds unfocused = window_.time_without_focus();
    if (window_.take_focus_loss() && !std::exchange(is_recorded_, true)) {
      return session::ExperimenterRequest{Kind::deviation, kFocusLost, "focus-lost"};
    }
    const bool is_in_trial = window_.is_exploring() || window_.is_answering();
    if (unfocused >= kFocusTimeout && is_in_trial && !std::exchange(has_paused_, true)) {
      return session::ExperimenterRequest{Kind::pause, kFocusLost, ""};
    }
    if (unfocused > std::chrono::milliseconds{}) return std::nullopt;
    is_recorded_ = false;
    if (!std::exchange(has_paused_, false)) return std::nullopt;
    return session::ExperimenterRequest{Kind::resume, "", ""};
  }

  /// SessionStatus::alert.
  [[nodiscard]] std::string alert() const {
    constexpr std::chrono::seconds kAlertDelay{1};
    if (window_.time_without_focus() < kAlertDelay) return "";
    return "another window has the keyboard; click on the participant's window";
  }

 private:
  static constexpr const char* kFocusLost = "another window had the keyboard during a trial";

  ParticipantWindow& window_;
  bool is_recorded_ = false;
  bool has_paused_ = false;
};

/// The masking plan; a visual device makes no sound that would need masking.
study::MaskingPlan masking_of(const study::Study& study, const device::DeviceInfo& device) {
  study::MaskingPlan plan = study.session.masking;
  plan.wanted = plan.wanted && !device.visual;
  return plan;
}

/// Deviations that exist before the session starts, and notes about the participant.
std::vector<session::ExperimenterRequest> initial_entries(const RunOptions& options,
                                                          const RunStudy& study,
                                                          const SessionDevice& device) {
  std::vector<session::ExperimenterRequest> entries = device.record_entries();
  if (!options.remark.empty()) {
    entries.push_back({session::ExperimenterRequest::Kind::note, options.remark, ""});
  }
  if (options.no_consent) {
    spdlog::warn("participant {} has not signed the consent form; this is recorded",
                 options.participant);
    entries.push_back({session::ExperimenterRequest::Kind::deviation,
                       "stated in the dialogue at the start", "no-consent"});
  }
  if (!study.reachable_key.empty()) {
    entries.push_back({session::ExperimenterRequest::Kind::deviation,
                       "the investigator's key is beside the study", "key-at-station"});
  }
  if (study.key.study.session.masking.wanted && !options.sound && !device.info().visual) {
    entries.push_back(
        {session::ExperimenterRequest::Kind::deviation, "--no-sound", "no-masking-noise"});
  }
  return entries;
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
  if (options.text_scale) note("text size: " + number_text(*options.text_scale));
  if (options.high_contrast) note("high contrast");
  return notes;
}

/// The session's texts, without a day sheet for a visual device, which needs no preparation.
session::SessionTexts texts_for(const study::Study& study, const device::DeviceInfo& device) {
  session::SessionTexts texts = session_texts(study);
  if (device.visual) texts.day_sheet.clear();
  return texts;
}

void require_blind(const RunOptions& options, const device::DeviceInfo& device) {
  if (!device.visual || options.pilot) return;
  throw UsageError("run: device '" + device.name +
                   "' shows textures on a screen, so the session is not blind; give --pilot and "
                   "a pilot's database, or choose a haptic device");
}

/// Warns if the screen's size, and thus the true size of pictures, is unknown.
void warn_of_unknown_size(const RunOptions& options, const study::Study& study,
                          const ParticipantWindow& window) {
  if (study.session.sight == study::Sight::blindfold || window.screen().is_known) return;
  const study::TrialQuestion question = study::trial_question_of(study);
  if (!question.has_pictures() && question.scales().empty()) return;
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
class PersonSession {
 public:
  PersonSession(const RunOptions& options, const RunStudy& study)
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
      if (!sound_->failure_reason().empty()) spdlog::warn("{}", sound_->failure_reason());
    }
    for (const session::ExperimenterRequest& entry : initial_entries(options, study, device_)) {
      desk_.add(entry);
    }
    for (const auto& note : notes_on_screens(options, study.key.study)) desk_.add(note);
  }

  int run() {
    ParticipantWindowOptions window_settings = window_options(options_, study_.key.study);
    window_settings.device = [this]() -> device::HapticDevice& { return device_.device(); };
    window_settings.pointer = device_.pointer();
    if (sound_) window_settings.cues = &*sound_;
    if (options_.console) window_settings.console = &desk_;
    if (options_.console_monitor > 0) window_settings.console_monitor = options_.console_monitor;
    ParticipantWindow window(window_settings);
    warn_of_unknown_size(options_, study_.key.study, window);
    screen_ = record_of(window.screen());
    int code = 1;
    run_beside(window, [&] { code = run_with_window(window); });
    return code;
  }

 private:
  int run_with_window(ParticipantWindow& window) {
    session::RealTimeExplorer explorer;
    const EnteredSession entered =
        enter_session(options_, study_, database_, [&](record::SessionOpening& opening) {
          session::describe_station(opening, device_.info(), explorer.scheduling(),
                                    device::kServoRateHz, device_.certificate());
          opening.station->screen = screen_;
        });
    if (!study_.reachable_key.empty()) {
      spdlog::warn(
          "{}: the investigator's key is at this station, which is recorded as a deviation; move "
          "it to another medium",
          study_.reachable_key.string());
    }
    session::SteadySessionClock clock(entered.clock);
    SpokenAnswers spoken_answers(window, desk_);
    DatabaseWatch watch(options_.database);
    FocusWatch focus(window);
    RunExperimenter experimenter(
        desk_,
        [&] {
          const std::string problem = watch.problem();
          return problem.empty() ? window_end_reason(window) : problem;
        },
        [&] { return automatic_request(*entered.sink, focus); }, [&] { return focus.alert(); });
    entered.sink->set_wait_callback([&](const std::string& reason) {
      return show_wait_reason(
          reason, [&] { static_cast<void>(spoken_answers.show_step(session::PauseStep{})); });
    });
    const session::SessionTexts texts = texts_for(study_.key.study, device_.info());
    const session::SessionTally tally = session::run_session(
        *entered.session,
        {.key = study_.key,
         .source = source_,
         .participant = spoken_answers,
         .clock = clock,
         .explorer = explorer,
         .devices = device_.station(),
         .experimenter = experimenter,
         .texts = texts,
         .practice =
             [&](int round) { return study::practice_of(study_.key.study, entered.draw, round); },
         .participant_name = options_.participant,
         .device_name = device_.display_name(),
         .limits = device_.limits(),
         .instruments = instruments_.get()});
    terminal_.end_line();
    return conclude_session(options_, entered.number, tally, database_.open_or_create(),
                            watch.problem());
  }

  /// The program's own requests (database, window, sound), one at a time.
  [[nodiscard]] std::optional<session::ExperimenterRequest> automatic_request(PatientSink& sink,
                                                                              FocusWatch& focus) {
    if (auto request = wait_entry(sink)) return request;
    if (auto request = focus.request()) return request;
    return sound_ ? sound_->next_record_entry() : std::nullopt;
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

/// A simulated participant's time is virtual unless the options request real time.
std::unique_ptr<session::Explorer> explorer_for(const RunOptions& options) {
  if (options.real_time) return std::make_unique<session::RealTimeExplorer>();
  return std::make_unique<session::VirtualExplorer>();
}

/// There are no instruments in virtual time.
std::unique_ptr<session::Instruments> instruments_for(const RunOptions& options) {
  if (!options.real_time) return nullptr;
  return session_instruments(device::load_device_settings(options.settings).instruments,
                             device::kServoRateHz);
}

std::unique_ptr<session::SessionClock> clock_for(const session::Explorer& explorer,
                                                 std::chrono::nanoseconds start) {
  if (explorer.in_real_time()) return std::make_unique<session::SteadySessionClock>(start);
  return std::make_unique<session::VirtualSessionClock>(start);
}

/// Describes the simulated device in the session's first event.
void describe_simulated(const session::Explorer& explorer,
                        const device::DeviceModel& simulated_device,
                        record::SessionOpening& opening) {
  if (const auto* const real_time = dynamic_cast<const session::RealTimeExplorer*>(&explorer)) {
    const device::DeviceInfo device{"simulated", "", device::HandOptions{}.max_force_n, true};
    session::describe_station(opening, device, real_time->scheduling(), device::kServoRateHz, "");
  }
  opening.device = device::simulated_device_name(simulated_device);
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
        subject_(subject_for(*options.subject, study.key.study, options.hand_device)),
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
        session::no_experimenter(), [&] { return watch.problem(); },
        [&] { return wait_entry(*entered.sink); });
    entered.sink->set_wait_callback(
        [](const std::string& reason) { return show_wait_reason(reason, [] {}); });
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
    return conclude_session(options_, entered.number, tally, database_.open_or_create(),
                            watch.problem());
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

int run_study_session(const RunOptions& initial) {
  if (!initial.participant.empty()) {
    confirm_id("run", initial.database, initial.participant, initial.yes);
  }
  const EndingSignals signals;
  RunStudy study = run_study_for(initial);
  confirm_enrolment(initial, study.key);
  const RunOptions options =
      initial.participant.empty() ? with_participant(initial, study.key) : initial;
  if (options.is_simulated()) return SimulatedSession(options, study).run();
  return PersonSession(options, study).run();
}

}  // namespace touchtrial::app
