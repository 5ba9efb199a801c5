#include "protocols/session/session_runner.hpp"

#include "protocols/session/resting_stylus.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/sanitized.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <variant>

#include <sys/resource.h>

namespace touchtrial {
namespace {

using namespace session;

/// A participant who always names the first picture. The device is lost in the first `losses`
/// presentations.
class Unlucky final : public simulation::PromptParticipant {
 public:
  explicit Unlucky(int losses) : losses_(losses) {}

  void see_pictures(const std::vector<std::string>& labels) override { pictures = labels; }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry&) override {
    stylus_ = RestingStylus(100, losses_-- > 0 ? 50 : -1);
    return stylus_;
  }
  void feel(const device::ServoSample&) noexcept override { ++ticks; }
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    return {0, std::chrono::seconds(1)};
  }

  std::vector<std::string> pictures;
  int ticks = 0;

 private:
  int losses_;
  RestingStylus stylus_{100};
};

struct Ran {
  SessionTally tally;
  record::BufferedEvents events;

  [[nodiscard]] int count(record::EventKind kind) const {
    return static_cast<int>(std::ranges::count(events.events, kind, &record::Event::kind));
  }
};

/// Opens a session of 5 trials and runs it.
/// \param run  called with the session, the study's key and the stimuli
template <typename Run>
Ran ran_session(const Run& run, const std::string& trials = R"({"repeats": 1})",
                int side_px = 120) {
  const TinyStudy study({.side_px = side_px, .trials = trials});
  const StimulusSource source(study.pack(), study.key().study.rendering);
  Ran ran;
  Session session(
      study::make_order(study.key().study, study.key().draw_of(1, study::Draws::rehearsal)),
      study.key().study.trials, record::SessionRecorder(1, SecretKey{}, ran.events));
  record::SessionOpening opening{.participant = "P001", .enrolment = 1};
  session.open({}, opening, "{}");
  ran.tally = run(session, study.key(), source);
  return ran;
}

Ran run(Participant& participant) {
  return ran_session(
      [&](Session& session, const study::StudyKey& key, const StimulusSource& source) {
        const auto tally = run_session_in_virtual_time(session, key, source, participant);
        CHECK(session.phase() == SessionPhase::closed);
        return tally;
      });
}

/// Real time in which every call takes a while.
class CreepingClock final : public SessionClock {
 public:
  [[nodiscard]] Time now() override { return now_ += std::chrono::milliseconds(3); }
  void advance(Time duration) override { now_ += duration; }

 private:
  Time now_{};
};

/// Reads the field of each presentation before it is felt, as the servo would, and counts the pages
/// that had to be fetched.
class PageCountingExplorer final : public Explorer {
 public:
  explicit PageCountingExplorer(bool in_real_time) : in_real_time_(in_real_time) {}

  [[nodiscard]] bool in_real_time() const noexcept override { return in_real_time_; }
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    record::Trace& trace) override {
    const long before = fetched_so_far();
    for (double y_mm = 0.1; y_mm < plane.height_mm(); y_mm += plane.pitch_mm) {
      for (double x_mm = 0.1; x_mm < plane.width_mm(); x_mm += plane.pitch_mm) {
        felt_n_ += force.force_n({.position_mm = {x_mm, y_mm, -1.0}, .velocity_mm_s = {}}).z;
      }
    }
    fetched.push_back(fetched_so_far() - before);
    return usual_.explore(force, plane, participant, options, trace);
  }

  std::vector<long> fetched;  ///< by presentation

 private:
  static long fetched_so_far() {
    rusage used{};
    REQUIRE(::getrusage(RUSAGE_THREAD, &used) == 0);
    return used.ru_minflt + used.ru_majflt;
  }

  bool in_real_time_;
  double felt_n_ = 0.0;
  session::VirtualExplorer usual_;
};

/// Works in virtual time, but obeys the experimenter while the plane is on.
class AttendedExplorer final : public Explorer {
 public:
  [[nodiscard]] bool in_real_time() const noexcept override { return false; }
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    record::Trace& trace) override {
    device::ServoControl control;
    participant.while_exploring(control);
    participant.while_exploring(control);
    was_stopped = control.comfort_stop_requested();
    return usual_.explore(force, plane, participant, options, trace);
  }

  bool was_stopped = false;

 private:
  session::VirtualExplorer usual_;
};

