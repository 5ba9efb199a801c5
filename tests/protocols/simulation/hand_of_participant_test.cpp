// How participants' hands differ, and what that leaves as it was.
#include "device/flat_wall.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>

namespace touchtrial {
namespace {

using simulation::SubjectModel;

constexpr PlaneGeometry kPlane{0.2, 500, 500};

std::vector<device::ServoSample> explored(const SubjectModel& subject,
                                          const device::HandFactors& factors = {}) {
  RandomStream random(3, "hand_of_participant_test");
  device::SimulatedHand hand = simulation::make_exploring_hand(subject, kPlane, random, factors);
  FlatWall wall;
  KeptSamples kept;
  static_cast<void>(device::run_servo_in_virtual_time(hand, wall, kept, {}));
  return kept.samples;
}

TEST_CASE("without a spread everybody has the hand of the model, exactly") {
  const SubjectModel subject;
  for (std::uint64_t number = 1; number < 50; ++number) {
    const device::HandFactors factors = simulation::hand_of_participant(subject, 7, number);
    CHECK(factors.stiffness == 1.0);
    CHECK(factors.damping == 1.0);
    CHECK(factors.mass == 1.0);
  }
}

TEST_CASE("hands spread log-normally, in three ways that know nothing of each other") {
  SubjectModel subject{.hand_spread = 0.3};
  constexpr int kPeople = 4000;
  std::array<double, 3> sums{};
  std::array<double, 3> squares{};
  double products = 0.0;
  for (int number = 1; number <= kPeople; ++number) {
    const device::HandFactors f =
        simulation::hand_of_participant(subject, 7, static_cast<std::uint64_t>(number));
    const std::array logs{std::log(f.stiffness), std::log(f.damping), std::log(f.mass)};
    for (std::size_t i = 0; i < logs.size(); ++i) {
      sums[i] += logs[i];
      squares[i] += logs[i] * logs[i];
    }
    products += logs[0] * logs[1] + logs[1] * logs[2] + logs[2] * logs[0];
  }
  // Five standard errors.
  const double root = std::sqrt(kPeople);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    CHECK(std::abs(sums[i] / kPeople) < 5.0 * 0.3 / root);
    CHECK(std::sqrt(squares[i] / kPeople) == Approx(0.3).epsilon(5.0 / std::sqrt(2.0) / root));
  }
  CHECK(std::abs(products / kPeople) < 5.0 * std::sqrt(3.0) * 0.09 / root);
  // A larger spread moves the same person further.
  const double once = std::log(simulation::hand_of_participant(subject, 7, 3).mass);
  subject.hand_spread = 0.6;
  CHECK(std::log(simulation::hand_of_participant(subject, 7, 3).mass) ==
        Approx(2.0 * once).epsilon(1e-12));
}

TEST_CASE("a hand's kind and factors change the motion, and the path stays the same") {
  SubjectModel subject{.explore_s = 3.0};
  const auto point_mass = explored(subject);
  const auto heavier = explored(subject, {.mass = 2.0});
  subject.hand = device::HandKind::stylus_grip;
  const auto grip = explored(subject);
  REQUIRE(point_mass.size() == 3000);
  REQUIRE(grip.size() == 3000);
  CHECK(heavier[2000].position_mm != point_mass[2000].position_mm);
  CHECK(grip.front().position_mm == point_mass.front().position_mm);
  const Vec3 apart_mm = grip[2000].position_mm - point_mass[2000].position_mm;
  CHECK(norm(apart_mm) > 0.0);
  CHECK(norm(apart_mm) < 15.0);
}

}  // namespace
}  // namespace touchtrial
