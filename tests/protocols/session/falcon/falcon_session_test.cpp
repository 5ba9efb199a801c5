// A whole classification session on an emulated Falcon: study, pack, servo thread, driver, the
// unmodified libusb, the database, and event codes on a line. Servo ticks and USB exchanges go in
// lockstep, as fast as the processor goes.
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/drivers/falcon/usb_falcon.hpp"
#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"
#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"
#include "protocols/session/person_with_hand.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/whole_session.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr Vec3 kRestMm = {0.0, 15.0, 0.0};
/// More than homing takes.
constexpr int kHomingSteps = 1200;

/// A Falcon on the bus, switched on and never loaded, with a hand on its grip.
struct EmulatedFalcon {
  explicit EmulatedFalcon(const device::PlanePlacement& placement) : hand(placement, kRestMm) {
    emulator.set_hand([this](Vec3 force_n) { return hand.tick(force_n); });
  }

  /// Cable and power: firmware and homing are gone afterwards.
  void unplug() {
    plugged = false;
    usb.unplug();
    emulator.unplug();
  }
  void plug() {
    emulator.replug(false);
    usb.plug();
    plugged = true;
  }

  HandOnFalcon hand;
  FalconEmulator emulator;
  testing::EmulatorUsbModel model{emulator};
  testing::ShimmedUsbDevice usb{model};
  std::atomic<bool> plugged{true};
};

std::unique_ptr<FalconDevice> open_in_lockstep(const device::FalconSettings& settings,
                                               Lockstep& lockstep) {
  FalconOptions options{.pace = lockstep.pace(),
                        .scheduling = {device::SchedulingPolicy::other, 0, false}};
  return std::make_unique<FalconDevice>(open_usb_falcon(settings.serial), settings,
                                        std::move(options));
}

/// The driver, and what lets its thread go on.
struct PacedFalcon {
  explicit PacedFalcon(const device::FalconSettings& settings)
      : driver(open_in_lockstep(settings, lockstep)) {}

  Lockstep lockstep;
  std::unique_ptr<FalconDevice> driver;
};

/// The real driver, one exchange through libusb a servo tick.
class SteppedFalcon final : private PacedFalcon, public LockstepDevice {
 public:
  SteppedFalcon(const device::FalconSettings& settings, std::function<void()> before_read)
      : PacedFalcon(settings), LockstepDevice(*driver, lockstep, std::move(before_read)) {}
  void steps(int count) noexcept { lockstep.steps(count); }
};

/// Does what the program asks for: plugs the Falcon in, homes its grip, and consents.
class Experimenter final : public session::Attendant {
 public:
  Experimenter(EmulatedFalcon& falcon, SteppedFalcon*& device) : falcon_(falcon), device_(device) {}

  [[nodiscard]] Reply poll(const std::string& need) override {
    // What the motors of an unplugged Falcon do is unknown, and beyond anyone's reach.
    if (falcon_.plugged) strongest_n = std::max(strongest_n, norm(falcon_.emulator.force_n()));
    if (need.empty()) {
      ++consents;
      return Reply::arm;
    }
    if (!falcon_.plugged) {
      falcon_.plug();
    } else if (device_ != nullptr) {
      falcon_.hand.home();
      device_->steps(kHomingSteps);
    }
    return Reply::wait;
  }

  int consents = 0;
  double strongest_n = 0.0;  ///< before consent to force

 private:
  EmulatedFalcon& falcon_;
  SteppedFalcon*& device_;
};

/// The middle of a plane of 40 mm, 10 mm below the middle of the workspace.
constexpr device::PlanePlacement kPlacement{device::PlaneOrientation::horizontal,
                                            {-20.0, -10.0, -20.0}};

