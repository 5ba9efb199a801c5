#include "analysis/fake_study.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/verification/verification.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace analysis;
using std::chrono::milliseconds;
using std::chrono::seconds;

const Check& schedule_check(const Verification& verification) {
  return *std::find_if(verification.checks.begin(), verification.checks.end(),
                       [](const Check& check) { return check.name == "schedule"; });
}

const FakeOptions kRestarting{.trials = R"({"on_interruption": "restart-block"})"};

/// A session whose only block is restarted because its second trial is interrupted.
class RestartedSession {
 public:
  explicit RestartedSession(FakeStudy& study)
      : key_(study.key()),
        recorder_(1, own_, events_),
        begun_(study::make_schedule(key_.study, key_.draw_of(1, study::Draws::rehearsal))) {}

  /// \param restarts_before  0 for the order that the design gives
  void record(FakeStudy& study, int restarts_before, bool old_number_again = false) {
    record::SessionOpening opening{.participant = "P01",
                                   .enrolment = 1,
                                   .study_id = key_.study_id,
                                   .seal = study::study_seal(key_),
                                   .device = "simulated",
                                   .simulated = true};
    recorder_.opened(milliseconds(0), opening, study::schedule_to_json(begun_, key_));
    answer(1);
    recorder_.presented(at_ += seconds(1), 2, 0);
    recorder_.interrupted(at_, 2, "comfort stop");
    const int first = static_cast<int>(begun_.trials.size()) + 1;
    const auto again = study::make_order(key_.study, key_.draw_of(1, study::Draws::rehearsal))
                           ->redraw_block(0, restarts_before, first);
    recorder_.block_restarted(at_, 0, first, study::block_to_json(again, key_));
    for (const study::Trial& one : again) answer(one.place.trial);
    if (old_number_again) answer(3);
    recorder_.closed(at_, true);
    study.store().add_session(events_, record::wrap_participant_key(key_.investigator_box, 1, own_),
                              milliseconds(1));
  }

 private:
  void answer(int trial) {
    at_ += seconds(10);
    recorder_.presented(at_, trial, 0);
    recorder_.answered(at_, {trial, ChoiceAnswer{0}, std::nullopt});
  }

  const study::StudyKey& key_;
  SecretKey own_ = sha256(bytes_of("participant"));
  record::BufferedEvents events_;
  record::SessionRecorder recorder_;
  study::Schedule begun_;
  milliseconds at_{0};
};

}  // namespace

TEST_CASE("verify_study compares a restarted block with the order that the design gives it") {
  FakeStudy study(kRestarting);
  RestartedSession(study).record(study, 0);
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  INFO(schedule_check(verification).detail);
  CHECK(schedule_check(verification).state == CheckState::passed);
  CHECK(verification.holds());
}

TEST_CASE("verify_study finds another order of a restarted block") {
  FakeStudy study(kRestarting);
  RestartedSession(study).record(study, 1);
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  CHECK(schedule_check(verification).state == CheckState::failed);
}

TEST_CASE("verify_study finds an old number that came after its block was restarted") {
  FakeStudy study(kRestarting);
  RestartedSession(study).record(study, 0, true);
  const Verification verification = analysis::verify_study(study.store(), &study.key(), nullptr);
  CHECK(names(schedule_check(verification).detail, "1 3"));
}

TEST_CASE("outcomes hold a restarted block's trials and count no voided one") {
  FakeStudy study(kRestarting);
  RestartedSession(study).record(study, 0);
  study.close_and_unblind();
  const Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const auto counted = std::count_if(outcomes.trials.begin(), outcomes.trials.end(),
                                     [](const TrialOutcome& trial) { return trial.counted; });
  CHECK(counted == study.store().commitment().scored_trials);
  CHECK(outcomes.trials.front().row.state == record::TrialState::voided);
  CHECK_FALSE(outcomes.trials.front().counted);
}

TEST_CASE("a participant who was replaced enters no outcomes, but stays in the list") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.store().exclude(1, milliseconds(2), "did not follow the instructions");
  study.store().replace(1, "P02", milliseconds(3), "place is wanted");
  study.add({.participant = "P02", .enrolment = 1});
  CHECK(analysis::verify_study(study.store(), &study.key(), nullptr).holds());
  study.close_and_unblind();
  const Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  REQUIRE(outcomes.sessions.size() == 2);
  CHECK_FALSE(outcomes.sessions[0].counted);
  CHECK(outcomes.sessions[1].counted);
}

}  // namespace touchtrial
