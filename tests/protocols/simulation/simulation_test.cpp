#include "protocols/simulation/simulation.hpp"

#include "core/errors.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/confusion_of.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"

#include <map>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// Quick explorations, with the training that they need.
simulation::SubjectModel quick_subject(double explore_s = 2.0) {
  return {.explore_s = explore_s, .training_passes = 6};
}

record::StudyStore empty_store(TinyStudy& study) {
  return record::StudyStore::create(study.next_database(),
                                    session::commitment_of(study.key(), study.pack(), true, false),
                                    {}, study.key().signer());
}

record::StudyStore simulated(TinyStudy& study, const simulation::SubjectModel& subject,
                             const simulation::SimulationOptions& options) {
  record::StudyStore store = empty_store(study);
  static_cast<void>(simulation::simulate_study(study.key(), study.pack(), subject, options, store));
  return store;
}

std::vector<int> answers_of(const record::StudyStore& store, const study::StudyKey& key) {
  std::vector<int> answers;
  for (const record::TrialRow& row : opened_trials(store, key))
    answers.push_back(position_of(row.answer).value_or(-1));
  return answers;
}

TEST_CASE("an ideal subject tells almost all textures apart, and every trial is answered") {
  TinyStudy study;
  const record::StudyStore store =
      simulated(study, quick_subject(), {.participants = 4, .seed = 3});
  const Confusion confusion = confusion_of(store, study.key());
  CHECK(correct_of(confusion) >= 98);
  CHECK(store.trials().size() == 100);
  for (const record::TrialRow& row : opened_trials(store, study.key())) {
    REQUIRE(row.state == record::TrialState::answered);
    REQUIRE(row.contact_at.value() > row.presented_at);
    REQUIRE(row.answered_at.value() > row.contact_at.value());
    REQUIRE(row.samples == 2000);
  }
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("on smooth planes every subject is at chance") {
  TinyStudy study({.smooth = true});
  simulation::SubjectModel subject = quick_subject(1.2);
  subject.feature_noise = GENERATE(0.0, 0.4);
  const record::StudyStore store =
      simulated(study, subject, {.participants = 20, .seed = 11, .jobs = 2});
  // 500 trials: 99.9 % of binomial draws with p = 0.2 lie between 71 and 131.
  const Confusion confusion = confusion_of(store, study.key());
  const int correct = correct_of(confusion);
  CHECK(correct >= 71);
  CHECK(correct <= 131);
  // Nobody prefers a class either.
  for (int answered = 0; answered < 5; ++answered) {
    int times = 0;
    for (const auto& [cell, count] : confusion) times += cell.second == answered ? count : 0;
    CHECK(times >= 71);
    CHECK(times <= 131);
  }
  // 25 even draws among five: fewer than three different answers come once in 10^9, and one answer
  // 17 times or more once in 10^6.
  std::map<int, std::map<int, int>> answers;
  for (const record::TrialRow& row : opened_trials(store, study.key())) {
    ++answers[row.session][position_of(row.answer).value()];
  }
  REQUIRE(answers.size() == 20);
  for (const auto& [session, count] : answers) {
    INFO("session " << session);
    CHECK(count.size() >= 3);
    for (const auto& [position, times] : count) CHECK(times < 17);
  }
}

TEST_CASE("a label swap shows only in the confusions of its two classes") {
  TinyStudy study;
  simulation::SubjectModel subject = quick_subject();
  subject.label_swap = {{"bark", "straw"}};
  const Confusion confusion =
      confusion_of(simulated(study, subject, {.participants = 2, .seed = 3}), study.key());
  constexpr int kBark = 0;
  constexpr int kStraw = 3;
  const auto count = [&](int presented, int answered) {
    const auto found = confusion.find({presented, answered});
    return found == confusion.end() ? 0 : found->second;
  };
  CHECK(count(kBark, kStraw) >= 9);
  CHECK(count(kStraw, kBark) >= 9);
  CHECK(count(1, 1) + count(2, 2) + count(4, 4) >= 29);
}

TEST_CASE("more noise lowers the accuracy") {
  TinyStudy study;
  simulation::SubjectModel subject = quick_subject();
  std::vector<int> correct;
  for (const double feature_noise : {0.0, 1.0, 8.0}) {
    subject.feature_noise = feature_noise;
    correct.push_back(correct_of(confusion_of(
        simulated(study, subject, {.participants = 4, .seed = 3, .jobs = 2}), study.key())));
  }
  CHECK(correct[0] > correct[1]);
  CHECK(correct[1] > correct[2]);
}

TEST_CASE("answers do not depend on codes") {
  simulation::SubjectModel subject = quick_subject();
  subject.feature_noise = 1.0;
  TinyStudy study({.secret = 1, .schedules = 7});
  TinyStudy recoded({.secret = 2, .schedules = 7});
  CHECK(study.key().code_of({0, 0, 0}) != recoded.key().code_of({0, 0, 0}));
  const simulation::SimulationOptions options{.participants = 2, .seed = 5};
  CHECK(answers_of(simulated(study, subject, options), study.key()) ==
        answers_of(simulated(recoded, subject, options), recoded.key()));
}

TEST_CASE("the database is the same to the byte whatever the number of jobs") {
  simulation::SubjectModel subject = quick_subject(1.0);
  TinyStudy study;
  const record::StudyStore alone =
      simulated(study, subject, {.participants = 5, .seed = 8, .jobs = 1});
  const record::StudyStore crowd =
      simulated(study, subject, {.participants = 5, .seed = 8, .jobs = 4});
  for (int session = 0; session <= 5; ++session) {
    const std::vector<record::Event> a = alone.events(session);
    const std::vector<record::Event> b = crowd.events(session);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(a[i].hash == b[i].hash);
  }
  CHECK(alone.sealed_trace(5, 25) == crowd.sealed_trace(5, 25));
}

TEST_CASE("another seed gives other participants, and the same schedule") {
  simulation::SubjectModel subject = quick_subject(1.0);
  subject.feature_noise = 2.0;
  TinyStudy study;
  const record::StudyStore one = simulated(study, subject, {.participants = 1, .seed = 1});
  const record::StudyStore other = simulated(study, subject, {.participants = 1, .seed = 2});
  CHECK(answers_of(one, study.key()) != answers_of(other, study.key()));
  CHECK(schedule_of_session(one, study.key(), 1) == schedule_of_session(other, study.key(), 1));
}

/// An event's readable part, without its commitments to secrets.
nlohmann::json clear_part(const record::Event& event) {
  nlohmann::json body = nlohmann::json::parse(event.body);
  body.erase("trace");
  body.erase("one_key");  // of people who feel nothing, and have no noise
  return {{"kind", name_of(event.kind)},
          {"at", event.at.count()},
          {"body", body},
          {"sealed", event.sealed.size()}};
}

TEST_CASE("but for who presses one key, nothing in clear depends on what is presented") {
  simulation::SubjectModel subject = quick_subject();
  TinyStudy textured({.smooth = false});
  TinyStudy smooth({.smooth = true});
  const simulation::SimulationOptions options{.participants = 1, .seed = 21};
  const std::vector<record::Event> a = simulated(textured, subject, options).events(1);
  const std::vector<record::Event> b = simulated(smooth, subject, options).events(1);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(clear_part(a[i]) == clear_part(b[i]));
}

/// Trials whose forces are within limits, by their sealed measures.
int within_limits(const record::StudyStore& store, const study::StudyKey& key) {
  const auto participant_key =
      record::unwrap_participant_key(key.box(), 1, store.wrapped_key(1).value());
  int within = 0;
  store.for_each(record::EventKind::trace_stored, [&](const record::Event& event) {
    const record::TrialMeasures measures =
        record::measures_from_json(record::unsealed(event, participant_key.value()).value());
    within += measures.within_limits ? 1 : 0;
  });
  return within;
}

TEST_CASE("a force limit that some textures reach does not show in clear which ones do") {
  simulation::SubjectModel subject = quick_subject(6.0);
  subject.training_passes = 1;
  const std::string tight = R"({"max_force_n": 0.84})";
  TinyStudy textured({.rendering = tight});
  TinyStudy smooth({.smooth = true, .rendering = tight});
  const simulation::SimulationOptions options{.participants = 1, .seed = 21};
  const record::StudyStore limited = simulated(textured, subject, options);
  const record::StudyStore free = simulated(smooth, subject, options);
  CHECK(within_limits(limited, textured.key()) > 0);
  CHECK(within_limits(limited, textured.key()) < 25);
  CHECK(within_limits(free, smooth.key()) == 25);
  const std::vector<record::Event> a = limited.events(1);
  const std::vector<record::Event> b = free.events(1);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(clear_part(a[i]) == clear_part(b[i]));
  for (const record::TrialRow& row : limited.trials()) CHECK(row.valid);
}

TEST_CASE("participants who are added later are the same as if simulated at once") {
  simulation::SubjectModel subject = quick_subject(1.0);
  subject.feature_noise = 1.0;
  TinyStudy study;
  const record::StudyStore at_once = simulated(study, subject, {.participants = 3, .seed = 4});
  record::StudyStore in_two = simulated(study, subject, {.participants = 2, .seed = 4});
  const simulation::SimulationReport report =
      simulation::simulate_study(study.key(), study.pack(), subject,
                                 {.participants = 1, .seed = 4, .first_participant = 3}, in_two);
  CHECK(report.sessions == 1);
  CHECK(report.presentations == 25);
  CHECK(report.ticks == 25'000);
  CHECK(answers_of(at_once, study.key()) == answers_of(in_two, study.key()));
  CHECK(in_two.sessions().back().participant == "P003");
  CHECK_THROWS_AS(
      simulation::simulate_study(study.key(), study.pack(), subject, {.participants = 1}, in_two),
      StoreError);
}

TEST_CASE("a comparison presents every class by both methods, in blocks") {
  TinyStudy study({.images = 2, .comparison = true, .trials = R"({"repeats": 2})"});
  simulation::SubjectModel subject = quick_subject();
  const record::StudyStore store = simulated(study, subject, {.participants = 2, .seed = 6});
  CHECK(store.trials().size() == 40);
  CHECK(store.trials().back().block == 1);
  CHECK(correct_of(confusion_of(store, study.key())) >= 38);
}

TEST_CASE("an exploration beyond the limit times out, and the study says whether it is answered") {
  const bool fades = GENERATE(true, false);
  TinyStudy study({.trials = fades ? R"({"repeats": 1, "explore_limit_s": 0.8})"
                                   : R"({"repeats": 1, "explore_limit_s": 0.8,
                                         "on_timeout": "no-response"})"});
  const record::StudyStore store = simulated(study, quick_subject(), {.participants = 1});
  int timed_out = 0;
  store.for_each(record::EventKind::timed_out, [&](const record::Event&) { ++timed_out; });
  CHECK(timed_out == 5);
  for (const record::TrialRow& row : opened_trials(store, study.key())) {
    CHECK(position_of(row.answer).has_value() == fades);
    CHECK(row.samples == 900);
  }
  CHECK(store.sessions().front().state == record::SessionState::completed);
}

TEST_CASE("breaks are taken where the study wants them") {
  TinyStudy study({.trials = R"({"repeats": 2, "break_every": 4})"});
  simulation::SubjectModel subject = quick_subject(1.0);
  const record::StudyStore store = simulated(study, subject, {.participants = 1});
  int breaks = 0;
  store.for_each(record::EventKind::break_taken, [&](const record::Event&) { ++breaks; });
  CHECK(breaks == 2);
}

TEST_CASE("the measures of a simulated trial follow from the subject's strokes and push") {
  TinyStudy study({.trials = R"({"repeats": 1})"});
  simulation::SubjectModel subject = quick_subject(8.0);
  const record::StudyStore store = simulated(study, subject, {.participants = 1});
  const auto key =
      record::unwrap_participant_key(study.key().box(), 1, store.wrapped_key(1).value());
  store.for_each(record::EventKind::trace_stored, [&](const record::Event& event) {
    const record::TrialMeasures measures =
        record::measures_from_json(record::unsealed(event, key.value()).value());
    CHECK(measures.contact_s > 7.0);
    CHECK(measures.path_mm > 300.0);
    CHECK(measures.force_rms_n > 0.6);
    CHECK(measures.force_rms_n < 1.0);
    CHECK(measures.saturated_share == 0.0);
  });
  for (const record::TrialRow& row : store.trials()) CHECK(row.valid);
}

TEST_CASE("short explorations are invalid trials, unless the study's rule says otherwise") {
  const bool own_rule = GENERATE(false, true);
  TinyStudy study({.trials = own_rule ? R"({"repeats": 1, "validity": {"exploring_s": 0,
                                            "contact_s": 0, "path_mm": 0, "least_median_n": 0,
                                            "largest_median_n": 100, "saturated_share": 1}})"
                                      : R"({"repeats": 1})"});
  const record::StudyStore store = simulated(study, quick_subject(), {.participants = 1});
  for (const record::TrialRow& row : store.trials()) CHECK(row.valid == own_rule);
}

