#include "analysis/outcomes.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/session_rules.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"

#include <algorithm>

#include <SQLiteCpp/Database.h>

namespace touchtrial {
namespace {

int counted(const Outcomes& outcomes) {
  return static_cast<int>(std::count_if(outcomes.trials.begin(), outcomes.trials.end(),
                                        [](const TrialOutcome& trial) { return trial.counted; }));
}

}  // namespace

TEST_CASE("load_outcomes turns positions back into the classes that were meant") {
  FakeStudy study(Protocol::comparison);
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::confusing(0, 2)});
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::confusing(0, 2)});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  CHECK(outcomes.classes == std::vector<std::string>{"bark", "cloth", "straw"});
  CHECK(outcomes.methods == std::vector<std::string>{"adaptive", "tv-gabor"});
  CHECK(outcomes.exemplars[0] == std::vector<std::string>{"first.png"});
  CHECK(outcomes.simulated);
  REQUIRE(outcomes.trials.size() == 48);
  for (const TrialOutcome& trial : outcomes.trials) {
    const int presented = trial.stimulus.class_index;
    CHECK(trial.response == (presented == 0 ? 2 : presented));
    CHECK(trial.correct() == (presented != 0));
    CHECK(trial.counted);
    REQUIRE(trial.measures.has_value());
    CHECK(trial.measures->saturated_share == 0.001 * trial.row.trial);
  }
}

TEST_CASE("A trial without a response counts and is wrong") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = [](const Presentation& shown) {
               return shown.trial == 3 ? std::nullopt : std::optional(shown.stimulus.class_index);
             }});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  CHECK(counted(outcomes) == 12);
  const TrialOutcome& third = outcomes.trials[2];
  CHECK(third.row.state == TrialState::timed_out);
  CHECK(third.counted);
  CHECK_FALSE(third.response.has_value());
  CHECK_FALSE(third.correct());
}

TEST_CASE("Of a trial that was interrupted and repeated the repetition counts once") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right(), .interrupt_trial = 5});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  CHECK(outcomes.trials.size() == 12);
  CHECK(counted(outcomes) == 12);
  CHECK(outcomes.trials[4].correct());
  CHECK(outcomes.trials[4].row.presented_at == std::chrono::seconds(130));
}

TEST_CASE("Sessions that were stopped do not count") {
  FakeStudy study(Protocol::classification);
  const FakeAnswers right = FakeStudy::always_right();
  study.add({.participant = "P01", .enrolment = 1, .answers = right});
  study.add(
      {.participant = "P02", .enrolment = 2, .answers = right, .complete = false, .stop_after = 4});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  CHECK(outcomes.trials.size() == 12 + 4);
  CHECK(counted(outcomes) == 12);
  REQUIRE(outcomes.sessions.size() == 2);
  CHECK(outcomes.sessions[0].counted);
  CHECK_FALSE(outcomes.sessions[1].counted);
}

TEST_CASE("Excluded, withdrawn and foreign sessions do not count") {
  StudyCommitment real;
  SessionRow row;
  row.state = SessionState::completed;
  CHECK(session_counts(row, real));
  for (bool SessionRow::*mark : {&SessionRow::excluded, &SessionRow::withdrawn, &SessionRow::pilot,
                                 &SessionRow::simulated}) {
    SessionRow marked = row;
    marked.*mark = true;
    CHECK_FALSE(session_counts(marked, real));
  }
  StudyCommitment pilot;
  pilot.pilot = true;
  CHECK_FALSE(session_counts(row, pilot));
  row.pilot = true;
  CHECK(session_counts(row, pilot));
}

TEST_CASE("load_outcomes keeps outcomes shut until the study is unblinded") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  CHECK_THROWS_AS(load_outcomes(study.store(), study.key()), StoreError);
  study.close_and_unblind();
  CHECK(load_outcomes(study.store(), study.key()).trials.size() == 12);
}

TEST_CASE("load_outcomes names the key that does not belong") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  study.close_and_unblind();

  SeededEntropy other(12);
  const StudyKey foreign = make_study_key(study.key().study, other, true);
  const std::string complaint = complaint_of<VerificationError>(
      [&] { static_cast<void>(load_outcomes(study.store(), foreign)); });
  CHECK(contains(complaint, foreign.study_id));
  CHECK(contains(complaint, study.key().study_id));

  const Study renamed = parse_study(fake_study_text(Protocol::classification, "brick"), ".", "x");
  const StudyKey changed = rekeyed(study.key(), renamed);
  CHECK(contains(complaint_of<VerificationError>(
                     [&] { static_cast<void>(load_outcomes(study.store(), changed)); }),
                 "seal"));
}

TEST_CASE("Outcomes are not shown of tables that the events do not give rise to") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right()});
  study.close_and_unblind();
  SQLite::Database(study.database().string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE responses SET position = (position + 1) % 3");
  const std::string complaint = complaint_of<VerificationError>(
      [&] { static_cast<void>(load_outcomes(study.store(), study.key())); });
  CHECK(contains(complaint, "session 1"));
  CHECK(contains(complaint, "responses"));
  CHECK(contains(complaint, "restore"));
}

TEST_CASE("An interim look shows only sessions that had ended before it") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  study.store().unblind(std::chrono::seconds(1), "safety", true);
  study.add({.participant = "P02", .enrolment = 2, .answers = FakeStudy::always_right()});
  const Outcomes interim = load_outcomes(study.store(), study.key());
  CHECK(interim.sessions.size() == 1);
  CHECK(interim.sessions_unseen == 1);
  CHECK(counted(interim) == 12);
  study.close_and_unblind();
  const Outcomes all = load_outcomes(study.store(), study.key());
  CHECK(all.sessions.size() == 2);
  CHECK(all.sessions_unseen == 0);
  CHECK(counted(all) == 24);
}

}  // namespace touchtrial