/// An experimenter who asks to leave at every opportunity from the first exploration on.
class Insisting final : public session::Experimenter {
 public:
  void show(const SessionStatus& status) override { insists_ |= status.stage == "exploring"; }
  [[nodiscard]] std::optional<ExperimenterRequest> request() override {
    if (!insists_) return std::nullopt;
    if (++asked_ > 100) throw std::runtime_error("the desk does not stop asking");
    return ExperimenterRequest{ExperimenterRequest::Kind::leave, "a signal", ""};
  }

 private:
  bool insists_ = false;
  int asked_ = 0;
};

/// An experimenter who counts acknowledged answers, and those that the session has not stored yet.
class Witness final : public session::Experimenter {
 public:
  explicit Witness(const Session& session) : session_(session) {}
  void acknowledged(int /*trial*/) override {
    ++acknowledged_answers;
    too_early += session_.in_presentation() ? 1 : 0;
  }

  int acknowledged_answers = 0;
  int too_early = 0;

 private:
  const Session& session_;
};

Ran run_with(Explorer& explorer, SessionClock& clock,
             session::Experimenter& experimenter = no_experimenter(), int side_px = 120) {
  return ran_session(
      [&](Session& session, const study::StudyKey& key, const StimulusSource& source) {
        Unlucky person(1);
        AlwaysReady devices;
        return session::run_session(session, {key, source, person, clock, explorer, devices,
                                              device::kServoRateHz, experimenter});
      },
      R"({"repeats": 1})", side_px);
}

/// A step, and what the experimenter was shown last when it came.
struct Moment {
  session::Step step;
  SessionStatus status;
};

/// Both people of a session, who write down what they see. The participant goes on at once.
class Diary final : public session::Experimenter, public Participant {
 public:
  void show(const SessionStatus& status) override { status_ = status; }
  void see_pictures(const std::vector<std::string>& labels) override {
    person_.see_pictures(labels);
  }
  [[nodiscard]] std::optional<StepReply> show_step(const session::Step& step) override {
    moments.push_back({step, status_});
    return person_.show_step(step);
  }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    return person_.begin_exploring(plane);
  }
  void feel(const device::ServoSample& sample) noexcept override { person_.feel(sample); }

  /// The moments of one kind of step.
  template <typename Step>
  [[nodiscard]] std::vector<std::pair<Step, SessionStatus>> all() const {
    std::vector<std::pair<Step, SessionStatus>> found;
    for (const Moment& moment : moments) {
      if (const auto* const step = std::get_if<Step>(&moment.step)) {
        found.emplace_back(*step, moment.status);
      }
    }
    return found;
  }

  std::vector<Moment> moments;

 private:
  SessionStatus status_;
  Unlucky person_{0};
};

/// Ends the exploration with this number, from 1, in another way; 0: all of them.
class EndingExplorer final : public Explorer {
 public:
  EndingExplorer(device::ServoEnd end, int which) : end_(end), which_(which) {}

  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    record::Trace& trace) override {
    Exploration done = usual_.explore(force, plane, participant, options, trace);
    ++count_;
    if (which_ == 0 || which_ == count_) done.servo.end = end_;
    return done;
  }

 private:
  device::ServoEnd end_;
  int which_;
  int count_ = 0;
  session::VirtualExplorer usual_;
};

/// A device that needs consent after an interruption, which comes when it is asked for a third
/// time.
class Reluctant final : public DeviceSupply {
 public:
  [[nodiscard]] SupplyState make_ready() override {
    if (wanted_ > 0) --wanted_;
    return wanted_ > 0 ? SupplyState::not_yet : SupplyState::ready;
  }
  void on_interruption() override { wanted_ = 3; }

 private:
  int wanted_ = 0;
};

/// A round of planes without texture, of which the first choice is always right.
study::Practice blank_practice(int trials) {
  study::Practice practice{
      .labels = {"sand", "cork"}, .trials = {}, .criterion = trials, .rounds = 1};
  for (int i = 0; i < trials; ++i) {
    practice.trials.push_back({.place = {.trial = i + 1},
                               .role = study::Role::practice,
                               .planes = {{.field = {}, .blank = true}},
                               .right = 0});
  }
  return practice;
}

Ran run_diary(Diary& diary, Explorer& explorer, DeviceSupply& devices,
              const std::string& trials = R"({"repeats": 1})", int practice = 0) {
  VirtualSessionClock clock;
  return ran_session(
      [&](Session& session, const study::StudyKey& key, const StimulusSource& source) {
        return session::run_session(session,
                                    {.key = key,
                                     .source = source,
                                     .participant = diary,
                                     .clock = clock,
                                     .explorer = explorer,
                                     .devices = devices,
                                     .experimenter = diary,
                                     .practice = [&](int) { return blank_practice(practice); }});
      },
      trials);
}

