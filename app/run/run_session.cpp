#include "app/run/run_session.hpp"

#include "app/experimenter/console_experimenter.hpp"
#include "app/experimenter/terminal_experimenter.hpp"
#include "app/experimenter/typing.hpp"
#include "app/participant/participant_window.hpp"
#include "app/participant/window_subject.hpp"
#include "app/run/run_study.hpp"
#include "app/run/session_bounds.hpp"
#include "app/run/session_device.hpp"
#include "app/sound/session_sound.hpp"
#include "app/study_inputs.hpp"
#include "app/texts/study_texts.hpp"
#include "core/errors.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "engine/image_file.hpp"
#include "protocols/design/practice.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_clock.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/session_stages.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/store/session_lock.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

/// The first image of every class by its label, including the classes of practice.
std::map<std::string, GreyImage> answer_pictures(const design::Study& study) {
  std::map<std::string, GreyImage> pictures;
  const auto add = [&](const std::vector<design::StudyClass>& classes) {
    for (const design::StudyClass& shown : classes) {
      pictures.emplace(shown.label, engine::read_grey_image(study.folder / shown.images.front()));
    }
  };
  add(study.classes);
  add(study.practice.classes);
  return pictures;
}

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

/// The practice textures of one participant.
class ParticipantPractice {
 public:
  /// \throws StudyError as PracticeSet
  ParticipantPractice(const RunStudy& study, const PlaneGeometry& plane,
                      const design::ScheduleDraw& draw)
      : study_(study.key.study), draw_(draw) {
    if (study_.trials.practice == 0 || study_.practice.classes.empty()) return;
    set_.emplace(study_, design::weakest_gains(study.pack.manifest()), plane);
    textures_ =
        session::PracticeTextures{set_->plane(), [this](int number) { return round(number); }};
  }

  /// \return null if the study has no practice; valid as long as this object
  [[nodiscard]] const session::PracticeTextures* textures() const noexcept {
    return textures_ ? &*textures_ : nullptr;
  }

 private:
  [[nodiscard]] session::PracticeRound round(int number) const {
    const std::vector<int> layout = design::practice_layout(study_, draw_, number);
    session::PracticeRound round;
    for (const int class_index : layout) {
      round.labels.push_back(study_.practice.classes[static_cast<std::size_t>(class_index)].label);
      round.models.push_back(&set_->model(class_index));
    }
    for (const int class_index : design::practice_round(study_, draw_, number)) {
      const auto place = std::ranges::find(layout, class_index);
      round.order.push_back(static_cast<int>(place - layout.begin()));
    }
    return round;
  }

  const design::Study& study_;
  design::ScheduleDraw draw_;
  std::optional<design::PracticeSet> set_;
  std::optional<session::PracticeTextures> textures_;
};

/// A visual device makes no sound that would need masking.
design::MaskingPlan masking_of(const RunOptions& options, const design::Study& study,
                               const device::DeviceInfo& device) {
  design::MaskingPlan plan = study.session.masking;
  plan.wanted = plan.wanted && options.sound && !device.visual;
  return plan;
}

/// Deviations from the study that exist before the session begins.
std::vector<session::ExperimenterRequest> known_deviations(const RunOptions& options,
                                                           const RunStudy& study,
                                                           const SessionDevice& device) {
  std::vector<session::ExperimenterRequest> known = device.to_record();
  if (study.key_in_reach) {
    known.push_back({session::ExperimenterRequest::Kind::deviation,
                     "the investigator's key lies beside the study", "key-at-station"});
  }
  if (study.key.study.session.masking.wanted && !options.sound && !device.info().visual) {
    known.push_back(
        {session::ExperimenterRequest::Kind::deviation, "--no-sound", "no-masking-noise"});
  }
  return known;
}

/// A visual device needs no warm-up, no curtain and no headphones.
session::SessionTexts texts_for(const design::Study& study, const device::DeviceInfo& device) {
  session::SessionTexts texts = session_texts(study);
  if (device.visual) texts.day_sheet.clear();
  return texts;
}

/// The experimenter must be able to consent to the force.
void require_consent(const device::DeviceInfo& device) {
  if (device.visual || ::isatty(STDIN_FILENO) != 0) return;
  throw UsageError(
      "run: standard input is not a terminal, where the experimenter lets the force on; start it "
      "from a terminal");
}

