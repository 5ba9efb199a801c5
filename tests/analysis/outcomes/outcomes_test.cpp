#include "analysis/outcomes/outcomes.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

int counted(const analysis::Outcomes& outcomes) {
  return static_cast<int>(
      std::count_if(outcomes.trials.begin(), outcomes.trials.end(),
                    [](const analysis::TrialOutcome& trial) { return trial.counted; }));
}

}  // namespace

TEST_CASE("load_outcomes turns positions back into the classes that were meant") {
  FakeStudy study(study::identification::comparison());
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::confusing(0, 2)});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::confusing(0, 2)});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(outcomes.classes == std::vector<std::string>{"bark", "cloth", "straw"});
  CHECK(outcomes.methods == std::vector<std::string>{"adaptive", "tv-gabor"});
  CHECK(outcomes.exemplars[0] == std::vector<std::string>{"first.png"});
  CHECK(outcomes.simulated);
  REQUIRE(outcomes.trials.size() == 48);
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    const int presented = trial.stimulus.class_index;
    CHECK(trial.response == (presented == 0 ? 2 : presented));
    CHECK(trial.correct() == (presented != 0));
    CHECK(trial.counted);
    REQUIRE(trial.measures.has_value());
    CHECK(trial.measures->saturated_share == 0.001 * trial.row.trial);
  }
}

TEST_CASE("A trial without a response counts and is wrong") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .answers = [](const study::Trial& shown) {
               return shown.place.trial == 3 ? std::nullopt
                                             : std::optional(shown.field().class_index);
             }});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(counted(outcomes) == 12);
  const analysis::TrialOutcome& third = outcomes.trials[2];
  CHECK(third.row.state == record::TrialState::timed_out);
  CHECK(third.counted);
  CHECK_FALSE(third.response.has_value());
  CHECK_FALSE(third.correct());
}

TEST_CASE("An interrupted and repeated trial counts once, by its repetition") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .interrupt_trial = 5});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(outcomes.trials.size() == 12);
  CHECK(counted(outcomes) == 12);
  CHECK(outcomes.trials[4].correct());
  CHECK(outcomes.trials[4].row.presented_at == std::chrono::seconds(130));
}

TEST_CASE("Sessions that were stopped do not count") {
  FakeStudy study(study::identification::classification());
  const FakeAnswers right = FakeStudy::always_right();
  study.add({.participant = "P01", .enrolment = 1, .answers = right});
  study.add(
      {.participant = "P02", .enrolment = 2, .answers = right, .complete = false, .stop_after = 4});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(outcomes.trials.size() == 12 + 4);
  CHECK(counted(outcomes) == 12);
  REQUIRE(outcomes.sessions.size() == 2);
  CHECK(outcomes.sessions[0].counted);
  CHECK_FALSE(outcomes.sessions[1].counted);
}

TEST_CASE("Excluded, erased and foreign sessions do not count") {
  record::StudyCommitment real;
  record::SessionRow row;
  row.state = record::SessionState::completed;
  CHECK(analysis::session_counts(row, real));
  for (bool record::SessionRow::*mark :
       {&record::SessionRow::excluded, &record::SessionRow::erased, &record::SessionRow::pilot,
        &record::SessionRow::simulated}) {
    record::SessionRow marked = row;
    marked.*mark = true;
    CHECK_FALSE(analysis::session_counts(marked, real));
  }
  record::StudyCommitment pilot;
  pilot.pilot = true;
  CHECK_FALSE(analysis::session_counts(row, pilot));
  row.pilot = true;
  CHECK(analysis::session_counts(row, pilot));
}

TEST_CASE("A look at one participant shows that participant's sessions alone") {
  FakeStudy study(study::identification::classification());
  for (const char* const participant : {"P01", "P02"}) {
    study.add({.participant = participant, .enrolment = participant[2] - '0'});
  }
  record::StudyStore& store = study.store();
  CHECK_THROWS_WITH(analysis::load_outcomes(store, study.key(), "P01"),
                    names("unblind --participant P01"));
  store.look_at("P01", std::chrono::milliseconds(10), "asked for the data");
  CHECK(analysis::load_outcomes(store, study.key(), "P01").trials.size() == 12);
  CHECK(analysis::load_outcomes(store, study.key(), "P01").sessions.size() == 1);
  CHECK_THROWS_AS(analysis::load_outcomes(store, study.key(), "P02"), StoreError);
  CHECK_THROWS_AS(analysis::load_outcomes(store, study.key()), StoreError);
  REQUIRE(analysis::load_collection(store).looks.size() == 1);
  CHECK(analysis::load_collection(store).looks[0].reason == "asked for the data");
  study.close_and_unblind();
  CHECK(analysis::load_outcomes(store, study.key()).sessions.size() == 2);
  CHECK(analysis::load_outcomes(store, study.key(), "P02").sessions.size() == 1);
}

TEST_CASE("load_outcomes keeps outcomes shut until the study is unblinded") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  CHECK_THROWS_AS(analysis::load_outcomes(study.store(), study.key()), StoreError);
  study.close_and_unblind();
  CHECK(analysis::load_outcomes(study.store(), study.key()).trials.size() == 12);
}

TEST_CASE("load_outcomes names the key that does not belong") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01"});
  study.close_and_unblind();

  SeededEntropy other(12);
  const study::StudyKey foreign = study::make_study_key(study.key().study, other, true);
  const std::string complaint = message_of<VerificationError>(
      [&] { static_cast<void>(analysis::load_outcomes(study.store(), foreign)); });
  CHECK(contains(complaint, foreign.study_id));
  CHECK(contains(complaint, study.key().study_id));

  const study::Study renamed = study::parse_study(
      fake_study_text(study::identification::classification(), "brick"), ".", "x");
  const study::StudyKey changed = study::rekeyed(study.key(), renamed);
  CHECK(contains(message_of<VerificationError>(
                     [&] { static_cast<void>(analysis::load_outcomes(study.store(), changed)); }),
                 "seal"));
}

TEST_CASE("An interim look shows only sessions that had ended before it") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.store().unblind(std::chrono::seconds(1), "safety", true);
  study.add({.participant = "P02", .enrolment = 2});
  const analysis::Outcomes interim = analysis::load_outcomes(study.store(), study.key());
  CHECK(interim.sessions.size() == 1);
  CHECK(interim.sessions_unseen == 1);
  CHECK(counted(interim) == 12);
  study.close_and_unblind();
  const analysis::Outcomes all = analysis::load_outcomes(study.store(), study.key());
  CHECK(all.sessions.size() == 2);
  CHECK(all.sessions_unseen == 0);
  CHECK(counted(all) == 24);
}

}  // namespace touchtrial
