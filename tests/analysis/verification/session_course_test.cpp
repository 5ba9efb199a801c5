// Faults in a session's events that verification finds and no chain shows: presentations that were
// not due. Sessions are recorded with the participant's key, so that chains and seals hold.
#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/verification/verification.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <string>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// One session of enrolment 1 whose events a test chooses.
class ToldSession {
 public:
  explicit ToldSession(FakeStudy& study)
      : study_(study),
        recorder_(1, own_, events_),
        schedule_(design::make_schedule(study.key().study,
                                        study.key().draw_of(1, design::Draws::rehearsal))) {}

  /// Opens with a schedule that may have been tampered with.
  void open(const design::Schedule& schedule) {
    store::SessionOpening opening;
    opening.participant = "P01";
    opening.enrolment = 1;
    opening.study_id = study_.key().study_id;
    opening.seal = design::study_seal(study_.key());
    opening.device = "simulated";
    opening.simulated = true;
    recorder_.opened(at_, opening, design::schedule_to_json(schedule, study_.key()));
  }
  void open() { open(schedule_); }
  void present(int trial) { recorder_.presented(later(), trial, 0); }
  void answer(int trial) { recorder_.answered(later(), {trial, 0, std::nullopt, std::nullopt}); }
  void show(int trial) {
    present(trial);
    answer(trial);
  }
  /// Records all trials from this one on, except one.
  void show_from(int trial, int left_out = 0) {
    for (; trial <= count(); ++trial) {
      if (trial != left_out) show(trial);
    }
  }
  void interrupt(int trial) { recorder_.interrupted(later(), trial, "comfort stop"); }
  void resume(const std::string& after, double away_s) {
    recorder_.resumed(later(), {.after = after, .away_s = away_s});
  }
  void pause() { recorder_.paused(later(), {}); }

  void restart_block() {
    const design::StudyKey& key = study_.key();
    const auto again = design::restarted_block(key.study, key.draw_of(1, design::Draws::rehearsal),
                                               0, 0, count() + 1);
    recorder_.block_restarted(later(), 0, count() + 1, design::block_to_json(again, key));
  }

  /// Closes the session as complete.
  /// \return the check of the schedule; all other checks pass
  analysis::Check verified() {
    recorder_.closed(later(), true);
    study_.store().add_session(
        events_, store::wrap_participant_key(study_.key().investigator_box, 1, own_), at_);
    const analysis::Verification verification =
        analysis::verify_study(study_.store(), &study_.key(), nullptr);
    analysis::Check schedule;
    for (const analysis::Check& check : verification.checks) {
      if (check.name == "schedule") schedule = check;
      INFO(check.name << ": " << check.detail);
      if (check.name != "schedule") CHECK(check.state != analysis::CheckState::failed);
    }
    return schedule;
  }
  /// The message with which the check of the schedule fails.
  std::string fault() {
    const analysis::Check check = verified();
    CHECK(check.state == analysis::CheckState::failed);
    return check.detail;
  }

  [[nodiscard]] design::Schedule schedule() const { return schedule_; }
  [[nodiscard]] int count() const { return static_cast<int>(schedule_.presentations.size()); }
  [[nodiscard]] int catch_trial() const {
    const auto& all = schedule_.presentations;
    return std::find_if(all.begin(), all.end(),
                        [](const design::Presentation& one) {
                          return one.kind == design::PresentationKind::catch_trial;
                        })
        ->trial;
  }

 private:
  milliseconds later() { return at_ += seconds(1); }

  FakeStudy& study_;
  SecretKey own_ = sha256(bytes_of("participant"));
  store::BufferedEvents events_;
  store::SessionRecorder recorder_;
  design::Schedule schedule_;
  milliseconds at_{0};
};

const FakeOptions kCatching{.trials = R"({"catch": 2})"};
const FakeOptions kLeavingOut{.trials = R"({"on_interruption": "leave-out"})"};

/// A told session of a study with these options, opened as it should be.
struct Told {
  explicit Told(const FakeOptions& options = {})
      : study(design::identification::classification(), options) {}
  FakeStudy study;
  ToldSession session{study};
};

}  // namespace