/// A person's session with a device, before a window.
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
    for (const session::ExperimenterRequest& known : known_deviations(options, study, device_)) {
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
    const ParticipantPractice practice(study_, source_.plane(), entered.draw);
    SpokenAnswers spoken(window, terminal_);
    RunExperimenter experimenter(
        console_, [&] { return why_gone(window); }, [this] { return sound_.to_record(); });
    const session::SessionTexts texts = texts_for(study_.key.study, device_.info());
    const session::SessionTally tally =
        session::run_session(*entered.session, {.key = study_.key,
                                                .source = source_,
                                                .participant = spoken,
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
  store::StudyStore store_;  ///< after the device, so that none is made without a device
  SessionSound sound_;
};

/// Time in a simulated participant's session is virtual unless the options ask for real time.
std::unique_ptr<session::Explorer> explorer_for(const RunOptions& options) {
  if (options.real_time) return std::make_unique<session::RealTimeExplorer>();
  return std::make_unique<session::VirtualExplorer>();
}

std::unique_ptr<session::SessionClock> clock_for(const session::Explorer& explorer,
                                                 std::chrono::nanoseconds start) {
  if (explorer.in_real_time()) return std::make_unique<session::SteadySessionClock>(start);
  return std::make_unique<session::VirtualSessionClock>(start);
}

/// Fills in what the session's first event says about the simulated device.
void describe_simulated(const session::Explorer& explorer, store::SessionOpening& opening) {
  opening.device = "simulated";
  if (const auto* const real_time = dynamic_cast<const session::RealTimeExplorer*>(&explorer)) {
    const device::DeviceInfo device{"simulated", "", device::HandOptions{}.max_force_n, true};
    session::describe_station(opening, device, real_time->scheduling(), device::kServoRateHz, "");
  }
  opening.simulated = true;
}

/// A simulated participant's session.
class SimulatedSession {
 public:
  /// Teaches the subject the study's classes, which takes about half a second.
  /// \throws as subject_for
  SimulatedSession(const RunOptions& options, const RunStudy& study)
      : options_(options),
        study_(study),
        store_(run_database_for(options, study)),
        source_(study.pack, study.key.study.rendering),
        subject_(subject_for(*options.subject, study.key.study)),
        population_(simulation::population_of(
            {study.key, source_, subject_, options.seed,
             static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))})) {}

  int run() {
    if (options_.headless) return run_before(nullptr);
    ParticipantWindow window(window_options(options_, study_.key.study));
    int code = 1;
    run_beside(window, [&] { code = run_before(&window); });
    return code;
  }

 private:
  /// \param window  null: the participant answers directly
  int run_before(ParticipantWindow* window) {
    const std::unique_ptr<session::Explorer> explorer = explorer_for(options_);
    const EnteredSession entered = enter_session(
        options_, study_, store_,
        [&](store::SessionOpening& opening) { describe_simulated(*explorer, opening); });
    const std::unique_ptr<session::SessionClock> clock = clock_for(*explorer, entered.clock);
    const std::unique_ptr<simulation::SimulatedParticipant> mind =
        population_->participant(entered.enrolment);
    std::optional<WindowSubject> before_window;
    if (window != nullptr) before_window.emplace(*window, *mind, options_.real_time);
    session::AlwaysReady devices;
    RunExperimenter experimenter(session::no_experimenter(), [&] {
      return window != nullptr ? why_gone(*window) : std::string();
    });
    const session::SessionTexts texts = session_texts(study_.key.study);
    const session::SessionTally tally = session::run_session(
        *entered.session,
        {.key = study_.key,
         .source = source_,
         .participant = before_window ? static_cast<session::Participant&>(*before_window) : *mind,
         .clock = *clock,
         .explorer = *explorer,
         .devices = devices,
         .experimenter = experimenter,
         .texts = texts,
         .participant_name = options_.participant,
         .device_name = "simulated"});
    return conclude_session(options_, entered.number, tally, store_);
  }

  const RunOptions& options_;
  const RunStudy& study_;
  store::StudyStore store_;
  session::StimulusSource source_;
  simulation::SubjectModel subject_;
  std::unique_ptr<const simulation::Population> population_;
};

}  // namespace

int run_study_session(const RunOptions& options) {
  const EndingSignals signals;
  const RunStudy study = run_study_for(options);
  const store::SessionLock lock(options.database, options.participant);
  if (options.is_simulated()) return SimulatedSession(options, study).run();
  return PersonsSession(options, study).run();
}

}  // namespace touchtrial::app
