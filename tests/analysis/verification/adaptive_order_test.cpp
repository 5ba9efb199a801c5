// Sessions in which answers decide what comes next: what they present, how they are taken up again,
// and what the check of their record finds.
#include "analysis/verification/session_course.hpp"
#include "core/errors.hpp"
#include "protocols/procedures/tracks.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/tiny_study.hpp"
#include "record/payload_json.hpp"
#include "record/sealing.hpp"
#include "study/protocol.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace record;
using namespace study;
using std::chrono::seconds;

procedures::BlockSettings two_tracks() {
  procedures::TrackSettings track;
  track.procedure = "up-down";
  for (int i = 0; i < 12; ++i) track.levels.push_back(-24.0 + 2.0 * i);
  track.trials = 12;
  track.up_down.first_level = 8;
  procedures::BlockSettings settings{{track, track}, 2};
  settings.tracks[1].up_down.first_level = 3;
  return settings;
}

Digest digest_of(const ScheduleDraw& draw) {
  return FieldHasher().add("adaptive order of a test").add(ByteView(draw.secret)).finish();
}

/// Two choices, and the right one is drawn for each trial.
class BlockOrder final : public Order {
 public:
  explicit BlockOrder(const ScheduleDraw& draw)
      : Order(places(), draw.secret),
        block_(two_tracks(), digest_of(draw)),
        targets_(digest_of(draw).front(), "targets") {
    target_ = static_cast<int>(targets_.below(2));
  }
  Trial at(const Trial& scheduled) const override {
    const auto next = block_.next();
    REQUIRE(next);
    return {.place = scheduled.place,
            .role = next->is_catch ? Role::catch_trial : Role::scored,
            .planes = {{}, {}},
            .right = target_,
            .level = Level{static_cast<int>(next->track) + 1, static_cast<int>(next->level)}};
  }
  void answered(const Trial&, const Answer& answer) override {
    block_.answer(schedule().choice_of(answer) == target_);
    target_ = static_cast<int>(targets_.below(2));
  }

 private:
  static Schedule places() {
    // Positions are not choices: the second choice stands first.
    Schedule schedule{{}, {1, 0}};
    for (int i = 0; i < 26; ++i) schedule.trials.push_back({.place = {.trial = i + 1}});
    return schedule;
  }

  procedures::Block block_;
  RandomStream targets_;
  int target_ = 0;
};

class TwoTracks final : public Task {
 public:
  void check(const JsonValue&, const Study&) const override {}
  int scored_trials(const Study&) const override { return 24; }
  std::string rule(const Study&) const override { return "two-tracks 1"; }
  TrialQuestion ask(const Study&, const Place&) const override {
    return {.planes = 2,
            .question = ChoiceQuestion{.title = {}, .choices = {{"first"}, {"second"}}}};
  }
  std::unique_ptr<Order> order(const Study&, const ScheduleDraw& draw) const override {
    return std::make_unique<BlockOrder>(draw);
  }
};

/// A study of the task, and sessions of its first participant.
class AdaptiveLaboratory {
 public:
  explicit AdaptiveLaboratory(OnInterruption policy = OnInterruption::repeat)
      : study_(tiny_.key().study), draw_(tiny_.key().draw_of(1, Draws::rehearsal)) {
    study_.task = std::make_shared<TwoTracks>();
    study_.trials.on_interruption = policy;
  }

  [[nodiscard]] session::Session begun(BufferedEvents& events) const {
    session::Session session = fresh(events);
    SessionOpening opening{.participant = "P001", .enrolment = 1};
    session.open(seconds(1), opening, "{}");
    session.calibrate(seconds(2));
    session.instruct(seconds(3));
    return session;
  }
  [[nodiscard]] session::Session fresh(BufferedEvents& events) const {
    return session::Session(study::make_order(study_, draw_), study_.trials,
                            record::SessionRecorder(1, SecretKey{}, events),
                            session::block_serialiser(tiny_.key()));
  }
  /// \throws VerificationError at the first event that cannot follow
  void check(const std::vector<Event>& events) const {
    analysis::SessionCourse course(study_, draw_);
    for (const Event& event : events) course.follow(event);
  }
  [[nodiscard]] Digest secret() const { return digest_of(draw_); }

 private:
  TinyStudy tiny_;
  Study study_;
  ScheduleDraw draw_;
};

/// Right whenever the level is at least 6; at lower ones always the first choice.
int position_for(const Trial& shown) {
  const int choice = shown.level.value().level >= 6 ? shown.right.value() : 0;
  return choice == 1 ? 0 : 1;
}

seconds end_of(const session::Session& session) {
  return std::chrono::duration_cast<seconds>(session.last());
}

void answer_current(session::Session& session) {
  seconds now = end_of(session);
  const Trial shown = *session.current();
  session.present(now += seconds(1));
  session.contact(now += seconds(1));
  session.end_exploring(now += seconds(1));
  session.choose(position_for(shown));
  session.confirm(now + seconds(1));
}

bool answered_right(const Trial& shown) {
  return position_for(shown) == (shown.right == 1 ? 0 : 1);
}

