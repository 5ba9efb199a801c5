// A whole classification session on the emulated Inverse service: study, pack, servo thread,
// driver, sockets, the service in a process of its own with a hand on its device, the database, and
// event codes on a line. A tick of the servo is one exchange, as fast as the processor goes.
#include "device/drivers/inverse3/haply_service.hpp"
#include "device/drivers/inverse3/stepped_inverse3.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/whole_session.hpp"
#include "record/payload_json.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>

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

  [[nodiscard]] Reply poll(const std::string& need) override {
    if (!service_.runs()) {
      needs.push_back(need);
      if (needs.size() > 1) service_.start_again();
      return Reply::wait;
    }
    strongest_n = std::max(strongest_n, force_on(service_));
    if (!need.empty()) return Reply::wait;
    ++consents;
    return Reply::arm;
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
    service_.send_command("explore");
    return station_.device();
  }
  void while_exploring(device::ServoControl& servo) override {
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

struct LaboratoryWithService {
  session::DeviceStation::Open opener() {
    return [this] {
      return std::make_unique<SteppedInverse3>(service.settings(), [this] { end_if_due(); });
    };
  }

  /// In this presentation the service ends while the hand pushes.
  static constexpr int kUnlucky = 4;
  static constexpr int kReadsBeforeTheEnd = 600;

  WholeSession whole{2, 1.5};
  HaplyService service;
  HelperAtService helper{service};
  session::DeviceStation station{opener(), kPlacement, helper};
  PersonAtService person{whole.mind, service, station};
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
  const session::SessionTally tally = lab.whole.run(lab.station, lab.person, lab.explorer);
  CHECK(tally.presentations == 11);
  CHECK(lab.person.named.size() == 10);
  const record::InterruptionDetail detail =
      lab.whole.check(lab.person.named, LaboratoryWithService::kUnlucky);
  CHECK(detail.ticks == LaboratoryWithService::kReadsBeforeTheEnd);
  // The force that the service said it delivered lies beside the commanded one.
  const std::string row =
      detail.flight.substr(detail.flight.rfind("\r\n", detail.flight.size() - 3));
  CHECK(row.find(",,") == std::string::npos);

  // The helper was told what to do; there was no force without consent, and none is left.
  REQUIRE_FALSE(lab.helper.needs.empty());
  CHECK_THAT(lab.helper.needs.front(), names("Haply"));
  CHECK(lab.helper.consents == 2);
  CHECK(lab.helper.strongest_n == 0.0);
  CHECK(force_on(lab.service) == 0.0);
  CHECK(lab.service.report().at("complaints") == nlohmann::json::array());

  const record::SessionOpening opening = record::from_json<record::SessionOpening>(
      as_recorded(lab.whole.all(record::EventKind::opened).front(), lab.whole.participant_key)
          .body);
  REQUIRE(opening.station);
  CHECK(opening.device_serial == "049D");
  CHECK(opening.station->firmware.find("force gate 0, damping 0") != std::string::npos);

  const analysis::identification::StudyReport report = lab.whole.report();
  CHECK(report.trials == 10);
  // Chance is 2: the textures came through driver, sockets and service.
  CHECK(report.methods.at(0).overall.correct >= 6);
}

}  // namespace touchtrial
