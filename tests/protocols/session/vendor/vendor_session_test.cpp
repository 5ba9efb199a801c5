// A whole classification session on each stand-in for a vendor's library: study, pack, servo
// thread, the driver with its own thread, the database, and event codes on a line. A tick of the
// servo is a step of the stand-in and of the hand on it.
#include "device/drivers/dhd/dhd_device.hpp"
#include "device/drivers/openhaptics/openhaptics_device.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "protocols/session/person_with_hand.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/whole_session.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace touchtrial {
namespace {

/// The middle of a plane of 40 mm, 10 mm below the middle of the workspace.
constexpr device::PlanePlacement kPlacement{device::PlaneOrientation::horizontal,
                                            {-20.0, -10.0, -20.0}};
constexpr Vec3 kRestMm = {0.0, 15.0, 0.0};

/// Places and forces are in the device frame.
struct DhdOnCable {
  using Exports = fakes::FakeDhdExports;

  [[nodiscard]] static Vec3 to_dhd_frame(Vec3 device) { return {device.z, device.x, device.y}; }
  [[nodiscard]] std::unique_ptr<device::HapticDevice> open() const {
    device::DhdSettings settings{.library = TOUCHTRIAL_FAKE_DHD};
    return std::make_unique<device::DhdDevice>(settings, std::numeric_limits<double>::infinity(),
                                               fake.exports().now);
  }
  void unplug() const {
    fake->connected = false;
    fake->devices = 0;
  }
  void plug() const {
    fake->calibrated = false;
    fake->connected = true;
    fake->devices = 1;
  }
  void calibrate() const { fake->calibrated = true; }
  [[nodiscard]] Vec3 force_n() const {
    const Vec3 dhd = fake->force_n.get();
    return {dhd.y, dhd.z, dhd.x};
  }
  void put(Vec3 position_mm, Vec3 /*velocity_mm_s: the driver takes it from positions*/) const {
    fake->hand.rest_at(to_dhd_frame(position_mm));
  }

  fakes::LoadedDhd fake;
};

struct TouchOnCable {
  using Exports = fakes::FakeHdExports;

  [[nodiscard]] static std::unique_ptr<device::HapticDevice> open() {
    device::OpenHapticsSettings settings{.library = TOUCHTRIAL_FAKE_HD};
    return std::make_unique<device::OpenHapticsDevice>(settings);
  }
  void unplug() const {
    fake->lost = true;
    fake->opens_by = 0;
  }
  void plug() const {
    fake->calibrated = false;
    fake->lost = false;
    fake->opens_by = fakes::kHdNull;
  }
  void calibrate() const { fake->in_inkwell = true; }
  [[nodiscard]] Vec3 force_n() const { return fake->force_n.get(); }
  void put(Vec3 position_mm, Vec3 velocity_mm_s) const {
    fake->hand.rest_at(position_mm);
    fake->hand.velocity.set(velocity_mm_s);
  }

  fakes::LoadedHd fake;
};

/// Servo time of a stand-in, which calls back after each of its steps.
template <typename Exports>
class HandledSteps final : public device::ServoClock {
 public:
  HandledSteps(const Exports& fake, std::function<void()> after_step)
      : steps_(fake), after_step_(std::move(after_step)) {}

  [[nodiscard]] Time now() noexcept override { return steps_.now(); }
  void wait_until(Time time) noexcept override {
    while (steps_.now() < time) {
      steps_.wait_until(steps_.now() + device::kServoTick);
      after_step_();
    }
  }

 private:
  fakes::SteppingClock<Exports> steps_;
  std::function<void()> after_step_;
};

/// Plugs the device in, calibrates it, and consents.
template <typename Vendor>
class HelperAtCable final : public session::Attendant {
 public:
  explicit HelperAtCable(const Vendor& vendor) : vendor_(vendor) {}

  [[nodiscard]] Reply poll(const std::string& need) override {
    strongest_n = std::max(strongest_n, norm(vendor_.force_n()));
    if (need.empty()) {
      ++consents;
      return Reply::arm;
    }
    if (needs.find(need) == std::string::npos) needs += need + "\n";
    if (std::exchange(plugged, true)) {
      vendor_.calibrate();
    } else {
      vendor_.plug();
    }
    return Reply::wait;
  }

  bool plugged = true;
  std::string needs;  ///< each once
  int consents = 0;
  double strongest_n = 0.0;  ///< before consent to force

 private:
  const Vendor& vendor_;
};

/// Each of five textures is presented twice.
template <typename Vendor>
struct VendorLaboratory {
  VendorLaboratory() { vendor.put(kRestMm, {}); }

  session::RealTimeOptions in_steps() {
    session::RealTimeOptions options = as_fast_as_it_goes();
    options.clock = [this] {
      return std::make_unique<HandledSteps<typename Vendor::Exports>>(vendor.fake.exports(),
                                                                      [this] { step(); });
    };
    return options;
  }

  /// The cable is pulled in this presentation, at this tick, while the hand pushes.
  static constexpr int kUnlucky = 4;
  static constexpr int kTicksToThePull = 900;

  WholeSession whole{2, 1.2};
  Vendor vendor;
  device::falcon::HandOnFalcon hand{kPlacement, kRestMm};
  HelperAtCable<Vendor> helper{vendor};
  session::DeviceStation station{[this] { return vendor.open(); }, kPlacement, helper};
  PersonWithHand person{whole.mind, hand, station};
  session::RealTimeExplorer explorer{in_steps()};

 private:
  /// On the servo's thread, while the stand-in rests.
  void step() {
    const Vec3 position_mm = hand.tick(vendor.force_n());
    vendor.put(position_mm, device::kServoRateHz * (position_mm - last_mm_));
    last_mm_ = position_mm;
    if (person.begun != kUnlucky || ++ticks_ != kTicksToThePull) return;
    helper.plugged = false;
    vendor.unplug();
  }

  Vec3 last_mm_ = kRestMm;
  int ticks_ = 0;  ///< of the unlucky presentation
};

template <typename Vendor>
void check_session() {
  using Laboratory = VendorLaboratory<Vendor>;
  Laboratory lab;
  const session::SessionTally tally = lab.whole.run(lab.station, lab.person, lab.explorer);
  CHECK(tally.presentations == 11);
  CHECK(lab.person.named.size() == 10);
  const record::InterruptionDetail detail = lab.whole.check(lab.person.named, Laboratory::kUnlucky);
  CHECK(detail.ticks > Laboratory::kTicksToThePull);

  // The helper was told what to do; there was no force without consent, and none is left.
  CHECK(std::ranges::count(lab.helper.needs, '\n') >= 2);
  CHECK(lab.helper.consents == 2);
  CHECK(lab.helper.strongest_n == 0.0);
  CHECK(lab.vendor.force_n() == Vec3{});
  CHECK(lab.vendor.fake->misuses == 0);
  // How many answers are right is not judged: where the machine stalls, forces lapse.
  CHECK(lab.whole.report().trials == 10);
}

}  // namespace

TEST_CASE("a whole session on the stand-in for libdhd loses no response, though it is unplugged") {
  check_session<DhdOnCable>();
}

TEST_CASE("a whole session on the stand-in for libHD loses no response, though it is unplugged") {
  check_session<TouchOnCable>();
}

}  // namespace touchtrial
