// Whatever befell a session, its record holds; and it still does once nobody can open its answers.
#include "analysis/verification/session_course.hpp"
#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/tiny_study.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::seconds;

TinyStudyOptions threshold_of(const std::string& more) {
  return {.protocol = "threshold",
          .section = R"({"interval_s": 0.5, "trials": 6, "levels": [-40, -30, -20, -10, -5, 0], )" +
                     more + "}"};
}

const std::vector<std::pair<std::string, TinyStudyOptions>> kStudies = {
    {"classification", {.trials = R"({"repeats": 2, "catch": 2, "lead_in": 1})"}},
    {"left out", {.trials = R"({"repeats": 2, "on_interruption": "leave-out"})"}},
    {"comparison", {.comparison = true, .trials = R"({"repeats": 2})"}},
    {"restarted blocks",
     {.comparison = true, .trials = R"({"repeats": 2, "on_interruption": "restart-block"})"}},
    {"no response", {.trials = R"({"repeats": 2, "on_timeout": "no-response"})"}},
    {"QUEST+", threshold_of(R"("task": "detection", "catch": 4, "control": 5)")},
    {"staircase", threshold_of(R"("task": "detection", "procedure": "up-down",
                                  "control": 3)")},
    {"constant stimuli", threshold_of(R"("task": "detection", "procedure": "constant-stimuli",
                                         "control": 2)")},
    {"odd one out",
     threshold_of(R"("task": "detection", "question": "odd-one-out", "intervals": 3, "control": 1,
                     "catch": 2)")},
    {"same or different",
     threshold_of(
         R"("task": "detection", "question": "same-different", "procedure": "constant-stimuli", "control": 4)")},
};

/// A session that goes through whatever is drawn, as its program records it.
class Ordeal {
 public:
  Ordeal(const study::StudyKey& key, std::uint64_t seed)
      : key_(key),
        draw_(key.draw_of(1, study::Draws::rehearsal)),
        random_(seed, "ordeal"),
        session_(fresh()) {
    record::SessionOpening opening{.participant = "P001", .enrolment = 1};
    session_->open(now(), opening, "{}");
    session_->calibrate(now());
    session_->instruct(now());
    while (session_->current() != nullptr && events_.events.size() < 2000) befall();
    if (session_->accepts(session::SessionInput::close)) session_->close(now());
  }

  /// \throws VerificationError at the first event that cannot follow
  void check(bool opened) const {
    analysis::SessionCourse course(key_.study, draw_, opened);
    const std::vector<record::Event> whole = as_recorded(events_.events, SecretKey{});
    for (std::size_t i = 0; i < whole.size(); ++i) {
      course.follow(opened ? whole[i] : events_.events[i]);
    }
  }
  [[nodiscard]] const std::vector<record::Event>& events() const { return events_.events; }

 private:
  session::Session fresh() {
    return session::Session(study::make_order(key_.study, draw_), key_.study.trials,
                            record::SessionRecorder(1, SecretKey{}, events_),
                            [](const std::vector<study::Trial>&) { return std::string("[]"); });
  }
  seconds now() { return seconds(++clock_); }

  void befall() {
    session_->present(now());
    session_->contact(now());
    if (happens(10)) return be_killed();
    if (happens(10)) return session_->interrupt(now(), "comfort stop");
    if (happens(10)) return pause_while_exploring();
    const bool may_time_out = !study::make_order(key_.study, draw_)->is_adaptive();
    if (may_time_out && happens(8)) {
      session_->time_out(now());
      if (!session_->in_presentation()) return;
    } else {
      session_->end_exploring(now());
    }
    if (happens(8)) rest();
    if (happens(12)) return be_killed();
    session_->choose(static_cast<int>(random_.below(session_->layout().size())));
    session_->confirm(now());
    if (session_->current() == nullptr) return;
    if (happens(8)) rest();
    if (happens(12)) be_killed();
  }
  [[nodiscard]] bool happens(std::uint64_t once_in) { return random_.below(once_in) == 0; }
  void rest() {
    session_->pause(now(), "a break");
    session_->resume(now());
  }
  void pause_while_exploring() {
    session_->interrupt(now(), record::kPauseReason);
    rest();
  }
  void be_killed() {
    session_.emplace(fresh());
    session_->restore(as_recorded(events_.events, SecretKey{}));
    session_->resume_after_exit(now(), {.after = "end", .away_s = 9.0});
  }

  const study::StudyKey& key_;
  study::ScheduleDraw draw_;
  RandomStream random_;
  record::BufferedEvents events_;
  int clock_ = 0;
  std::optional<session::Session> session_;
};

}  // namespace

TEST_CASE("a session's record holds whatever befell it, opened or erased") {
  for (const auto& [name, options] : kStudies) {
    INFO(name);
    const TinyStudy study(options);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      INFO("seed " << seed);
      const Ordeal ordeal(study.key(), seed);
      CHECK(ordeal.events().back().kind == record::EventKind::closed);
      CHECK_NOTHROW(ordeal.check(/*opened=*/true));
      CHECK_NOTHROW(ordeal.check(/*opened=*/false));
    }
  }
}

}  // namespace touchtrial
