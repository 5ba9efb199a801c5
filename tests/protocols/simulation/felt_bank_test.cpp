#include "protocols/simulation/felt_bank.hpp"

#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/confusion_of.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/simulation.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace touchtrial {
namespace {

/// A subject who is so unsure that answers differ, with every kind of error.
simulation::SubjectModel erring_subject() {
  return {.feature_noise = 1.2,
          .feature_noise_spread = 0.4,
          .lapse = 0.15,
          .lapse_spread = 0.5,
          .position_bias = 0.8,
          .position_bias_spread = 0.4,
          .class_bias = {{"brick", 0.5}},
          .class_bias_spread = 0.3,
          .label_swap = {{"bark", "cloth"}},
          .explore_s = 1.5,
          .hand = device::HandKind::stylus_grip,
          .hand_spread = 0.3,
          .training_passes = 4};
}

std::vector<std::string> labels_of(const study::Schedule& schedule, const study::Study& study) {
  std::vector<std::string> labels;
  for (const int picture : schedule.layout) labels.push_back(study.classes[picture].label);
  return labels;
}

struct Fields {
  explicit Fields(const TinyStudy& study)
      : source(study.pack(), study.key().study.rendering), all(study.key(), source) {}
  session::StimulusSource source;
  simulation::LabelledFields all;
};

simulation::FeltBank bank_of(const TinyStudy& study, const simulation::FeltBankOptions& options) {
  return {Fields(study).all, study.key().study, erring_subject(), options};
}

TEST_CASE("answers to trials that are felt without a session equal those of sessions, one by one") {
  // A limit that is shorter than the exploration: the force's fading is felt as well.
  const std::string trials =
      GENERATE(R"({"repeats": 3, "lead_in": 2, "catch": 0})",
               R"({"repeats": 2, "explore_limit_s": 1.2})", R"({"repeats": 2, "rove_db": 12})");
  TinyStudy study({.images = 2, .trials = trials, .rendering = R"({"max_force_n": 0.9})"});
  const simulation::SubjectModel subject = erring_subject();
  constexpr std::uint64_t kSeed = 17;
  record::StudyStore store = record::StudyStore::create(
      study.next_database(), session::commitment_of(study.key(), study.pack(), true, false), {},
      study.key().signer());
  static_cast<void>(simulation::simulate_study(
      study.key(), study.pack(), subject, {.participants = 3, .seed = kSeed, .jobs = 2}, store));
  const study::Study& design = study.key().study;
  const Fields fields(study);
  const simulation::FeltKnowledge knowledge =
      simulation::learn_by_feeling(fields.all, subject, design.rendering.max_force_n, kSeed, 1);
  const simulation::FeltBank places = bank_of(study, {.explorations = 1});
  const std::vector<record::TrialRow> rows = opened_trials(store, study.key());
  std::size_t row = 0;
  for (int number = 1; number <= 3; ++number) {
    const study::Schedule schedule =
        study::make_schedule(design, study.key().draw_of(number, study::Draws::rehearsal));
    const simulation::Individual individual(subject, kSeed, number);
    const simulation::MatchedPictures pictures =
        simulation::match_pictures(labels_of(schedule, design), subject, individual, knowledge);
    const simulation::FeltDecision decision(individual, knowledge);
    std::uint64_t nth = 0;
    for (const study::Trial& shown : schedule.trials) {
      const simulation::LabelledField& field = fields.all.all()[places.place_of(shown.field())];
      const engine::FeltFeatures felt =
          simulation::feel_trial(field, shown.planes.front().gain_db, fields.all.plane(), design,
                                 subject, kSeed, number, ++nth);
      RandomStream random =
          simulation::stream_of_trial(kSeed, simulation::kAnswerPurpose, number, nth);
      REQUIRE(row < rows.size());
      INFO("participant " << number << ", presentation " << nth);
      REQUIRE(position_of(rows[row].answer).value() ==
              decision.answer(felt, pictures, random).position);
      ++row;
    }
  }
  CHECK(row == rows.size());
}

TEST_CASE("a bank is the same for any number of jobs, and a larger one begins with the smaller") {
  const TinyStudy study;
  const simulation::FeltBank alone = bank_of(study, {.explorations = 6, .seed = 3, .jobs = 1});
  const simulation::FeltBank crowd = bank_of(study, {.explorations = 6, .seed = 3, .jobs = 4});
  const simulation::FeltBank fewer = bank_of(study, {.explorations = 2, .seed = 3, .jobs = 2});
  const simulation::FeltBank other = bank_of(study, {.explorations = 6, .seed = 4, .jobs = 2});
  REQUIRE(alone.stimuli() == 5);
  for (int place = 0; place < 5; ++place) {
    for (int i = 0; i < 6; ++i) REQUIRE(alone.felt(place)[i] == crowd.felt(place)[i]);
    for (int i = 0; i < 2; ++i) REQUIRE(alone.felt(place)[i] == fewer.felt(place)[i]);
    REQUIRE(alone.felt(place)[0] != alone.felt(place)[1]);
    REQUIRE(alone.felt(place)[0] != other.felt(place)[0]);
  }
}

TEST_CASE("a bank does not depend on codes, noise or bias") {
  const TinyStudy study({.secret = 1});
  const TinyStudy recoded({.secret = 2});
  simulation::SubjectModel still{.explore_s = erring_subject().explore_s,
                                 .hand = erring_subject().hand,
                                 .hand_spread = erring_subject().hand_spread};
  const simulation::FeltBank one = bank_of(study, {.explorations = 2});
  const simulation::FeltBank other(Fields(recoded).all, recoded.key().study, still,
                                   {.explorations = 2});
  for (int place = 0; place < one.stimuli(); ++place) {
    CHECK(one.felt(place)[1] == other.felt(place)[1]);
  }
}

TEST_CASE("a bank has every class, image and method of a study, and gives their places") {
  const TinyStudy study({.images = 2, .comparison = true});
  const simulation::FeltBank bank = bank_of(study, {.explorations = 1});
  REQUIRE(bank.stimuli() == 20);
  for (int place = 0; place < 20; ++place) CHECK(bank.place_of(bank.stimulus(place)) == place);
  CHECK_THROWS_AS(bank.place_of({5, 0, 0}), std::invalid_argument);
}

TEST_CASE("a bank's explorations are draws from what trials feel like") {
  const TinyStudy study;
  const Fields fields(study);
  const simulation::FeltBank bank = bank_of(study, {.explorations = 60, .jobs = 2});
  const simulation::SubjectModel subject = erring_subject();
  double difference = 0.0;
  double square = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double trial =
        simulation::feel_trial(fields.all.all()[0], 0.0, fields.all.plane(), study.key().study,
                               subject, 5, i + 1, 1)[engine::kLateralBandsAt + 2];
    const double banked = bank.felt(0)[i][engine::kLateralBandsAt + 2];
    difference += trial - banked;
    square += (trial - banked) * (trial - banked);
  }
  // Within 3.3 standard errors of nothing.
  CHECK(std::abs(difference) <= 3.3 * std::sqrt(square));
  CHECK(square > 0.0);
}

