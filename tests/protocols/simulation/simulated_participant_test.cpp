#include "protocols/identification/simulation/identifying_participant.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <set>

namespace touchtrial {
namespace {

constexpr PlaneGeometry kPlane{0.2, 120, 120};
const std::vector<std::string> kPictures = {"straw", "bark", "brick"};

/// Three classes that feel alike in all but strength.
simulation::FeltKnowledge knowledge() {
  simulation::FeltKnowledge known;
  known.label_of_prototype = {"bark", "straw", "brick"};
  for (int label = 0; label < 3; ++label) {
    known.examples.push_back(
        {label, std::vector<double>(engine::kFeltFeatures, -6.0 + 2.0 * label)});
  }
  return known;
}

/// Feels a lateral and normal noise of a strength, long enough to be judged.
void feel_noise(session::Participant& participant, double strength_n) {
  static_cast<void>(participant.begin_exploring(kPlane));
  RandomStream random(3, "simulated_participant_test");
  for (int i = 0; i < 3000; ++i) {
    const Vec3 noise{random.normal(), random.normal(), random.normal()};
    participant.feel(
        {{0.1 * i, 5.0, -1.0}, Vec3{0.0, 0.0, 20.0 * strength_n} + strength_n * noise});
  }
}

std::vector<int> answers(const simulation::SubjectModel& subject, int count, std::uint64_t seed = 1,
                         double strength_n = 0.002) {
  const simulation::FeltKnowledge known = knowledge();
  simulation::identification::IdentifyingParticipant participant(subject, known, seed, 1);
  participant.see_pictures(kPictures);
  std::vector<int> given;
  for (int i = 0; i < count; ++i) {
    feel_noise(participant, strength_n);
    given.push_back(participant.answer().position);
  }
  return given;
}

TEST_CASE("an ideal subject names the picture of the class that feels most alike") {
  CHECK(answers({}, 1, 1, 0.002).front() == 1);  // bark, the weakest
  CHECK(answers({}, 1, 1, 20.0).front() == 2);   // brick, the strongest
}

TEST_CASE("a label swap exchanges the pictures of two classes and leaves the others") {
  simulation::SubjectModel swapped{.label_swap = {{"bark", "straw"}}};
  CHECK(answers(swapped, 1, 1, 0.002).front() == 0);
  CHECK(answers(swapped, 1, 1, 20.0).front() == 2);
}

TEST_CASE("a subject who always lapses answers every position about equally often") {
  simulation::SubjectModel lapsing{.lapse = 1.0};
  const std::vector<int> given = answers(lapsing, 300);
  for (int position = 0; position < 3; ++position) {
    // 99.9 % of binomial draws with n = 300, p = 1/3 lie within 27 of 100.
    CHECK(std::abs(std::ranges::count(given, position) - 100) <= 27);
  }
}

TEST_CASE("a strong bias wins over what is felt") {
  simulation::SubjectModel first{.feature_noise = 0.3, .position_bias = 1e6};
  CHECK(answers(first, 1).front() == 0);
  simulation::SubjectModel fond{.feature_noise = 0.3, .class_bias = {{"brick", 1e6}}};
  CHECK(answers(fond, 1).front() == 2);
}

TEST_CASE("answers and thinking times are functions of the seed and the participant's number") {
  simulation::SubjectModel unsure{.feature_noise = 30.0};
  CHECK(answers(unsure, 40, 5) == answers(unsure, 40, 5));
  CHECK(answers(unsure, 40, 5) != answers(unsure, 40, 6));
}

TEST_CASE("the time to think does not depend on what is felt") {
  const simulation::FeltKnowledge known = knowledge();
  const simulation::SubjectModel subject;
  std::set<std::chrono::nanoseconds> thoughts;
  for (const double strength_n : {0.002, 0.05, 20.0}) {
    simulation::identification::IdentifyingParticipant participant(subject, known, 1, 1);
    participant.see_pictures(kPictures);
    feel_noise(participant, strength_n);
    thoughts.insert(participant.answer().thought);
  }
  CHECK(thoughts.size() == 1);
}

TEST_CASE("every exploration has a path of its own") {
  const simulation::FeltKnowledge known = knowledge();
  const simulation::SubjectModel subject;
  simulation::identification::IdentifyingParticipant one(subject, known, 1, 1);
  simulation::identification::IdentifyingParticipant other(subject, known, 1, 2);
  std::set<double> starts;
  device::DeviceSample sample;
  for (simulation::identification::IdentifyingParticipant* participant :
       {&one, &one, &other, &other}) {
    REQUIRE(participant->begin_exploring(kPlane).read(sample) == device::DeviceStatus::ok);
    starts.insert(sample.position_mm.x);
  }
  CHECK(starts.size() == 4);
}

TEST_CASE("a class that was learnt and has no picture is refused") {
  const simulation::FeltKnowledge known = knowledge();
  const simulation::SubjectModel subject;
  simulation::identification::IdentifyingParticipant participant(subject, known, 1, 1);
  CHECK_THROWS_AS(participant.see_pictures({"bark", "straw"}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
