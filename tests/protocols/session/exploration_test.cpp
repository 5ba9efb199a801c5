#include "protocols/session/exploration.hpp"

#include "device/servo/duration_histogram.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/sample_ring.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/stroker.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <atomic>
#include <cmath>

namespace touchtrial {
namespace {

Stroker stroker(const simulation::SubjectModel& subject) {
  return Stroker(RandomStream(1, "exploration_test"), subject);
}

TEST_CASE("on a flat texture the contact force is steady to 0.02 N from 0.5 s after landing on") {
  simulation::SubjectModel subject{.explore_s = 3.0, .push_n = GENERATE(0.3, 0.7, 2.0)};
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(120, 120), rendering);
  const engine::RenderingModel model(field.view(), rendering, {0.01, 0.01});
  session::ModelForce force(model);
  Stroker explorer = stroker(subject);
  record::Trace trace;
  const session::Exploration done =
      session::VirtualExplorer().explore(force, field.view().geometry, explorer, {}, trace);
  REQUIRE(done.servo.end == device::ServoEnd::hand_stopped);
  REQUIRE(trace.samples.size() == 3000);
  std::size_t landed = 0;
  while (!(trace.samples.at(landed).force_n.z > 0.0)) ++landed;
  for (std::size_t i = landed + 500; i < trace.samples.size(); ++i) {
    REQUIRE(std::abs(trace.samples[i].force_n.z - subject.push_n) < 0.02);
  }
}

TEST_CASE("the trace and the participant get the same samples") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  simulation::SubjectModel subject{.explore_s = 0.5};
  Stroker explorer = stroker(subject);
  record::Trace trace;
  session::ModelForce force(source.model(study.key().stimuli.front().code));
  static_cast<void>(session::VirtualExplorer().explore(force, source.plane(), explorer, {}, trace));
  REQUIRE(trace.samples.size() == explorer.felt.size());
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    REQUIRE(trace.samples[i].position_mm == explorer.felt[i].position_mm);
    REQUIRE(trace.samples[i].force_n == explorer.felt[i].force_n);
  }
  CHECK(trace.rate_hz == 1000.0);
}

TEST_CASE("the time of landing is the same on every texture") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  simulation::SubjectModel subject{.explore_s = 1.0};
  std::vector<std::chrono::nanoseconds> landings;
  for (const study::KeyedStimulus& keyed : study.key().stimuli) {
    Stroker explorer = stroker(subject);
    record::Trace trace;
    session::ModelForce force(source.model(keyed.code));
    const session::Exploration done =
        session::VirtualExplorer().explore(force, source.plane(), explorer, {}, trace);
    REQUIRE(done.landed_at);
    landings.push_back(*done.landed_at);
  }
  CHECK(landings.size() == 5);
  CHECK(landings.front() > std::chrono::milliseconds(50));
  for (const auto landing : landings) CHECK(landing == landings.front());
}

TEST_CASE("when time is up the plane fades under the hand") {
  simulation::SubjectModel subject;
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(120, 120), rendering);
  const engine::RenderingModel model(field.view(), rendering, {});
  session::ModelForce force(model);
  Stroker explorer = stroker(subject);
  record::Trace trace;
  const device::ServoOptions options{.limit_ticks = 2000, .fade_ticks = 100};
  const session::Exploration done =
      session::VirtualExplorer().explore(force, field.view().geometry, explorer, options, trace);
  CHECK(done.servo.end == device::ServoEnd::time_limit);
  REQUIRE(trace.samples.size() == 2100);
  CHECK(trace.samples[1999].force_n.z == Approx(0.7).margin(0.02));
  CHECK(trace.samples[2099].force_n == Vec3{});
}

TEST_CASE("stimuli of different sizes are explored on the part that they have in common") {
  const TempFolder folder;
  const engine::RenderingOptions rendering;
  const engine::TextureField wide = engine::make_texture_field(Plane<double>(40, 90), rendering);
  const engine::TextureField high = engine::make_texture_field(Plane<double>(70, 60), rendering);
  engine::PackManifest manifest{std::string(64, 'a'), {}};
  manifest.entries.push_back({"aaaaaaaaaaaaaaaa",
                              engine::write_field(folder.path(), "aaaaaaaaaaaaaaaa", wide.view()),
                              {},
                              {}});
  manifest.entries.push_back({"bbbbbbbbbbbbbbbb",
                              engine::write_field(folder.path(), "bbbbbbbbbbbbbbbb", high.view()),
                              {},
                              {}});
  engine::write_manifest(folder.path(), manifest);
  const session::StimulusSource source(engine::Pack(folder.path()), rendering);
  CHECK(source.plane().height_px == 40);
  CHECK(source.plane().width_px == 60);
}

