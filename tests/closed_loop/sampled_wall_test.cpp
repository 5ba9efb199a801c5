#include "bench/closed_loop/sampled_wall.hpp"

#include "support/catch.hpp"

namespace touchtrial::bench {
namespace {

SampledWall any_wall() {
  return {GENERATE(100.0, 400.0, 3200.0), GENERATE(-0.4, 0.0, 0.4),
          1.0 / GENERATE(1000.0, 4000.0, 10'000.0)};
}

TEST_CASE("the frequency condition gives K T over 2 plus the wall's damping") {
  const SampledWall wall = any_wall();
  CHECK(damping_by_frequency(wall) == Approx(passivity_bound(wall)).epsilon(1e-6));
}

TEST_CASE("the worst motion extracts as much energy as the bound allows, within 2 percent") {
  const SampledWall wall = any_wall();
  CHECK(damping_by_energy(wall) == Approx(passivity_bound(wall)).epsilon(0.02));
}

TEST_CASE("a heavy mass comes to rest with half of K T less the wall's damping") {
  const SampledWall wall{GENERATE(100.0, 400.0), 0.0, 1.0 / GENERATE(1000.0, 10'000.0)};
  const double mass_kg = wall.stiffness_n_per_m * wall.period_s * wall.period_s / 0.01;
  CHECK(damping_for_rest(wall, mass_kg) == Approx(passivity_bound(wall)).epsilon(0.02));
  SampledWall damped = wall;
  damped.damping_n_s_per_m = 0.2 * passivity_bound(wall);
  CHECK(damping_for_rest(damped, mass_kg) == Approx(0.8 * passivity_bound(wall)).epsilon(0.02));
}

}  // namespace
}  // namespace touchtrial::bench