TEST_CASE("verify_study accepts catch trials in their places, and nothing else there") {
  {
    Told told(kCatching);
    told.session.open();
    told.session.show_from(1);
    const analysis::Check check = told.session.verified();
    INFO(check.detail);
    CHECK(check.state == analysis::CheckState::passed);
    CHECK(contains(check.detail, "14 presentations where they were due"));
  }
  {
    Told told(kCatching);
    const int trial = told.session.catch_trial();
    told.session.open();
    for (int i = 1; i < trial; ++i) told.session.show(i);
    told.session.show_from(trial + 1);
    CHECK(contains(told.session.fault(), "was presented where trial " + std::to_string(trial)));
  }
  {
    Told told(kCatching);
    design::Schedule tampered = told.session.schedule();
    for (design::Presentation& one : tampered.presentations) {
      if (one.trial != told.session.catch_trial()) continue;
      one.kind = design::PresentationKind::scored;
      one.stimulus = tampered.presentations.front().stimulus;
    }
    told.session.open(tampered);
    told.session.show_from(1);
    CHECK(contains(told.session.fault(), "session 1: the schedule is not the one"));
  }
}

TEST_CASE("verify_study checks the study's policy of repeating interrupted trials") {
  {
    Told told;
    told.session.open();
    told.session.show(1);
    told.session.present(2);
    told.session.interrupt(2);
    told.session.show_from(3);
    told.session.show(2);
    CHECK(told.session.verified().state == analysis::CheckState::passed);
  }
  {
    Told told;
    told.session.open();
    told.session.present(1);
    told.session.interrupt(1);
    told.session.show_from(2);
    CHECK(contains(told.session.fault(),
                   "session 1, trial 1: the session is complete, but this trial was still due"));
  }
  {
    Told told;
    told.session.open();
    told.session.present(1);
    told.session.interrupt(1);
    told.session.show(1);
    told.session.show_from(2);
    CHECK(
        contains(told.session.fault(), "session 1, trial 1: was presented where trial 2 was due"));
  }
}

TEST_CASE("verify_study checks the study's policy of leaving out interrupted trials") {
  {
    Told told(kLeavingOut);
    told.session.open();
    told.session.present(1);
    told.session.interrupt(1);
    told.session.show_from(2);
    CHECK(told.session.verified().state == analysis::CheckState::passed);
  }
  {
    Told told(kLeavingOut);
    told.session.open();
    told.session.present(1);
    told.session.interrupt(1);
    told.session.show_from(2);
    told.session.show(1);
    CHECK(
        contains(told.session.fault(), "session 1, trial 1: was presented after all that was due"));
  }
  {
    Told told(kLeavingOut);
    told.session.open();
    told.session.show_from(1, 5);  // left out although it was not interrupted
    CHECK(
        contains(told.session.fault(), "session 1, trial 6: was presented where trial 5 was due"));
  }
}

TEST_CASE("verify_study accepts resumed sessions, and names events that cannot follow") {
  {
    Told told;
    told.session.open();
    told.session.show(1);
    told.session.present(2);
    told.session.resume("program-ended", 90.0);
    told.session.interrupt(2);
    told.session.pause();
    told.session.resume("pause", 1.0);
    told.session.show_from(3);
    told.session.show(2);
    const analysis::Check check = told.session.verified();
    INFO(check.detail);
    CHECK(check.state == analysis::CheckState::passed);
  }
  {
    Told told;
    told.session.open();
    told.session.present(1);
    told.session.resume("program-ended", 90.0);
    told.session.answer(1);
    told.session.show_from(2);
    CHECK(contains(told.session.fault(),
                   "session 1, trial 1: answered although the program had ended during it"));
  }
  {
    Told told;
    told.session.open();
    told.session.show(1);
    told.session.resume("program-ended", 25.0 * 3600.0);
    told.session.show_from(2);
    CHECK(
        contains(told.session.fault(), "session 1, event 3: the session was resumed after 25.0 h"));
  }
  {
    Told told;
    told.session.open();
    told.session.show(1);
    told.session.resume("pause", 1.0);
    told.session.show_from(2);
    CHECK(contains(told.session.fault(), "the session was resumed, but not paused"));
  }
  {
    Told told;
    told.session.open();
    told.session.pause();
    told.session.show_from(1);
    CHECK(contains(told.session.fault(),
                   "session 1, trial 1: was presented while the session was paused"));
  }
}

TEST_CASE(
    "verify_study names presentations without an end, and blocks restarted without a reason") {
  {
    Told told;
    told.session.open();
    told.session.present(1);
    told.session.show_from(2);
    CHECK(contains(told.session.fault(),
                   "session 1, trial 2: was presented while trial 1 was under way"));
  }
  {
    Told told;
    told.session.open();
    told.session.show(1);
    told.session.restart_block();
    CHECK(contains(told.session.fault(),
                   "session 1, event 3: block 0 was restarted, but nothing in it was interrupted"));
  }
}

}  // namespace touchtrial