TEST_CASE("a session presents what its procedure chooses after the answers so far") {
  const AdaptiveLaboratory lab;
  BufferedEvents events;
  session::Session session = lab.begun(events);
  std::vector<procedures::RecordedTrial> record;
  while (session.current() != nullptr) {
    const Trial& shown = *session.current();
    const auto [track, level] = shown.level.value();
    record.push_back({{static_cast<std::size_t>(track - 1), static_cast<std::size_t>(level),
                       shown.role == Role::catch_trial},
                      answered_right(shown)});
    answer_current(session);
  }
  CHECK(session.phase() == session::SessionPhase::finished);
  CHECK(record.size() == 26);
  CHECK_FALSE(procedures::first_mismatch(two_tracks(), lab.secret(), record));
  CHECK_NOTHROW(lab.check(as_recorded(events.events, SecretKey{})));
}

TEST_CASE("a session that ends anywhere is taken up at the same levels") {
  const AdaptiveLaboratory lab;
  BufferedEvents events;
  session::Session session = lab.begun(events);
  std::vector<std::size_t> ends;   // of events, before each trial
  std::vector<Trial> before_each;  // what came next there
  while (session.current() != nullptr) {
    ends.push_back(events.events.size());
    before_each.push_back(*session.current());
    answer_current(session);
  }
  const std::vector<Event> recorded = as_recorded(events.events, SecretKey{});
  for (std::size_t i = 0; i < ends.size(); ++i) {
    // At rest before a trial, and within it: presented, and presented and touched.
    for (std::size_t more = 0; more < 3; ++more) {
      BufferedEvents other;
      session::Session again = lab.fresh(other);
      again.restore(std::span(recorded).first(ends[i] + more));
      CHECK(*again.current() == before_each[i]);
      if (more == 0) continue;
      again.resume_after_exit(again.last() + seconds(9), {.after = "end", .away_s = 9.0});
      // Another trial number, and the same track, level and target.
      REQUIRE(again.current() != nullptr);
      CHECK(again.current()->level == before_each[i].level);
      CHECK(again.current()->right == before_each[i].right);
    }
  }
}

TEST_CASE("an interrupted trial comes again at its level, and the record still holds") {
  const AdaptiveLaboratory lab;
  BufferedEvents events;
  session::Session session = lab.begun(events);
  for (int i = 0; i < 5; ++i) answer_current(session);
  const Trial interrupted = *session.current();
  session.present(end_of(session) + seconds(1));
  session.interrupt(end_of(session) + seconds(1), "comfort stop");
  CHECK(session.current()->level == interrupted.level);
  CHECK(session.current()->right == interrupted.right);
  CHECK(session.current()->place.trial != interrupted.place.trial);
  while (session.current() != nullptr) answer_current(session);
  CHECK_NOTHROW(lab.check(as_recorded(events.events, SecretKey{})));
}

TEST_CASE("the check names the first trial that the procedure would not have presented") {
  const AdaptiveLaboratory lab;
  BufferedEvents events;
  session::Session session = lab.begun(events);
  while (session.current() != nullptr) answer_current(session);
  const std::vector<Event> honest = as_recorded(events.events, SecretKey{});
  std::vector<std::size_t> answers;
  for (std::size_t i = 0; i < honest.size(); ++i) {
    if (honest[i].kind == EventKind::answered) answers.push_back(i);
  }
  int told = 0;
  for (std::size_t nth = 0; nth < answers.size(); ++nth) {
    const std::string trial = "trial " + std::to_string(nth + 1) + ":";
    const auto altered = [&](auto alter) {
      std::vector<Event> forged = honest;
      AnswerBody body = from_json<AnswerBody>(forged[answers[nth]].body);
      alter(body);
      forged[answers[nth]].body = to_json(body);
      return forged;
    };
    CHECK_THROWS_WITH(lab.check(altered([](AnswerBody& body) { body.level = 11 - *body.level; })),
                      holds_text(trial));
    CHECK_THROWS_WITH(lab.check(altered([](AnswerBody& body) { body.target = 1 - *body.target; })),
                      holds_text(trial));
    CHECK_THROWS_WITH(lab.check(altered([](AnswerBody& body) { body.track.reset(); })),
                      holds_text(trial));
    CHECK_THROWS_WITH(lab.check(altered([](AnswerBody& body) {
      body.kind = body.kind == "catch" ? "scored" : "catch";
    })),
                      holds_text(trial) && names("catch scored"));
    CHECK_THROWS_WITH(lab.check(altered([](AnswerBody& body) { body.answer = ChoiceAnswer{2}; })),
                      holds_text(trial) && names("2"));
    // Another answer is possible by itself, and shows in what came later, if anything did.
    try {
      lab.check(altered(
          [](AnswerBody& body) { body.answer = ChoiceAnswer{1 - *position_of(body.answer)}; }));
    } catch (const VerificationError& error) {
      ++told;
      CHECK_THAT(std::string(error.what()), names("1"));
    }
  }
  CHECK(told > 12);
}

TEST_CASE("what an adaptive order chose is sealed with the answer, in no more bytes than others") {
  const AdaptiveLaboratory lab;
  BufferedEvents events;
  session::Session session = lab.begun(events);
  while (session.current() != nullptr) answer_current(session);
  std::size_t sealed = 0;
  for (const Event& event : events.events) {
    CHECK(event.body.find("level") == std::string::npos);
    CHECK(event.body.find("target") == std::string::npos);
    CHECK(event.body.find("track") == std::string::npos);
    if (event.kind != EventKind::answered) continue;
    if (sealed == 0) sealed = event.sealed.size();
    CHECK(event.sealed.size() == sealed);
  }
  CHECK(sealed > 0);
}

TEST_CASE("blocks that an order chooses cannot be restarted") {
  const AdaptiveLaboratory lab(OnInterruption::restart_block);
  BufferedEvents events;
  CHECK_THROWS_AS(lab.fresh(events), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
