#include "analysis/measures/rms_alone.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::engine;

namespace {

TextureField field_of(int side, double left, double right) {
  Plane<FieldSample> samples(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double force = x < side / 5 ? left : right;
      samples.at(y, x) = {128.0F, static_cast<float>(0.6 * force), static_cast<float>(0.8 * force)};
    }
  }
  return {PlaneGeometry{0.2, side, side}, std::move(samples)};
}

}  // namespace

TEST_CASE("a patch's strength is the logarithm of its rms force in newtons") {
  const TextureField field = field_of(52, 10.0, 20.0);
  const std::vector<double> strengths = patch_strengths(field.view(), 0.01, 1e-9);
  REQUIRE(strengths.size() == 25);
  CHECK(strengths[0] == Approx(std::log(0.1)));
  CHECK(strengths[1] == Approx(std::log(0.2)));
  CHECK(strengths[24] == Approx(std::log(0.2)));
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