TEST_CASE("a bank of roved planes is as strong as gains drawn evenly over the range") {
  const TinyStudy study;
  const TinyStudy roved({.trials = R"({"rove_db": 20})"});
  const simulation::FeltBank whole = bank_of(study, {.explorations = 60, .jobs = 2});
  const simulation::FeltBank bank = bank_of(roved, {.explorations = 60, .jobs = 2});
  double sum_db = 0.0;
  double weakest_db = 0.0;
  constexpr double kDbPerNeper = 8.685889638;
  for (int i = 0; i < 60; ++i) {
    const std::size_t lateral = engine::kLateralBandsAt + 2;
    const double db = kDbPerNeper * (bank.felt(0)[i][lateral] - whole.felt(0)[i][lateral]);
    CHECK(db < 0.5);  // a weaker texture leaves another path, but for little
    sum_db += db;
    weakest_db = std::min(weakest_db, db);
  }
  // The mean of 60 uniform draws has a standard error of 20 / sqrt(12 * 60).
  CHECK(sum_db / 60.0 == Approx(-10.0).margin(3.3 * 20.0 / std::sqrt(12.0 * 60.0)));
  CHECK(weakest_db < -17.0);
}

TEST_CASE("a bank counts its explorations, and refuses impossible numbers") {
  const TinyStudy study;
  const Fields fields(study);
  const auto make = [&](const simulation::FeltBankOptions& options,
                        const study::Progress& progress) {
    return simulation::FeltBank(fields.all, study.key().study, erring_subject(), options, progress);
  };
  int last = 0;
  make({.explorations = 2, .jobs = 2}, [&](int done, int of) {
    CHECK(done == last + 1);
    CHECK(of == 10);
    last = done;
  });
  CHECK(last == 10);
  CHECK_THROWS_AS(make({.explorations = 0}, {}), std::invalid_argument);
  CHECK_THROWS_AS(make({.explorations = 1 << 24}, {}), std::invalid_argument);
  CHECK_THROWS_AS(make({.jobs = 0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
