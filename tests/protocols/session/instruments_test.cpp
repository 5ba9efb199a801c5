// What other instruments are told of a session, and what the session records of it.
#include "protocols/session/instruments.hpp"

#include "core/cipher.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/tiny_study.hpp"
#include "record/payload_json.hpp"
#include "study/protocol.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

using record::Mark;
using Clock = std::chrono::steady_clock;

/// Keeps what it is told. Every second mark does not get through.
struct KeptMarks final : session::Instruments {
  void mark(Mark mark, int trial, TimePoint at) noexcept override {
    marks.emplace_back(mark, trial);
    times.push_back(at);
    latencies.push_back(marks.size() % 2 == 1 ? std::optional(std::chrono::nanoseconds(1000))
                                              : std::nullopt);
  }
  void feel(const device::ServoSample&, TimePoint at) noexcept override { felt.push_back(at); }
  [[nodiscard]] Report take() override {
    return {std::exchange(latencies, {}), std::optional(500.0), 0.001};
  }

  std::vector<std::pair<Mark, int>> marks;
  std::vector<TimePoint> times;
  std::vector<TimePoint> felt;
  std::vector<std::optional<std::chrono::nanoseconds>> latencies;
};

/// A session whose inputs the test gives.
struct Course {
  Course()
      : session(
            study::make_order(study.key().study, study.key().draw_of(1, study::Draws::rehearsal)),
            study.key().study.trials, record::SessionRecorder(1, key, events)) {
    record::SessionOpening opening{.participant = "P001", .enrolment = 1};
    session.open(now(), opening, "{}");
    session.calibrate(now());
    session.instruct(now());
  }
  [[nodiscard]] session::Session::Time now() { return clock.now(); }

  TinyStudy study;
  SecretKey key = sha256(bytes_of("somebody"));
  record::BufferedEvents events;
  session::SteadySessionClock clock;
  session::Session session;
};

device::ServoSample at_height(double z_mm, std::int64_t tick) {
  return {{1.0, 1.0, z_mm}, {}, tick};
}

}  // namespace

TEST_CASE("instruments receive events and trial numbers, but nothing about stimuli") {
  Course course;
  KeptMarks kept;
  session::SessionMarks marks(&kept, course.session, 1000.0);
  marks.begin();
  const int trial = course.session.current()->place.trial;
  course.session.present(course.now());
  const Clock::time_point began = Clock::now();
  marks.note_plane_on(began);
  marks.feel(at_height(10.0, 0));
  marks.feel(at_height(session::kLandingHeightMm - 0.1, 250));
  marks.feel(at_height(0.0, 251));
  course.session.end_exploring(course.now());
  course.session.explore_again(course.now());
  marks.note_plane_on(began + std::chrono::seconds(1));
  course.session.end_exploring(course.now());
  course.session.choose(0);
  course.session.confirm(course.now());
  course.session.take_break(course.now());
  course.session.pause(course.now(), "");
  course.session.resume(course.now());
  marks.end();
  CHECK(kept.marks == std::vector<std::pair<Mark, int>>{{Mark::session_begins, 0},
                                                        {Mark::plane_on, trial},
                                                        {Mark::contact, trial},
                                                        {Mark::plane_off, trial},
                                                        {Mark::plane_on, trial},
                                                        {Mark::plane_off, trial},
                                                        {Mark::answered, trial},
                                                        {Mark::break_taken, 0},
                                                        {Mark::paused, 0},
                                                        {Mark::resumed, 0},
                                                        {Mark::session_ends, 0}});
  CHECK(kept.times[1] == began);
  CHECK(kept.times[2] == began + std::chrono::milliseconds(250));
  CHECK(kept.felt.size() == 3);
}

TEST_CASE("a session records the times of marks by both clocks, sealed") {
  Course course;
  KeptMarks kept;
  session::SessionMarks marks(&kept, course.session, 1000.0);
  marks.begin();
  course.session.present(course.now());
  marks.note_plane_on(Clock::now());
  const std::optional<record::MarksBody> body = marks.take(course.clock);
  REQUIRE(body);
  CHECK_FALSE(marks.take(course.clock));
  course.session.end_exploring(course.now());
  course.session.mark(course.now(), *body);
  const record::Event stored = course.events.events.back();
  CHECK(stored.kind == record::EventKind::marked);
  CHECK(stored.body == "{}");
  const record::MarksBody read =
      record::from_json<record::MarksBody>(record::unsealed(stored, course.key).value());
  CHECK(read.codes == std::vector<std::int64_t>{1, 10});
  CHECK(read.trials == std::vector<std::int64_t>{0, body->trials[1]});
  CHECK(read.at_ns == body->at_ns);
  CHECK(read.at_ns[0] <= read.at_ns[1]);
  CHECK(read.at_ns[1] <= course.now().count());
  CHECK(read.latency_ns == std::vector<std::int64_t>{1000, 0});
  const double zero_s =
      std::chrono::duration<double>((Clock::now() - course.now()).time_since_epoch()).count();
  CHECK(read.lsl_zero_s.value() == Approx(500.0 + zero_s).margin(1.0));
  CHECK(read.lsl_uncertainty_s == 0.001);
}

TEST_CASE("without instruments a session records nothing of them") {
  Course course;
  session::SessionMarks marks(nullptr, course.session, 1000.0);
  marks.begin();
  course.session.present(course.now());
  marks.note_plane_on(Clock::now());
  marks.feel(at_height(0.0, 0));
  marks.end();
  CHECK_FALSE(marks.take(course.clock));
}

TEST_CASE("marks whose lists differ in length are refused") {
  CHECK_THROWS_AS(record::from_json<record::MarksBody>(
                      R"({"at_ns":[1],"codes":[1,2],"latency_ns":[0],"trials":[0]})"),
                  StoreError);
}

TEST_CASE("every mark has a name, and a code of none is unknown") {
  for (const int code : {1, 2, 10, 11, 12, 13, 20, 30, 40, 41, 42, 43, 50}) {
    CHECK(name_of(static_cast<Mark>(code)) != "unknown");
  }
  CHECK(name_of(static_cast<Mark>(99)) == "unknown");
}

}  // namespace touchtrial
