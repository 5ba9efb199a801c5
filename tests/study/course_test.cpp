#include "study/course.hpp"

#include "support/catch.hpp"

#include <memory>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

using study::OnInterruption;
using study::Trial;

/// Trials 1 and 2 of block 0, and 3 and 4 of block 1.
study::Schedule two_blocks() {
  study::Schedule schedule;
  for (int trial = 1; trial <= 4; ++trial) {
    schedule.trials.push_back(
        {.place = {.trial = trial, .block = (trial - 1) / 2}, .planes = {{.field = {}}}});
  }
  return schedule;
}

/// Presents two blocks. A restarted one has two trials, and one more at each further restart.
class GrowingBlocks final : public study::Order {
 public:
  GrowingBlocks() : Order(two_blocks(), SecretKey{}) {}
  std::vector<Trial> redraw_block(int block, int restarts_before, int first_trial) const override {
    std::vector<Trial> again;
    for (int i = 0; i < 2 + restarts_before; ++i) {
      again.push_back(
          {.place = {.trial = first_trial + i, .block = block}, .planes = {{.field = {}}}});
    }
    return again;
  }
};

study::Course course_of_blocks(OnInterruption policy) {
  return {std::make_unique<GrowingBlocks>(), policy};
}

/// Chooses a plane for each place of two blocks, and records which trials were interrupted.
class SameAgain final : public study::Order {
 public:
  explicit SameAgain(std::vector<int>& trials) : Order(without_planes(), {}), trials_(trials) {}
  Trial at(const Trial& scheduled) const override {
    Trial trial = scheduled;
    trial.planes.resize(1);
    return trial;
  }
  void interrupted(const Trial& shown) override { trials_.push_back(shown.place.trial); }

 private:
  static study::Schedule without_planes() {
    study::Schedule schedule = two_blocks();
    for (Trial& trial : schedule.trials) trial.planes.clear();
    return schedule;
  }

  std::vector<int>& trials_;
};

/// Finishes the course.
std::vector<int> rest_of(study::Course& course) {
  std::vector<int> trials;
  for (; !course.is_over(); course.finish({})) trials.push_back(course.current()->place.trial);
  return trials;
}

TEST_CASE("a course presents its schedule in order, and is over after it") {
  study::Course course = course_of_blocks(OnInterruption::repeat);
  CHECK(course.remaining() == 4);
  CHECK(rest_of(course) == std::vector<int>{1, 2, 3, 4});
  CHECK(course.is_over());
  CHECK(course.current() == nullptr);
}

TEST_CASE("an interrupted presentation is repeated at the end, or left out, as the policy says") {
  study::Course repeated = course_of_blocks(OnInterruption::repeat);
  repeated.finish({});
  repeated.interrupt();
  CHECK(rest_of(repeated) == std::vector<int>{3, 4, 2});
  study::Course left_out = course_of_blocks(OnInterruption::leave_out);
  left_out.finish({});
  left_out.interrupt();
  CHECK(rest_of(left_out) == std::vector<int>{3, 4});
}

TEST_CASE("of an order that chooses, an interrupted place is repeated at the end of its block") {
  std::vector<int> trials;
  study::Course course(std::make_unique<SameAgain>(trials), OnInterruption::repeat);
  CHECK(course.is_adaptive());
  course.interrupt();
  course.finish({});
  CHECK(course.current()->place.trial == 1);
  CHECK(course.current()->planes.size() == 1);
  CHECK(trials == std::vector<int>{1});
  CHECK(rest_of(course) == std::vector<int>{1, 3, 4});
}

TEST_CASE("an interrupted block is restarted under new numbers before all else") {
  const auto restarted = [] {
    study::Course course = course_of_blocks(OnInterruption::restart_block);
    course.finish({});
    course.interrupt();
    REQUIRE(course.block_to_restart() == 0);
    const study::BlockRestart again = course.redrawn_block(0);
    CHECK(again.first_trial() == 5);
    course.restart(again);
    CHECK_FALSE(course.block_to_restart());
    return course;
  };
  study::Course once = restarted();
  CHECK(rest_of(once) == std::vector<int>{5, 6, 3, 4});
  study::Course course = restarted();
  CHECK(course.is_void(2));
  CHECK_FALSE(course.is_void(3));
  CHECK_FALSE(course.is_void(5));
  CHECK(course.has_trial(6));
  CHECK_FALSE(course.has_trial(7));
  course.interrupt();
  course.restart(course.redrawn_block(0));
  CHECK(rest_of(course) == std::vector<int>{7, 8, 9, 3, 4});
  CHECK(course.is_void(6));
  CHECK(course.schedule().trials.size() == 9);
}

TEST_CASE("blocks of an order that chooses cannot be restarted") {
  std::vector<int> trials;
  CHECK_THROWS_AS(study::Course(std::make_unique<SameAgain>(trials), OnInterruption::restart_block),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