TEST_CASE("a study refuses a pack of another rendering model") {
  const TinyStudy study;
  engine::RenderingOptions rendering = study.key().study.rendering;
  rendering.model = engine::ModelKind::surface;
  CHECK_THROWS_AS(session::StimulusSource(study.pack(), rendering), FileError);
}

TEST_CASE("a code that the pack lacks is an error that names the code") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  CHECK_THROWS_WITH(source.model("0123456789abcdef"), holds_text("0123456789abcdef"));
}

TEST_CASE("either rendering model in the servo, with ring and hooks, allocates and locks nothing") {
  const std::string rendering = GENERATE(as<std::string>{}, R"({"model": "paper"})",
                                         R"({"model": "surface", "friction": 0.2})");
  CAPTURE(rendering);
  const TinyStudy study({.rendering = rendering});
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  RandomStream random(1, "exploration_test");
  device::SimulatedHand hand = simulation::make_exploring_hand({}, source.plane(), random);
  session::ModelForce force(source.model(study.pack().manifest().entries.front().code));
  device::SampleRing ring(5000);
  device::RingSink sink(ring);
  device::ServoControl control;
  device::LatestValue<device::ServoState> state;
  std::atomic<std::int64_t> heartbeat{0};
  device::FlightRecorder recorder(1.0, device::kServoRateHz);
  device::DurationHistogram lateness;
  device::MotorHeat heat;
  device::LatestValue<device::ServoParameters> parameters;
  device::VirtualClock clock;
  static_cast<void>(take_realtime_offences());
  const device::ServoReport report =
      device::run_servo(hand, force, sink, {.limit_ticks = 4000, .fade_ticks = 0}, clock,
                        {&control, &state, &heartbeat, &recorder, &lateness, &heat, &parameters});
  CHECK(take_realtime_offences() == RealtimeOffences{});
  CHECK(report.ticks == 4000);
  CHECK(report.contact_ticks > 1000);
  CHECK(sink.dropped() == 0);
}

device::ServoSample sample_at(std::int64_t tick, double z_mm = -1.0, double push_n = 0.5) {
  return {{0.1 * static_cast<double>(tick), 2.0, z_mm}, {0.0, 0.0, push_n}, tick};
}

TEST_CASE("a trace without gaps keeps the samples as they came") {
  record::Trace trace;
  session::TraceBuilder builder(trace, 2000.0, 10);
  for (std::int64_t tick = 0; tick < 10; ++tick) builder.add(sample_at(tick));
  REQUIRE(trace.samples.size() == 10);
  CHECK(trace.rate_hz == 2000.0);
  CHECK(trace.samples[7].position_mm.x == Approx(0.7));
  CHECK(builder.held() == 0);
}

TEST_CASE("a gap is filled with the sample before it, so that a sample's index gives its time") {
  record::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 10);
  builder.add(sample_at(0, 5.0, 0.0));
  builder.add(sample_at(3));
  builder.add(sample_at(6));
  REQUIRE(trace.samples.size() == 7);
  CHECK(trace.samples[1].position_mm.z == 5.0);
  CHECK(trace.samples[2].position_mm.z == 5.0);
  CHECK(trace.samples[5].position_mm.x == Approx(0.3));
  CHECK(trace.samples[6].position_mm.x == Approx(0.6));
  CHECK(builder.held() == 4);
  CHECK(builder.held_in_contact() == 2);
}

TEST_CASE("a late first sample fills the gap before it") {
  record::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 10);
  builder.add(sample_at(2));
  REQUIRE(trace.samples.size() == 3);
  CHECK(trace.samples[0].position_mm == trace.samples[2].position_mm);
  CHECK(builder.held() == 2);
}

TEST_CASE("a trace never grows beyond its room and takes no tick twice") {
  record::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 4);
  const auto* const memory = trace.samples.data();
  for (const std::int64_t tick : {0, 1, 1, 0, 2, 9, 3, 4}) builder.add(sample_at(tick));
  CHECK(trace.samples.size() == 4);
  CHECK(trace.samples.data() == memory);
  CHECK(builder.held() == 0);
}

TEST_CASE(
    "landing is the time of the first sample that is low enough, whatever ticks are missing") {
  record::Trace trace;
  session::TraceBuilder builder(trace, 4000.0, 100);
  CHECK_FALSE(builder.landed_at());
  builder.add(sample_at(0, 10.0, 0.0));
  builder.add(sample_at(8, 3.0, 0.0));
  builder.add(sample_at(9, 1.0, 0.5));
  CHECK(builder.landed_at() == std::chrono::milliseconds(2));
}

}  // namespace
}  // namespace touchtrial
