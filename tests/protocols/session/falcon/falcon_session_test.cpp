// A whole classification session on an emulated Falcon: study, pack, servo thread, driver, the
// unmodified libusb, and the database. Servo ticks and USB exchanges go in lockstep, as fast as the
// processor goes.
#include "analysis/report/report.hpp"
#include "analysis/sealed_sessions.hpp"
#include "device/falcon/rig/dummy_firmware.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/falcon/stepped_falcon.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/store/payload_json.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial::falcon {
namespace {

/// The middle of a plane of 40 mm, 10 mm below the middle of the workspace.
constexpr PlanePlacement kPlacement{PlaneOrientation::horizontal, {-20.0, -10.0, -20.0}};

RealTimeOptions as_fast_as_it_goes() {
  RealTimeOptions options;
  options.scheduling.policy = SchedulingPolicy::other;
  options.scheduling.lock_memory = false;
  options.watchdog_time = &still_time();
  options.clock = [] { return std::make_unique<VirtualClock>(); };
  return options;
}

SubjectModel quick_subject() {
  SubjectModel subject;
  subject.explore_s = 1.2;
  subject.training_passes = 4;
  return subject;
}

/// The study of 5 textures on 40 mm, each presented five times, and everything to run it.
struct Laboratory {
  Laboratory() {
    settings.firmware = write_dummy_firmware(folder.path());
    REQUIRE(source.plane().width_mm() == Approx(40.0));
  }

  /// The cable is pulled in this presentation, once the hand pushes.
  void pull_in_presentation(int number) { pull_in_ = number; }

  DeviceStation::Open opener() {
    return [this]() -> std::unique_ptr<HapticDevice> {
      device = nullptr;
      auto opened = std::make_unique<SteppedFalcon>(settings, [this] { pull_if_due(); });
      device = opened.get();
      return opened;
    };
  }

  SessionTally run() {
    while (station.make_ready() != SupplyState::ready) {
    }
    const std::unique_ptr<EventSink> sink = store.begin_session(
        1, wrap_participant_key(study.key().master, 1, participant_key), [] { return kUtc; });
    const Schedule schedule = make_schedule(study.key().study, 1);
    Session session(schedule, study.key().study.trials, SessionRecorder(1, participant_key, *sink));
    SessionOpening opening;
    opening.participant = "P001";
    opening.enrolment = 1;
    opening.study_id = study.key().study_id;
    opening.seal = study_seal(study.key());
    describe_station(opening, station.info(), explorer.scheduling(), kServoRateHz, "");
    session.open({}, opening, schedule_to_json(schedule, study.key()));
    return run_session(session,
                       {study.key(), source, person, clock, explorer, station, kServoRateHz});
  }

  [[nodiscard]] std::vector<Event> all(EventKind kind) const {
    std::vector<Event> found;
    store.for_each(kind, [&](const Event& event) { found.push_back(event); });
    return found;
  }

  static constexpr std::chrono::nanoseconds kUtc = std::chrono::seconds(1'700'000'000);

  TinyStudy study{{.side_px = 200, .trials = R"({"repeats": 5, "explore_limit_s": 20})"}};
  StimulusSource source{study.pack(), study.key().study.rendering};
  StudyStore store = StudyStore::create(
      study.next_database(), commitment_of(study.key(), study.pack(), false, false), kUtc);
  SecretKey participant_key = sha256(bytes_of("somebody"));
  TempFolder folder;
  FalconSettings settings;
  EmulatedFalcon falcon{kPlacement};
  SteppedFalcon* device = nullptr;
  Experimenter experimenter{falcon, device};
  DeviceStation station{opener(), kPlacement, experimenter};
  SubjectModel subject = quick_subject();
  FeltKnowledge knowledge =
      learn_by_feeling(LabelledFields(study.key(), source), subject, 3.3, 5, 1);
  SimulatedParticipant mind{subject, knowledge, 5, 1};
  PersonAtFalcon person{mind, falcon, station};
  VirtualSessionClock clock;
  RealTimeExplorer explorer{as_fast_as_it_goes()};

 private:
  void pull_if_due() {
    if (person.begun != pull_in_ || norm(falcon.emulator.force_n()) < 0.5) return;
    pull_in_ = 0;
    falcon.unplug();
  }

  std::atomic<int> pull_in_{0};
};

void check_answers(const Laboratory& lab) {
  std::vector<int> stored;
  for (const Event& event : lab.all(EventKind::answered)) {
    stored.push_back(answer_from_json(event.body).position);
  }
  CHECK(stored == lab.person.named);
  CHECK(stored.size() == 25);
}

void check_closed_study(Laboratory& lab) {
  CHECK_FALSE(lab.store.first_fault());
  lab.store.close_study(Laboratory::kUtc);
  lab.store.unblind(Laboratory::kUtc, "planned", false);
  const Outcomes outcomes = load_outcomes(lab.store, lab.study.key());
  const StudyReport report = make_report(outcomes);
  CHECK(report.trials == 25);
  CHECK(report.participants == 1);
  // Chance is 5: the textures came through driver, USB and device.
  CHECK(report.methods.at(0).overall.correct >= 15);
}

TEST_CASE("a whole session on the emulated Falcon loses no response, though it is unplugged once") {
  Laboratory lab;
  constexpr int kUnlucky = 7;
  lab.pull_in_presentation(kUnlucky);
  const SessionTally tally = lab.run();
  CHECK(tally.presentations == 26);
  check_answers(lab);

  // The trial is marked and comes again at the end, under its number.
  const std::vector<Event> interrupted = lab.all(EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const TrialBody body = trial_from_json(interrupted[0].body);
  CHECK(body.trial == kUnlucky);
  CHECK(body.reason == "device lost");
  CHECK(trial_from_json(lab.all(EventKind::presented).back().body).trial == kUnlucky);
  CHECK(lab.all(EventKind::paused).size() == 1);

  // The fault and the seconds before it, for who has the key.
  const InterruptionDetail detail =
      interruption_from_json(opened_part(interrupted[0], lab.participant_key));
  CHECK(detail.device_fault == "link_lost");
  CHECK(detail.ticks > 100);
  CHECK(std::ranges::count(detail.flight, '\n') == detail.ticks + 1);

  // No force without consent; none is left.
  CHECK(lab.experimenter.strongest_n == 0.0);
  CHECK(lab.experimenter.consents == 2);
  CHECK(norm(lab.falcon.emulator.force_n()) == 0.0);
  CHECK(lab.falcon.emulator.complaints().empty());
  CHECK(lab.falcon.emulator.loads() == 1);  // since its power came back

  for (const Event& event : lab.all(EventKind::trace_stored)) {
    const TraceBody trace = trace_body_from_json(event.body);
    REQUIRE(trace.servo);
    CHECK(trace.servo->lost == 0);
    CHECK(trace.overruns == 0);
  }
  check_closed_study(lab);
}

}  // namespace
}  // namespace touchtrial::falcon
