#include "bench/closed_loop/sampled_wall.hpp"

#include "support/catch.hpp"

namespace touchtrial::bench {
namespace {

SampledWall any_wall() {
  return {GENERATE(100.0, 400.0, 3200.0), GENERATE(-0.4, 0.0, 0.4),
          1.0 / GENERATE(1000.0, 4000.0, 10'000.0)};
}

SampledWall delayed_wall() {
  return {.stiffness_n_per_m = GENERATE(100.0, 800.0),
          .period_s = 1.0 / GENERATE(1000.0, 4000.0),
          .delay_ticks = GENERATE(1, 3, 10)};
}

SampledWall quantised_wall() {
  return {.stiffness_n_per_m = GENERATE(200.0, 400.0), .step_mm = GENERATE(0.01, 0.055)};
}

TEST_CASE("the frequency condition gives K T over 2 plus the wall's damping") {
  const SampledWall wall = any_wall();
  CHECK(damping_by_frequency(wall) == Approx(passivity_bound(wall)).epsilon(1e-6));
}

TEST_CASE("the worst motion extracts as much energy as the bound allows, within 2 percent") {
  const SampledWall wall = any_wall();
  CHECK(damping_by_energy(wall) == Approx(passivity_bound(wall)).epsilon(0.02));
}

TEST_CASE("a delay asks for its stiffness times itself of damping, by both ways") {
  const SampledWall wall = delayed_wall();
  SampledWall prompt = wall;
  prompt.delay_ticks = 0;
  const double more = wall.stiffness_n_per_m * wall.delay_ticks * wall.period_s;
  CHECK(damping_by_frequency(wall) - damping_by_frequency(prompt) == Approx(more).epsilon(1e-4));
  CHECK(damping_by_energy(wall) - damping_by_energy(prompt) == Approx(more).epsilon(0.02));
}

TEST_CASE("no wall needs more damping than the bound, whatever its estimator of velocity") {
  SampledWall wall{.stiffness_n_per_m = 400.0};
  wall.damping_n_s_per_m = GENERATE(-1.0, 0.5, 3.0);
  wall.delay_ticks = GENERATE(0, 2, 7);
  wall.velocity_readings = GENERATE(2, 5, 20);
  CHECK(damping_by_frequency(wall) <= passivity_bound(wall) * (1.0 + 1e-9));
}

TEST_CASE("beside a delay, a little damping of the wall leaves less to hand and device") {
  SampledWall wall{.stiffness_n_per_m = 400.0};
  wall.delay_ticks = 2;
  const double without = damping_by_frequency(wall);
  wall.damping_n_s_per_m = 0.4;
  CHECK(damping_by_frequency(wall) < 0.8 * without);
}

TEST_CASE("readings in steps ask for half a step's force of friction") {
  const SampledWall wall = quantised_wall();
  const double damping = 1.2 * passivity_bound(wall);
  CHECK(friction_for_rest(wall, 0.1, damping) == Approx(friction_bound(wall)).epsilon(0.01));
}

TEST_CASE("without friction a wall that is read in steps never comes to rest") {
  const SampledWall wall = quantised_wall();
  const LimitCycle cycle = limit_cycle(wall, 0.1, 1.2 * passivity_bound(wall));
  CHECK(cycle.mm_s > 0.0);
  CHECK(cycle.mm < 2.0 * wall.step_mm);
}

}  // namespace
}  // namespace touchtrial::bench