/// The study of 5 textures on 40 mm, each presented five times, and everything to run it.
struct Laboratory {
  Laboratory() {
    settings.firmware = write_dummy_firmware(folder.path());
    REQUIRE(whole.source.plane().width_mm() == Approx(40.0));
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

  WholeSession whole{5, 1.2};
  TempFolder folder;
  device::FalconSettings settings;
  EmulatedFalcon falcon{kPlacement};
  SteppedFalcon* device = nullptr;
  Experimenter experimenter{falcon, device};
  session::DeviceStation station{opener(), kPlacement, experimenter};
  PersonWithHand person{whole.mind, falcon.hand, station};
  session::RealTimeExplorer explorer{as_fast_as_it_goes()};

 private:
  void pull_if_due() {
    if (person.begun != pull_in_ || norm(falcon.emulator.force_n()) < 0.5) return;
    pull_in_ = 0;
    falcon.unplug();
  }

  std::atomic<int> pull_in_{0};
};

TEST_CASE("a whole session on the emulated Falcon loses no response, though it is unplugged once") {
  Laboratory lab;
  constexpr int kUnlucky = 7;
  lab.pull_in_presentation(kUnlucky);
  const session::SessionTally tally = lab.whole.run(lab.station, lab.person, lab.explorer);
  CHECK(tally.presentations == 26);
  CHECK(lab.person.named.size() == 25);
  // The seconds before the fault, which only the key's holder can read.
  const record::InterruptionDetail detail = lab.whole.check(lab.person.named, kUnlucky);
  CHECK(detail.ticks > 100);
  CHECK(std::ranges::count(detail.flight, '\n') == detail.ticks + 1);

  // There was no force without consent, and none is left.
  CHECK(lab.experimenter.strongest_n == 0.0);
  CHECK(lab.experimenter.consents == 2);
  CHECK(norm(lab.falcon.emulator.force_n()) == 0.0);
  CHECK(lab.falcon.emulator.complaints().empty());
  CHECK(lab.falcon.emulator.loads() == 1);  // since its power came back

  for (const record::Event& event : lab.whole.all(record::EventKind::trace_stored)) {
    const record::TraceBody trace = record::from_json<record::TraceBody>(event.body);
    REQUIRE(trace.servo);
    CHECK(trace.servo->lost == 0);
    CHECK(trace.overruns == 0);
  }

  const analysis::identification::StudyReport report = lab.whole.report();
  CHECK(report.trials == 25);
  CHECK(report.participants == 1);
  // Chance is 5: the textures came through driver, USB and device.
  CHECK(report.methods.at(0).overall.correct >= 15);
}

/// Pauses once while the third plane pushes, as the program does when the participant's keys no
/// longer reach it, and goes on at once.
class Pausing final : public session::Experimenter {
 public:
  explicit Pausing(Laboratory& lab) : lab_(lab) {}

  void show(const session::SessionStatus& status) override {
    if (status.stage != "paused") return;
    lab_.device->steps(2);  // the last force is on its way
    force_n.push_back(norm(lab_.falcon.emulator.force_n()));
    resumes_ = true;
  }
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override {
    using Kind = session::ExperimenterRequest::Kind;
    if (std::exchange(resumes_, false)) return session::ExperimenterRequest{Kind::resume, "", ""};
    if (lab_.person.begun != 3 || norm(lab_.falcon.emulator.force_n()) < 0.3) return std::nullopt;
    if (std::exchange(has_paused_, true)) return std::nullopt;
    return session::ExperimenterRequest{Kind::pause, "the keyboard was lost", ""};
  }

  std::vector<double> force_n;  ///< in the pause

 private:
  Laboratory& lab_;
  bool has_paused_ = false;
  bool resumes_ = false;
};

TEST_CASE("a pause on the emulated Falcon leaves no force, and its trial is repeated") {
  Laboratory lab;
  Pausing experimenter(lab);
  const session::SessionTally tally =
      lab.whole.run(lab.station, lab.person, lab.explorer, experimenter);
  CHECK(tally.presentations == 26);
  CHECK(lab.person.named.size() == 25);
  REQUIRE(!experimenter.force_n.empty());
  CHECK(std::ranges::max(experimenter.force_n) == 0.0);
  const std::vector<record::Event> interrupted = lab.whole.all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const auto body = record::from_json<record::InterruptedBody>(interrupted.front().body);
  CHECK(body.reason == record::kPauseReason);
  CHECK(lab.whole.all(record::EventKind::answered).size() == 25);
  // The trial that was paused is the next one.
  const std::vector<record::Event> presented = lab.whole.all(record::EventKind::presented);
  CHECK(record::from_json<record::TrialBody>(presented.at(2).body).trial == body.trial);
  CHECK(record::from_json<record::TrialBody>(presented.at(3).body).trial == body.trial);
  CHECK(lab.experimenter.consents == 1);
  CHECK(lab.falcon.emulator.complaints().empty());
}

}  // namespace
}  // namespace touchtrial::device::falcon
