#include "analysis/planning/power_plan.hpp"
#include "analysis/planning/subject_fit.hpp"
#include "support/catch.hpp"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using simulation::SubjectModel;

/// Each change alone, and the key that a fit ignores.
struct Change {
  std::string ignored;
  std::function<void(SubjectModel&)> make;
};

const std::vector<Change>& changes() {
  static const std::vector<Change> all{
      {"training", [](SubjectModel& one) { one.training = simulation::Training::own; }},
      {"", [](SubjectModel& one) { one.hand = device::HandKind::stylus_grip; }},
      {"memory_noise", [](SubjectModel& one) { one.memory_noise = 0.1; }},
      {"learning", [](SubjectModel& one) { one.learning.factor = 1.5; }},
      {"period_noise_spread", [](SubjectModel& one) { one.period_noise_spread = 0.2; }},
      {"serial", [](SubjectModel& one) { one.serial.answer = -0.2; }},
      {"serial", [](SubjectModel& one) { one.serial.stimulus_spread = 0.2; }},
      {"fatigue", [](SubjectModel& one) { one.fatigue.noise_per_min = 0.02; }},
      {"fatigue", [](SubjectModel& one) { one.fatigue.lapse_per_min = 0.02; }},
  };
  return all;
}

TEST_CASE("every change that matters to answers changes the words of an assumption") {
  std::set<std::string> seen{planning::words_of(SubjectModel{})};
  for (const Change& change : changes()) {
    SubjectModel subject;
    change.make(subject);
    CHECK(seen.insert(planning::words_of(subject)).second);
  }
}

TEST_CASE("a fit names each key that it ignores") {
  CHECK(planning::keys_ignored_by_fits({}).empty());
  SubjectModel every;
  for (const Change& change : changes()) {
    SubjectModel subject;
    change.make(subject);
    CHECK(planning::keys_ignored_by_fits(subject) == change.ignored);
    change.make(every);
  }
  CHECK(planning::keys_ignored_by_fits(every) ==
        "training, memory_noise, learning, period_noise_spread, serial, fatigue");
}

}  // namespace
}  // namespace touchtrial
