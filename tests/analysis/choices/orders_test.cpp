#include "analysis/choices/orders.hpp"

#include "analysis/fake_study.hpp"
#include "core/random.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace choices;

/// Whether a participant answers right, or without regard to what was felt.
enum class Sense { everything, nothing };

study::Study study_with(const std::string& trials) {
  auto text =
      nlohmann::json::parse(fake_study_text(study::identification::classification(), "bark"));
  text["trials"].update(nlohmann::json::parse(trials));
  return study::parse_study(text.dump(), ".", "fake.json");
}

void add_session(analysis::Outcomes& outcomes, int session, Sense sense, RandomStream& random) {
  SeededEntropy entropy(static_cast<std::uint64_t>(session));
  const study::ScheduleDraw draw{entropy.secret("schedule"), session};
  for (const study::Trial& shown : study::make_schedule(outcomes.design, draw).trials) {
    analysis::TrialOutcome trial;
    trial.row.session = session;
    trial.row.trial = shown.place.trial;
    trial.row.block = shown.place.block;
    trial.row.state = record::TrialState::answered;
    trial.stimulus = shown.field();
    trial.role = shown.role;
    trial.has_stimulus = shown.role != study::Role::catch_trial;
    trial.scored = shown.role == study::Role::scored;
    trial.counted = trial.scored;
    const auto guess = static_cast<int>(random.below(outcomes.classes.size()));
    trial.response = sense == Sense::everything ? shown.field().class_index : guess;
    outcomes.trials.push_back(trial);
  }
}

analysis::Outcomes outcomes_of(const study::Study& study, Sense sense, int participants,
                               std::uint64_t index) {
  analysis::Outcomes outcomes;
  outcomes.design = study;
  outcomes.classes = {"bark", "cloth", "straw"};
  outcomes.methods = {"adaptive"};
  RandomStream random(3, "chance of study: guesses", index);
  for (int i = 1; i <= participants; ++i) add_session(outcomes, i, sense, random);
  return outcomes;
}

constexpr const char* kRules[] = {R"({"order": "de-bruijn", "repeats": 3})",
                                  R"({"order": "williams", "repeats": 4})",
                                  R"({"max_run": 1, "repeats": 4})"};

}  // namespace

TEST_CASE("The order of a study says how chance is dealt") {
  CHECK(order_rule_of(study_with("{}")) == analysis::OrderRule::permuted);
  CHECK(order_rule_of(study_with(R"({"order": "uniform"})")) == analysis::OrderRule::independent);
  for (const char* rule : kRules)
    CHECK(order_rule_of(study_with(rule)) == analysis::OrderRule::redrawn);
}

TEST_CASE("What came before is expected by the study's own rule") {
  // Without repetitions the class before is one of the two that a wrong answer can name.
  const analysis::Outcomes limited =
      outcomes_of(study_with(R"({"max_run": 1, "repeats": 4})"), Sense::nothing, 40, 0);
  const auto found = order_effects_of(limited, 0);
  REQUIRE(found);
  REQUIRE(found->class_before.wrong > 250);
  CHECK(found->class_before.expected / found->class_before.wrong == Approx(0.5).margin(0.03));
  // Of any order, 4 of the 11 other presentations are of that class.
  const auto free =
      order_effects_of(outcomes_of(study_with(R"({"repeats": 4})"), Sense::nothing, 40, 0), 0);
  CHECK(free->class_before.expected / free->class_before.wrong == Approx(4.0 / 11.0).margin(0.03));
}

TEST_CASE("Guesses are above chance no more often than p says, whatever the order") {
  constexpr int kStudies = 30;
  for (const char* rule : kRules) {
    CAPTURE(rule);
    const study::Study study = study_with(rule);
    int significant = 0;
    double sum = 0.0;
    for (int i = 0; i < kStudies; ++i) {
      const auto test = chance_test_of(outcomes_of(study, Sense::nothing, 2, i), 0);
      REQUIRE(test);
      CHECK_FALSE(test->exact);
      significant += test->p <= 0.05 ? 1 : 0;
      sum += test->p;
    }
    CHECK(significant <= 5);  // binomial(30, 0.05): more in 0.3 % of runs
    CHECK(sum / kStudies > 0.4);
    CHECK(sum / kStudies < 0.7);  // p of counts are above 0.5 on average
  }
}

TEST_CASE("Answers that are all right are as far above chance as deals can show") {
  for (const char* rule : kRules) {
    CAPTURE(rule);
    const analysis::Outcomes outcomes = outcomes_of(study_with(rule), Sense::everything, 4, 0);
    const auto test = chance_test_of(outcomes, 0);
    REQUIRE(test);
    CHECK(test->correct == test->trials);
    CHECK(test->p == Approx(1.0 / (test->deals + 1.0)));
    CHECK(test->expected == Approx(test->trials / 3.0).epsilon(0.05));
  }
}

TEST_CASE("Trials that do not count leave the places of the others as they are") {
  analysis::Outcomes outcomes = outcomes_of(study_with(kRules[0]), Sense::everything, 3, 0);
  const int all = chance_test_of(outcomes, 0)->trials;
  for (analysis::TrialOutcome& trial : outcomes.trials) {
    if (trial.scored && trial.row.trial % 3 == 0) trial.counted = false;
  }
  const auto test = chance_test_of(outcomes, 0);
  REQUIRE(test);
  CHECK(test->trials < all);
  CHECK(test->correct == test->trials);
  CHECK_FALSE(test->exact);
}

TEST_CASE("A restarted block is dealt as one, without its void presentations") {
  analysis::Outcomes outcomes = outcomes_of(study_with(kRules[1]), Sense::everything, 2, 0);
  const int all = chance_test_of(outcomes, 0)->trials;
  std::vector<analysis::TrialOutcome> again = outcomes.trials;
  for (analysis::TrialOutcome& trial : again) {
    trial.row.state = record::TrialState::voided;
    trial.counted = false;
  }
  outcomes.trials.insert(outcomes.trials.begin(), again.begin(), again.end());
  const auto test = chance_test_of(outcomes, 0);
  REQUIRE(test);
  CHECK(test->trials == all);
  CHECK_FALSE(test->exact);
}

TEST_CASE("A longer course than the study's is dealt without its rule") {
  analysis::Outcomes outcomes = outcomes_of(study_with(kRules[0]), Sense::everything, 2, 0);
  const std::vector<analysis::TrialOutcome> again = outcomes.trials;
  outcomes.trials.insert(outcomes.trials.end(), again.begin(), again.end());
  const auto test = chance_test_of(outcomes, 0);
  REQUIRE(test);
  CHECK(test->exact);
}

TEST_CASE("The chance test of the same outcomes is the same") {
  const analysis::Outcomes outcomes = outcomes_of(study_with(kRules[0]), Sense::nothing, 2, 9);
  CHECK(chance_test_of(outcomes, 0)->p == chance_test_of(outcomes, 0)->p);
}

}  // namespace touchtrial
