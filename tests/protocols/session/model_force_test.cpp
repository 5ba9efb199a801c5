// The force of a study's models, in the servo as sessions run it, asks for no memory and no lock.
#include "protocols/session/model_force.hpp"

#include "device/servo/duration_histogram.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/sample_ring.hpp"
#include "protocols/session/simulated_exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <atomic>
#include <string>

namespace touchtrial {
namespace {

TEST_CASE("either rendering model in the servo, with its ring and hooks, asks for no memory") {
  const std::string rendering = GENERATE(as<std::string>{}, R"({"model": "paper"})",
                                         R"({"model": "surface", "friction": 0.2})");
  CAPTURE(rendering);
  const TinyStudy study({.rendering = rendering});
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  RandomStream random(1, "model_force_test");
  device::SimulatedHand hand = session::make_exploring_hand({}, source.plane(), random);
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

}  // namespace
}  // namespace touchtrial
