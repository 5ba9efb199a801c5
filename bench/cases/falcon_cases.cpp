#include "bench/cases/cases.hpp"
#include "core/random.hpp"
#include "device/falcon/falcon_kinematics.hpp"
#include "tests/device/falcon/falcon_inverse.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace touchtrial::bench {
namespace {

/// Readings in one run, a millisecond apart, of a hand at some 100 mm/s.
constexpr int kReadings = 10000;
constexpr double kStepMm = 0.1;
/// The hand turns back before the edge of the workspace.
constexpr double kTurnBackMm = 30.0;
constexpr Vec3 kForceN = {0.3, -0.2, 0.6};

std::vector<device::falcon::PerLeg> readings_of_a_stroke() {
  RandomStream random(1, "benchmark falcon");
  std::vector<device::falcon::PerLeg> readings;
  Vec3 place_mm;
  Vec3 heading = {1.0, 0.0, 0.0};
  while (readings.size() < kReadings) {
    heading = heading + 0.2 * Vec3{random.normal(), random.normal(), random.normal()};
    if (norm(place_mm) > kTurnBackMm) heading = -1.0 * place_mm;
    heading = (1.0 / norm(heading)) * heading;
    place_mm = place_mm + kStepMm * heading;
    const auto legs =
        device::falcon::inverse_kinematics(device::falcon::to_native_m(place_mm)).value();
    readings.push_back({legs[0].theta1_rad, legs[1].theta1_rad, legs[2].theta1_rad});
  }
  return readings;
}

struct FalconStroke {
  /// \param warm  each pose is sought from the one before, as the driver does
  void run(bool warm) {
    for (const device::falcon::PerLeg& reading : readings) {
      const device::falcon::Pose pose =
          device::falcon::forward_kinematics(reading, warm ? last_m : device::falcon::kCentreM);
      last_m = pose.native_m;
      sum_nm += device::falcon::torques_nm(pose.jacobian, kForceN).value()[0];
    }
  }

  std::vector<device::falcon::PerLeg> readings = readings_of_a_stroke();
  Vec3 last_m = device::falcon::kCentreM;
  double sum_nm = 0.0;  ///< so that no pose can be left out
};

Case falcon_case(bool warm) {
  Case one;
  one.work = "Falcon, angles to pose to torques";
  one.who = our_name() + (warm ? ", from the last pose" : ", from the centre");
  one.make = [warm] {
    const auto stroke = std::make_shared<FalconStroke>();
    return Job{[=] { stroke->run(warm); }, {}, kReadings};
  };
  return one;
}

}  // namespace

Cases falcon_cases() {
  return {falcon_case(true), falcon_case(false)};
}

}  // namespace touchtrial::bench
