// A whole classification session on the emulated Inverse service: study, pack, servo thread,
// driver, sockets, the service in a process of its own with a hand on its device, and the database.
// A tick of the servo is one exchange, as fast as the processor goes.
#include "analysis/sealed_sessions.hpp"
#include "device/inverse3/haply_service.hpp"
#include "device/inverse3/stepped_inverse3.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/store/payload_json.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using testing::HaplyService;
using testing::SteppedInverse3;

/// The middle of a plane of 40 mm, 10 mm below the middle of the workspace, where the emulated hand
/// looks for it.
constexpr device::PlanePlacement kPlacement{device::PlaneOrientation::horizontal,
                                            {-20.0, -10.0, -20.0}};

double force_on(HaplyService& service) {
  const nlohmann::json force = service.report().at("force");
  return norm(Vec3{force.at(0), force.at(1), force.at(2)});
}

/// Starts the service when it is gone, and consents to force.
class HelperAtService final : public session::Attendant {
 public:
  explicit HelperAtService(HaplyService& service) : service_(service) {}

  [[nodiscard]] Says attend(const std::string& need) override {
    if (!service_.runs()) {
      needs.push_back(need);
      if (needs.size() > 1) service_.start_again();
      return Says::wait;
    }
    strongest_n = std::max(strongest_n, force_on(service_));
    if (!need.empty()) return Says::wait;
    ++consents;
    return Says::arm;
  }

  std::vector<std::string> needs;
  int consents = 0;
  double strongest_n = 0.0;  ///< before consent to force

 private:
  HaplyService& service_;
};

/// A participant who knows the textures, and feels them through the hand on the service's device.
class PersonAtService final : public simulation::PromptParticipant {
 public:
  PersonAtService(simulation::SimulatedParticipant& mind, HaplyService& service,
                  session::DeviceStation& station)
      : mind_(mind), service_(service), station_(station) {}

  void see_pictures(const std::vector<std::string>& labels) override { mind_.see_pictures(labels); }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    // The mind's own hand stays away from the plane.
    static_cast<void>(mind_.begin_exploring(plane));
    contact_ = 0;
    lifted_ = false;
    ++begun;
    service_.tell("explore");
    return station_.device();
  }
  void exploring(device::ServoControl& servo) override {
    if (lifted_) servo.finish();
  }
  void feel(const device::ServoSample& sample) noexcept override {
    mind_.feel(sample);
    if (sample.force_n.z > 0.1) ++contact_;
    if (contact_ > 500 && sample.position_mm.z > 3.0) lifted_ = true;
  }
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    const simulation::ParticipantAnswer answer = mind_.answer();
    named.push_back(answer.position);
    return answer;
  }

  std::vector<int> named;     ///< every choice, in order
  std::atomic<int> begun{0};  ///< explorations

 private:
  simulation::SimulatedParticipant& mind_;
  HaplyService& service_;
  session::DeviceStation& station_;
  int contact_ = 0;  ///< samples
  std::atomic<bool> lifted_{false};
};

simulation::SubjectModel subject_at_service() {
  simulation::SubjectModel subject;
  subject.explore_s = 1.5;
  subject.training_passes = 4;
  return subject;
}

struct LaboratoryWithService {
  session::DeviceStation::Open opener() {
    return [this] {
      return std::make_unique<SteppedInverse3>(service.settings(), [this] { end_if_due(); });
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
  /// In this presentation the service ends while the hand pushes.
  static constexpr int kUnlucky = 4;
  static constexpr int kReadsBeforeTheEnd = 600;

  TinyStudy study{{.side_px = 200, .trials = R"({"repeats": 2, "explore_limit_s": 20})"}};
  session::StimulusSource source{study.pack(), study.key().study.rendering};
  store::StudyStore store = store::StudyStore::create(
      study.next_database(), session::commitment_of(study.key(), study.pack(), false, false), kUtc,
      study.key().signer());
  SecretKey participant_key = sha256(bytes_of("somebody"));
  HaplyService service;
  HelperAtService helper{service};
  session::DeviceStation station{opener(), kPlacement, helper};
  simulation::SubjectModel subject = subject_at_service();
  simulation::FeltKnowledge knowledge = simulation::learn_by_feeling(
      simulation::LabelledFields(study.key(), source), subject, 3.3, 5, 1);
  simulation::identification::IdentifyingParticipant mind{subject, knowledge, 5, 1};
  PersonAtService person{mind, service, station};
  session::VirtualSessionClock clock;
  session::RealTimeExplorer explorer{as_fast_as_it_goes()};

 private:
  void end_if_due() {
    if (person.begun == kUnlucky && ++reads_ == kReadsBeforeTheEnd) service.kill();
  }

  int reads_ = 0;
};

}  // namespace

TEST_CASE("a whole session on the emulated Inverse3 outlives the end of Haply's service") {
  LaboratoryWithService lab;
  const session::SessionTally tally = lab.run();
  CHECK(tally.presentations == 11);
  std::vector<int> stored;
  for (const store::Event& event : lab.all(store::EventKind::answered)) {
    const store::Event answer = as_recorded(event, lab.participant_key);
    stored.push_back(store::answer_from_json(answer.body).position.value());
  }
  CHECK(stored == lab.person.named);
  CHECK(stored.size() == 10);

  const std::vector<store::Event> interrupted = lab.all(store::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const store::TrialBody body = store::trial_from_json(interrupted[0].body);
  CHECK(body.trial == LaboratoryWithService::kUnlucky);
  CHECK(body.reason == "device lost");
  CHECK(store::trial_from_json(lab.all(store::EventKind::presented).back().body).trial ==
        LaboratoryWithService::kUnlucky);
  const store::InterruptionDetail detail = store::interruption_from_json(
      analysis::whole_event(interrupted[0], lab.participant_key).secret);
  CHECK(detail.device_fault == "link_lost");
  CHECK(detail.ticks == LaboratoryWithService::kReadsBeforeTheEnd);
  // The force that the service said it delivered lies beside the commanded one.
  const std::string row =
      detail.flight.substr(detail.flight.rfind("\r\n", detail.flight.size() - 3));
  CHECK(row.find(",,") == std::string::npos);

  // The helper was told what to do; there was no force without consent, and none is left.
  REQUIRE_FALSE(lab.helper.needs.empty());
  CHECK(lab.helper.needs.front().find("start Haply's Inverse service") != std::string::npos);
  CHECK(lab.helper.consents == 2);
  CHECK(lab.helper.strongest_n == 0.0);
  CHECK(force_on(lab.service) == 0.0);
  CHECK(lab.service.report().at("complaints") == nlohmann::json::array());

  const store::SessionOpening opening = store::opening_from_json(
      as_recorded(lab.all(store::EventKind::opened).front(), lab.participant_key).body);
  REQUIRE(opening.station);
  CHECK(opening.device_serial == "049D");
  CHECK(opening.station->firmware.find("force gate 0, damping 0") != std::string::npos);

  lab.store.close_study(LaboratoryWithService::kUtc);
  lab.store.unblind(LaboratoryWithService::kUtc, "planned", false);
  const analysis::identification::StudyReport report =
      analysis::identification::make_report(analysis::load_outcomes(lab.store, lab.study.key()));
  CHECK(report.trials == 10);
  // Chance is 2: the textures came through driver, sockets and service.
  CHECK(report.methods.at(0).overall.correct >= 6);
}

}  // namespace touchtrial
