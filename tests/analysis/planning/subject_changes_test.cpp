#include "analysis/planning/power_runs.hpp"
#include "analysis/planning/subject_fit.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <functional>
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

/// Without the digest at their end.
std::string words_for(const SubjectModel& subject) {
  const std::string words = planning::words_of(subject);
  return words.substr(0, words.find("; all of it "));
}

TEST_CASE("every change that matters to answers changes the words of an assumption") {
  const std::string without = words_for(SubjectModel{});
  std::vector<std::string> seen{without};
  for (const Change& change : changes()) {
    SubjectModel subject;
    change.make(subject);
    const std::string words = words_for(subject);
    CHECK(words.starts_with(without));
    CHECK(std::ranges::find(seen, words) == seen.end());
    seen.push_back(words);
  }
}

TEST_CASE("a fit names each key that it ignores") {
  CHECK(planning::keys_that_fits_ignore({}).empty());
  SubjectModel every;
  for (const Change& change : changes()) {
    SubjectModel subject;
    change.make(subject);
    CHECK(planning::keys_that_fits_ignore(subject) == change.ignored);
    change.make(every);
  }
  CHECK(planning::keys_that_fits_ignore(every) ==
        "training, memory_noise, learning, period_noise_spread, serial, fatigue");
}

}  // namespace
}  // namespace touchtrial
