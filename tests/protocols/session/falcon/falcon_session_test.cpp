// A whole classification session on an emulated Falcon: study, pack, servo thread, driver, the
// unmodified libusb, and the database. Servo ticks and USB exchanges go in lockstep, as fast as the
// processor goes.
#include "analysis/sealed_sessions.hpp"
#include "device/falcon/rig/falcon_rig.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/falcon/stepped_falcon.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/store/payload_json.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {
namespace {

/// The middle of a plane of 40 mm, 10 mm below the middle of the workspace.
constexpr device::PlanePlacement kPlacement{device::PlaneOrientation::horizontal,
                                            {-20.0, -10.0, -20.0}};

simulation::SubjectModel quick_subject() {
  simulation::SubjectModel subject;
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

  session::DeviceStation::Open opener() {
    return [this]() -> std::unique_ptr<device::HapticDevice> {
      device = nullptr;
      auto opened = std::make_unique<SteppedFalcon>(settings, [this] { pull_if_due(); });
      device = opened.get();
      return opened;
    };
  }

  session::SessionTally run() {
    while (station.make_ready() != session::SupplyState::ready) {
    }
    const std::unique_ptr<store::EventSink> sink = store.begin_session(
        1, store::wrap_participant_key(study.key().investigator_box, 1, participant_key),
        [] { return kUtc; });
    const design::Schedule schedule =
        design::make_schedule(study.key().study, study.key().draw_of(1, design::Draws::rehearsal));
    session::Session session(schedule, study.key().study.trials,
                             store::SessionRecorder(1, participant_key, *sink));
    store::SessionOpening opening;
    opening.participant = "P001";
    opening.enrolment = 1;
    opening.study_id = study.key().study_id;
    opening.seal = design::study_seal(study.key());
    session::describe_station(opening, station.info(), explorer.scheduling(), device::kServoRateHz,
                              "");
    session.open({}, opening, design::schedule_to_json(schedule, study.key()));
    return session::run_session(
        session, {study.key(), source, person, clock, explorer, station, device::kServoRateHz});
  }

  [[nodiscard]] std::vector<store::Event> all(store::EventKind kind) const {
    std::vector<store::Event> found;
    store.for_each(kind, [&](const store::Event& event) { found.push_back(event); });
    return found;
  }

  static constexpr std::chrono::nanoseconds kUtc = std::chrono::seconds(1'700'000'000);

  TinyStudy study{{.side_px = 200, .trials = R"({"repeats": 5, "explore_limit_s": 20})"}};
  session::StimulusSource source{study.pack(), study.key().study.rendering};
  store::StudyStore store = store::StudyStore::create(
      study.next_database(), session::commitment_of(study.key(), study.pack(), false, false), kUtc,
      study.key().signer());
  SecretKey participant_key = sha256(bytes_of("somebody"));
  TempFolder folder;
  device::FalconSettings settings;
  EmulatedFalcon falcon{kPlacement};
  SteppedFalcon* device = nullptr;
  Experimenter experimenter{falcon, device};
  session::DeviceStation station{opener(), kPlacement, experimenter};
  simulation::SubjectModel subject = quick_subject();
  simulation::FeltKnowledge knowledge = simulation::learn_by_feeling(
      simulation::LabelledFields(study.key(), source), subject, 3.3, 5, 1);
  simulation::identification::IdentifyingParticipant mind{subject, knowledge, 5, 1};
  PersonAtFalcon person{mind, falcon, station};
  session::VirtualSessionClock clock;
  session::RealTimeExplorer explorer{as_fast_as_it_goes()};

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
  for (const store::Event& event : lab.all(store::EventKind::answered)) {
    const store::Event answer = as_recorded(event, lab.participant_key);
    stored.push_back(store::answer_from_json(answer.body).position.value());
  }
  CHECK(stored == lab.person.named);
  CHECK(stored.size() == 25);
}

void check_closed_study(Laboratory& lab) {
  CHECK_FALSE(lab.store.first_fault());
  lab.store.close_study(Laboratory::kUtc);
  lab.store.unblind(Laboratory::kUtc, "planned", false);
  const analysis::Outcomes outcomes = analysis::load_outcomes(lab.store, lab.study.key());
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(outcomes);
  CHECK(report.trials == 25);
  CHECK(report.participants == 1);
  // Chance is 5: the textures came through driver, USB and device.
  CHECK(report.methods.at(0).overall.correct >= 15);
}

TEST_CASE("a whole session on the emulated Falcon loses no response, though it is unplugged once") {
  Laboratory lab;
  constexpr int kUnlucky = 7;
  lab.pull_in_presentation(kUnlucky);
  const session::SessionTally tally = lab.run();
  CHECK(tally.presentations == 26);
  check_answers(lab);

  // The trial is marked, and is repeated at the end under its number.
  const std::vector<store::Event> interrupted = lab.all(store::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const store::TrialBody body = store::trial_from_json(interrupted[0].body);
  CHECK(body.trial == kUnlucky);
  CHECK(body.reason == "device lost");
  CHECK(store::trial_from_json(lab.all(store::EventKind::presented).back().body).trial == kUnlucky);
  CHECK(lab.all(store::EventKind::paused).size() == 1);

  // The fault and the seconds before it, which only the key's holder can read.
  const store::InterruptionDetail detail = store::interruption_from_json(
      analysis::whole_event(interrupted[0], lab.participant_key).secret);
  CHECK(detail.device_fault == "link_lost");
  CHECK(detail.ticks > 100);
  CHECK(std::ranges::count(detail.flight, '\n') == detail.ticks + 1);

  // There was no force without consent, and none is left.
  CHECK(lab.experimenter.strongest_n == 0.0);
  CHECK(lab.experimenter.consents == 2);
  CHECK(norm(lab.falcon.emulator.force_n()) == 0.0);
  CHECK(lab.falcon.emulator.complaints().empty());
  CHECK(lab.falcon.emulator.loads() == 1);  // since its power came back

  for (const store::Event& event : lab.all(store::EventKind::trace_stored)) {
    const store::TraceBody trace = store::trace_body_from_json(event.body);
    REQUIRE(trace.servo);
    CHECK(trace.servo->lost == 0);
    CHECK(trace.overruns == 0);
  }
  check_closed_study(lab);
}

}  // namespace
}  // namespace touchtrial::device::falcon