TEST_CASE("after a comfort stop a page informs the participant and the experimenter") {
  const bool needs_consent = GENERATE(false, true);
  Diary diary;
  EndingExplorer explorer(device::ServoEnd::comfort_stop, 2);
  AlwaysReady ready;
  Reluctant reluctant;
  const Ran ran =
      run_diary(diary, explorer, needs_consent ? static_cast<DeviceSupply&>(reluctant) : ready);
  CHECK(ran.count(record::EventKind::interrupted) == 1);
  CHECK(ran.count(record::EventKind::answered) == 5);
  const auto notices = diary.all<NoticeStep>();
  REQUIRE(!notices.empty());
  for (const auto& [notice, status] : notices) {
    CHECK(notice.what == NoticeStep::What::stopped);
    CHECK(notice.can_resume == !needs_consent);
    CHECK(status.stage == "stopped");
    CHECK(status.participant_stopped);
    CHECK(status.needs_consent == needs_consent);
  }
  for (const auto& [step, status] : diary.all<ReadyStep>()) {
    CHECK_FALSE(status.participant_stopped);
  }
}

TEST_CASE("a lost device is no comfort stop, and the participant is asked to wait") {
  Diary diary;
  EndingExplorer explorer(device::ServoEnd::fault, 2);
  Reluctant devices;
  static_cast<void>(run_diary(diary, explorer, devices));
  CHECK(diary.all<NoticeStep>().empty());
  REQUIRE(!diary.all<PauseStep>().empty());
  CHECK_FALSE(diary.all<PauseStep>().front().second.stage.empty());
}

TEST_CASE("the experimenter's status counts trials as the participant's window does") {
  Diary diary;
  EndingExplorer explorer(device::ServoEnd::comfort_stop, 4);
  AlwaysReady devices;
  static_cast<void>(run_diary(diary, explorer, devices, R"({"repeats": 1})", 2));
  const auto ready = diary.all<ReadyStep>();
  CHECK(ready.size() == 2 + 6);
  for (const auto& [step, status] : ready) {
    CHECK(status.stage == "ready");
    CHECK(status.trial == step.trial);
    CHECK(status.total == step.total);
    CHECK(status.practice == step.practice);
  }
  for (const auto& [step, status] : diary.all<AnswerStep>()) {
    CHECK(status.stage == "answering");
    CHECK(status.trial == step.trial);
    CHECK(status.total == step.total);
    CHECK(status.practice == step.practice);
  }
  for (const auto& [step, status] : diary.all<FeedbackStep>()) {
    CHECK(status.stage == "feedback");
  }
}

TEST_CASE("notices announce the end of practice, and during practice that time is up") {
  Diary diary;
  EndingExplorer explorer(device::ServoEnd::time_limit, 1);
  AlwaysReady devices;
  static_cast<void>(run_diary(diary, explorer, devices, R"({"repeats": 1})", 2));
  const auto notices = diary.all<NoticeStep>();
  REQUIRE(notices.size() == 1);
  CHECK(notices.front().first.what == NoticeStep::What::practice_over);
  CHECK_FALSE(notices.front().second.stage.empty());
  const auto answers = diary.all<AnswerStep>();
  REQUIRE(answers.size() == 2 + 5);
  CHECK(answers[0].first.time_is_up);
  CHECK_FALSE(answers[1].first.time_is_up);
}

TEST_CASE("a notice follows a trial that ends without an answer") {
  Diary diary;
  EndingExplorer explorer(device::ServoEnd::time_limit, 0);
  AlwaysReady devices;
  static_cast<void>(
      run_diary(diary, explorer, devices, R"({"repeats": 1, "on_timeout": "no-response"})"));
  CHECK(diary.all<AnswerStep>().empty());
  const auto notices = diary.all<NoticeStep>();
  REQUIRE(notices.size() == 5);
  for (const auto& [notice, status] : notices) {
    CHECK(notice.what == NoticeStep::What::time_is_up);
    CHECK(notice.can_resume);
    CHECK_FALSE(status.stage.empty());
  }
}