TEST_CASE("progress counts sessions") {
  TinyStudy study({.trials = R"({"repeats": 1})"});
  simulation::SubjectModel subject = quick_subject(1.0);
  record::StudyStore store = empty_store(study);
  std::vector<std::pair<int, int>> seen;
  simulation::simulate_study(study.key(), study.pack(), subject, {.participants = 3, .jobs = 2},
                             store, [&](int done, int of) { seen.emplace_back(done, of); });
  CHECK(seen == std::vector<std::pair<int, int>>{{1, 3}, {2, 3}, {3, 3}});
}

TEST_CASE("a simulation refuses options and subjects that do not fit") {
  TinyStudy study;
  record::StudyStore store = empty_store(study);
  const auto simulate = [&](const simulation::SubjectModel& subject,
                            const simulation::SimulationOptions& options) {
    return simulation::simulate_study(study.key(), study.pack(), subject, options, store);
  };
  CHECK_THROWS_AS(simulate({}, {.participants = 0}), std::invalid_argument);
  CHECK_THROWS_AS(simulate({}, {.jobs = 0}), std::invalid_argument);
  CHECK_THROWS_AS(simulate({}, {.first_participant = 0}), std::invalid_argument);
  simulation::SubjectModel stranger{.label_swap = {{"bark", "velvet"}}};
  CHECK_THROWS_AS(simulate(stranger, {}), StudyError);
  CHECK(store.sessions().empty());
}

TEST_CASE("a commitment identifies the study and reveals nothing of its stimuli") {
  const TinyStudy study;
  const record::StudyCommitment commitment =
      session::commitment_of(study.key(), study.pack(), true, false);
  CHECK(commitment.study == "tiny");
  CHECK(commitment.protocol == "classification");
  CHECK(commitment.scored_trials == 25);
  CHECK(commitment.positions == 5);
  CHECK(commitment.seal == study::study_seal(study.key()));
  CHECK(commitment.pack == study.pack().digest());
  CHECK(commitment.simulated);
  for (const char* label : {"bark", "cloth", "pebbles", "straw", "brick"}) {
    CHECK(commitment.configuration.find(label) == std::string::npos);
  }
}

}  // namespace
}  // namespace touchtrial
