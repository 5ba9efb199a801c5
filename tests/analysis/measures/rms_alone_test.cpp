#include "analysis/measures/rms_alone.hpp"

#include "engine/rendering/field_statistics.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::engine;

namespace {

/// A ramp of a slope whose force is `left` grey levels per pixel in the first fifth of the columns,
/// and `right` in the others.
TextureField field_of(int side, double left, double right) {
  Plane<float> heights(side, side);
  for (int y = 0; y < side; ++y) {
    double height = 0.0;
    for (int x = 0; x < side; ++x) {
      heights.at(y, x) = static_cast<float>(height);
      height -= (x < side / 5 ? left : right) / 4.0;
    }
  }
  return TextureField({.geometry = {0.2, side, side}}, std::move(heights));
}

/// The strength of a patch of known forces, from the definition.
double strength_of(FieldView field, int first_y, int first_x, int patch, double tangential_n) {
  const ForceField<double> force = lateral_field(field, {}).force;
  double squares = 0.0;
  for (int y = first_y; y < first_y + patch; ++y) {
    for (int x = first_x; x < first_x + patch; ++x) {
      squares += std::pow(tangential_n * force.x.at(y, x), 2) +
                 std::pow(tangential_n * force.y.at(y, x), 2);
    }
  }
  return 0.5 * std::log(squares / (patch * patch));
}

}  // namespace

TEST_CASE("a patch's strength is the logarithm of its rms force in newtons") {
  const TextureField field = field_of(52, 10.0, 20.0);
  const std::vector<double> strengths = patch_strengths(field.view(), 0.01, 1e-9);
  REQUIRE(strengths.size() == 25);
  CHECK(strengths[0] == Approx(strength_of(field.view(), 0, 0, 10, 0.01)));
  CHECK(strengths[7] == Approx(std::log(0.2)));  // inside, where the force is 20 throughout
  CHECK(strengths[1] == Approx(strength_of(field.view(), 0, 10, 10, 0.01)));
  CHECK(patch_strengths(field_of(20, 0.0, 0.0).view(), 0.01, 0.002)[7] == Approx(std::log(0.002)));
  CHECK_THROWS_AS(patch_strengths(field_of(4, 1.0, 1.0).view(), 0.01, 0.002),
                  std::invalid_argument);
}

TEST_CASE(
    "classes of very different strength are always distinguished, equal ones only by chance") {
  const std::vector<PatchStrengths> apart = {{0, {1.0, 1.1}}, {1, {2.0, 2.1}}, {2, {3.0, 3.1}}};
  CHECK(rms_alone(apart, 3).unseen_patch == 1.0);
  CHECK(rms_alone(apart, 2).sets == 3);
  // Interleaved strengths: two patches of each class lie on the other's side.
  const std::vector<PatchStrengths> mixed = {{0, {0.0, 1.0, 0.0, 1.0}}, {1, {0.0, 1.0, 0.0, 1.0}}};
  CHECK(rms_alone(mixed, 2).unseen_patch <= 0.5);
}

TEST_CASE("one class within another's range gives the count done by hand") {
  // Means 0 and 2. Without itself, 3.0 leaves mean 1 to its class: |3 - 1| = 2 < 3, right; 1.0
  // leaves mean 3: |1 - 3| = 2 > 1, wrong. The class of zeros is always right.
  const std::vector<PatchStrengths> pictures = {{0, {0.0, 0.0}}, {1, {1.0, 3.0}}};
  CHECK(rms_alone(pictures, 2).unseen_patch == Approx(0.75));
  CHECK(rms_alone(pictures, 2).unseen_picture == -1.0);
}

TEST_CASE("an unseen picture is judged by its class's other pictures") {
  // The second picture of class 0 is as strong as class 1, so it is never recognised; all others
  // are.
  const std::vector<PatchStrengths> pictures = {
      {0, {0.0, 0.0}}, {0, {5.0, 5.0}}, {1, {5.0, 5.0}}, {1, {5.2, 5.2}}};
  const RmsAlone score = rms_alone(pictures, 2);
  CHECK(score.unseen_picture == Approx(0.75));
  CHECK(score.classes == 2);
  CHECK(score.sets == 1);
}

TEST_CASE("impossible sets and classes without patches are refused") {
  const std::vector<PatchStrengths> pictures = {{0, {0.0, 0.1}}, {1, {1.0, 1.1}}};
  CHECK_THROWS_AS(rms_alone(pictures, 1), std::invalid_argument);
  CHECK_THROWS_AS(rms_alone(pictures, 3), std::invalid_argument);
  const std::vector<PatchStrengths> gap = {{0, {0.0, 0.1}}, {2, {1.0, 1.1}}};
  CHECK_THROWS_AS(rms_alone(gap, 2), std::invalid_argument);
  const std::vector<PatchStrengths> negative = {{-1, {0.0, 0.1}}};
  CHECK_THROWS_AS(rms_alone(negative, 2), std::invalid_argument);
}