TEST_CASE("in real time every field is in memory before it is felt") {
  // Larger than what the system fetches round the first page that is read.
  constexpr int kSidePx = 300;
  VirtualSessionClock clock;
  const auto fetched = [&](bool in_real_time) {
    PageCountingExplorer explorer(in_real_time);
    CHECK(run_with(explorer, clock, no_experimenter(), kSidePx).tally.presentations == 6);
    return explorer.fetched;
  };
  // The careless one goes first: pages of the code come with the first force.
  const std::vector<long> careless = fetched(false);
  const std::vector<long> real = fetched(true);
  // The sixth presentation is a repetition, whose field was felt before.
  CHECK(std::ranges::count(careless, 0) <= 1);
  if (kSanitized) {
    // A sanitizer fetches pages of its own beside those of a field, one for eight.
    CHECK(std::reduce(real.begin(), real.end()) <=
          std::reduce(careless.begin(), careless.end()) / 4);
  } else {
    // The system may take a page back once; a field that was not fetched lacks one every time.
    CHECK(std::ranges::count(real, 0) >= 5);
  }
}

TEST_CASE("times say when an exploration ended, not how long its trace took to pack") {
  CreepingClock clock;
  session::VirtualExplorer explorer;
  const Ran ran = run_with(explorer, clock);
  SessionClock::Time plane_on{};
  int ends = 0;
  const std::vector<record::Event> events = as_recorded(ran.events.events, SecretKey{});
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].kind == record::EventKind::presented) plane_on = events[i].at;
    if (events[i].kind == record::EventKind::interrupted) {
      CHECK(events[i].at - plane_on == std::chrono::milliseconds(50));
      ++ends;
    }
    if (events[i].kind == record::EventKind::trace_stored) {
      REQUIRE(events[i + 1].kind == record::EventKind::answered);
      CHECK(events[i + 1].at == events[i].at);
      ++ends;
    }
  }
  CHECK(ends == 6);
}

TEST_CASE(
    "any participant can take part in a virtual session and sees the pictures in the layout's "
    "order") {
  Unlucky lucky(0);
  const Ran ran = run(lucky);
  std::vector<std::string> sorted = lucky.pictures;
  std::ranges::sort(sorted);
  CHECK(sorted == std::vector<std::string>{"bark", "brick", "cloth", "pebbles", "straw"});
  CHECK(ran.tally.presentations == 5);
  CHECK(ran.tally.ticks == 500);
  CHECK(ran.tally.invalid_trials == 5);
  CHECK(lucky.ticks == 500);
  CHECK(ran.count(record::EventKind::answered) == 5);
  CHECK(ran.count(record::EventKind::trace_stored) == 5);
  CHECK(ran.tally.duration == as_recorded(ran.events.events.back(), SecretKey{}).at);
}

TEST_CASE("a presentation in which the device was lost is repeated and leaves no trace") {
  Unlucky unlucky(2);
  const Ran ran = run(unlucky);
  CHECK(ran.tally.presentations == 7);
  CHECK(ran.count(record::EventKind::interrupted) == 2);
  CHECK(ran.count(record::EventKind::answered) == 5);
  CHECK(ran.count(record::EventKind::trace_stored) == 5);
  CHECK(ran.count(record::EventKind::stopped) == 0);
}

TEST_CASE("a request to leave while the plane is on is obeyed once, however often it is repeated") {
  VirtualSessionClock clock;
  AttendedExplorer explorer;
  Insisting experimenter;
  const Ran ran = run_with(explorer, clock, experimenter);
  CHECK(explorer.was_stopped);
  CHECK(ran.tally.left == "a signal");
  CHECK(ran.count(record::EventKind::presented) == 1);
  CHECK(ran.count(record::EventKind::answered) == 0);
  CHECK(ran.count(record::EventKind::closed) == 0);
}

TEST_CASE("an answer is acknowledged only after it is stored") {
  VirtualSessionClock clock;
  session::VirtualExplorer explorer;
  AlwaysReady devices;
  Unlucky person(0);
  static_cast<void>(ran_session([&](Session& session, const study::StudyKey& key,
                                    const StimulusSource& source) {
    Witness witness(session);
    const SessionTally tally = session::run_session(
        session, {key, source, person, clock, explorer, devices, device::kServoRateHz, witness});
    CHECK(witness.acknowledged_answers == 5);
    CHECK(witness.too_early == 0);
    return tally;
  }));
}

TEST_CASE("a session whose device is lost again and again is stopped") {
  Unlucky doomed(1000);
  const Ran ran = run(doomed);
  CHECK(ran.count(record::EventKind::interrupted) == 6);
  CHECK(ran.count(record::EventKind::answered) == 0);
  CHECK(ran.count(record::EventKind::stopped) == 1);
  CHECK(ran.count(record::EventKind::closed) == 1);
}

}  // namespace
}  // namespace touchtrial
