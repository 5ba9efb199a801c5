#include "study/course.hpp"

#include "support/catch.hpp"

#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

using study::OnInterruption;
using study::Presentation;

/// Trials 1 and 2 of block 0, and 3 and 4 of block 1.
study::Schedule two_blocks() {
  study::Schedule schedule;
  for (int trial = 1; trial <= 4; ++trial) {
    schedule.presentations.push_back({.trial = trial, .block = (trial - 1) / 2, .stimulus = {}});
  }
  return schedule;
}

/// A restarted block has two trials, and one more at each further restart.
std::vector<Presentation> drawn(int block, int restarts_before, int first_trial) {
  std::vector<Presentation> again;
  for (int i = 0; i < 2 + restarts_before; ++i) {
    again.push_back({.trial = first_trial + i, .block = block, .stimulus = {}});
  }
  return again;
}

/// Finishes the course.
std::vector<int> rest_of(study::Course& course) {
  std::vector<int> trials;
  for (; !course.is_over(); course.finish({})) trials.push_back(course.current()->trial);
  return trials;
}

TEST_CASE("a course presents its schedule in order, and is over after it") {
  study::Course course(two_blocks(), OnInterruption::repeat);
  CHECK(course.left() == 4);
  CHECK(rest_of(course) == std::vector<int>{1, 2, 3, 4});
  CHECK(course.is_over());
  CHECK(course.current() == nullptr);
}

TEST_CASE("an interrupted presentation is repeated at the end, or left out, as the policy says") {
  study::Course repeated(two_blocks(), OnInterruption::repeat);
  repeated.finish({});
  repeated.spoil();
  CHECK(rest_of(repeated) == std::vector<int>{3, 4, 2});
  study::Course left_out(two_blocks(), OnInterruption::leave_out);
  left_out.finish({});
  left_out.spoil();
  CHECK(rest_of(left_out) == std::vector<int>{3, 4});
}

TEST_CASE("of an order that chooses, an interrupted place is repeated at the end of its block") {
  struct SameAgain final : study::AdaptiveOrder {
    void choose(study::Presentation& place) const override { place.chosen.emplace(); }
    void answer(const study::Presentation& /*shown*/, int /*choice*/) override {}
  };
  study::Course course(two_blocks(), OnInterruption::repeat, {}, std::make_unique<SameAgain>());
  course.spoil();
  course.finish({});
  CHECK(course.current()->trial == 1);
  CHECK(course.current()->interruptions == 1);
  CHECK(rest_of(course) == std::vector<int>{1, 3, 4});
}

TEST_CASE("an interrupted block is restarted under new numbers before all else") {
  const auto restarted = [] {
    study::Course course(two_blocks(), OnInterruption::restart_block, drawn);
    course.finish({});
    course.spoil();
    REQUIRE(course.block_to_restart() == 0);
    const study::BlockRestart again = course.drawn_again(0);
    CHECK(again.first_trial() == 5);
    course.restart(again);
    CHECK_FALSE(course.block_to_restart());
    return course;
  };
  study::Course once = restarted();
  CHECK(rest_of(once) == std::vector<int>{5, 6, 3, 4});
  study::Course course = restarted();
  CHECK(course.was_given_up(2));
  CHECK_FALSE(course.was_given_up(3));
  CHECK_FALSE(course.was_given_up(5));
  CHECK(course.has(6));
  CHECK_FALSE(course.has(7));
  course.spoil();
  course.restart(course.drawn_again(0));
  CHECK(rest_of(course) == std::vector<int>{7, 8, 9, 3, 4});
  CHECK(course.was_given_up(6));
  CHECK(course.schedule().presentations.size() == 9);
}

TEST_CASE("a course that restarts blocks needs to know how to draw them") {
  CHECK_THROWS_AS(study::Course(two_blocks(), OnInterruption::restart_block),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
