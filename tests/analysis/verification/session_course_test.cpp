// Faults in a session's events that verification finds and no chain shows: presentations that were
// not due. Sessions are recorded with the participant's key, so that chains and seals hold.
#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "analysis/verification/verification.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

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
        schedule_(study::make_schedule(study.key().study,
                                       study.key().draw_of(1, study::Draws::rehearsal))) {}

  /// Opens with a schedule that may have been tampered with.
  ToldSession& open(const study::Schedule& schedule) {
    record::SessionOpening opening{.participant = "P01",
                                   .enrolment = 1,
                                   .study_id = study_.key().study_id,
                                   .seal = study::study_seal(study_.key()),
                                   .device = "simulated",
                                   .simulated = true};
    recorder_.opened(at_, opening, study::schedule_to_json(schedule, study_.key()));
    return *this;
  }
  ToldSession& open() { return open(schedule_); }
  ToldSession& present(int trial) {
    recorder_.presented(later(), trial, 0);
    return *this;
  }
  ToldSession& answer(int trial) {
    recorder_.answered(later(), {trial, ChoiceAnswer{0}, std::nullopt});
    return *this;
  }
  ToldSession& show(int trial) { return present(trial).answer(trial); }
  /// Records all trials from this one on, except one.
  ToldSession& show_from(int trial, int left_out = 0) {
    for (; trial <= count(); ++trial) {
      if (trial != left_out) show(trial);
    }
    return *this;
  }
  ToldSession& interrupt(int trial) {
    recorder_.interrupted(later(), trial, "comfort stop");
    return *this;
  }
  ToldSession& resume(const std::string& after, double away_s) {
    recorder_.add(later(), record::EventKind::resumed,
                  record::ResumedBody{.after = after, .away_s = away_s});
    return *this;
  }
  ToldSession& pause() {
    recorder_.add(later(), record::EventKind::paused, record::PauseBody{});
    return *this;
  }
  ToldSession& restart_block() {
    const study::StudyKey& key = study_.key();
    const auto again = study::make_order(key.study, key.draw_of(1, study::Draws::rehearsal))
                           ->redraw_block(0, 0, count() + 1);
    recorder_.block_restarted(later(), 0, count() + 1, study::block_to_json(again, key));
    return *this;
  }

  /// Closes the session as complete.
  /// \return the check of the schedule; all other checks pass
  analysis::Check verified() {
    recorder_.closed(later(), true);
    study_.store().add_session(
        events_, record::wrap_participant_key(study_.key().investigator_box, 1, own_), at_);
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
  [[nodiscard]] study::Schedule schedule() const { return schedule_; }
  [[nodiscard]] int count() const { return static_cast<int>(schedule_.trials.size()); }
  [[nodiscard]] int catch_trial() const {
    const auto& all = schedule_.trials;
    return std::find_if(
               all.begin(), all.end(),
               [](const study::Trial& one) { return one.role == study::Role::catch_trial; })
        ->place.trial;
  }

 private:
  milliseconds later() { return at_ += seconds(1); }

  FakeStudy& study_;
  SecretKey own_ = sha256(bytes_of("participant"));
  record::BufferedEvents events_;
  record::SessionRecorder recorder_;
  study::Schedule schedule_;
  milliseconds at_{0};
};

const FakeOptions kCatching{.trials = R"({"catch": 2})"};
const FakeOptions kLeavingOut{.trials = R"({"on_interruption": "leave-out"})"};

/// What a session tells, and what its check finds: words of a fault, or nothing.
struct Told {
  FakeOptions options;
  std::function<void(ToldSession&)> tell;
  std::string fault;
};

void check_told(const std::vector<Told>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    FakeStudy study(all[i].options);
    ToldSession session(study);
    all[i].tell(session);
    const analysis::Check check = session.verified();
    INFO("session " << i << ": " << check.detail);
    const bool passes = all[i].fault.empty();
    CHECK(check.state == (passes ? analysis::CheckState::passed : analysis::CheckState::failed));
    CHECK((passes || names(check.detail, all[i].fault)));
  }
}

}  // namespace

TEST_CASE("verify_study accepts catch trials in their places, and nothing else there") {
  FakeStudy study(kCatching);
  ToldSession whole(study);
  const analysis::Check check = whole.open().show_from(1).verified();
  CHECK(check.state == analysis::CheckState::passed);
  CHECK(names(check.detail, "14"));
  const int trial = whole.catch_trial();
  study::Schedule tampered = whole.schedule();
  for (study::Trial& one : tampered.trials) {
    if (one.place.trial != trial) continue;
    one.role = study::Role::scored;
    one.planes = tampered.trials.front().planes;
    one.right = tampered.trials.front().right;
  }
  check_told(
      {{kCatching, [&](ToldSession& s) { s.open().show_from(1, trial); }, std::to_string(trial)},
       {kCatching, [&](ToldSession& s) { s.open(tampered).show_from(1); }, "1"}});
}

TEST_CASE("verify_study checks the study's policy of interrupted trials") {
  check_told({
      {{},
       [](ToldSession& s) { s.open().show(1).present(2).interrupt(2).show_from(3).show(2); },
       ""},
      {{}, [](ToldSession& s) { s.open().present(1).interrupt(1).show_from(2); }, "1"},
      {{}, [](ToldSession& s) { s.open().present(1).interrupt(1).show(1).show_from(2); }, "1 2"},
      {kLeavingOut, [](ToldSession& s) { s.open().present(1).interrupt(1).show_from(2); }, ""},
      {kLeavingOut, [](ToldSession& s) { s.open().present(1).interrupt(1).show_from(2).show(1); },
       "1"},
      // Left out although it was not interrupted.
      {kLeavingOut, [](ToldSession& s) { s.open().show_from(1, 5); }, "1 6 5"},
  });
}

TEST_CASE("verify_study accepts resumed sessions, and names events that cannot follow") {
  check_told({
      {{},
       [](ToldSession& s) {
         s.open().show(1).present(2).resume("program-ended", 90.0).interrupt(2);
         s.pause().resume("pause", 1.0).show_from(3).show(2);
       },
       ""},
      {{},
       [](ToldSession& s) {
         s.open().present(1).resume("program-ended", 90.0).answer(1).show_from(2);
       },
       "1"},
      {{},
       [](ToldSession& s) { s.open().show(1).resume("program-ended", 25.0 * 3600.0).show_from(2); },
       "1 3 25.0"},
      {{}, [](ToldSession& s) { s.open().show(1).resume("pause", 1.0).show_from(2); }, "1"},
      {{}, [](ToldSession& s) { s.open().pause().show_from(1); }, "1"},
      {{}, [](ToldSession& s) { s.open().present(1).show_from(2); }, "1 2"},
      {{}, [](ToldSession& s) { s.open().show(1).restart_block(); }, "1 3 0"},
  });
}

}  // namespace touchtrial
