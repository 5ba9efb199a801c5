#include "device/drivers/replay/replay_device.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/stroker.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

class KeepingSink final : public device::SampleSink {
 public:
  void record(const device::ServoSample& sample) noexcept override {
    forces_n.push_back(sample.force_n);
  }
  std::vector<Vec3> forces_n;
};

/// The positions of a trace. Under the same model and servo options they give the trace's forces
/// again, to within its quantisation. This does not hold if the model uses velocities, because a
/// replay computes them from differences of positions.
device::RecordedMotion motion_of(const record::Trace& trace) {
  std::vector<Vec3> positions_mm;
  for (const record::TraceSample& sample : trace.samples)
    positions_mm.push_back(sample.position_mm);
  return {std::move(positions_mm), trace.rate_hz};
}

TEST_CASE("a stored trial, replayed through its model, gives the same forces") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  simulation::SubjectModel subject{.explore_s = 2.0};
  for (const study::KeyedStimulus& keyed : study.key().stimuli) {
    const engine::RenderingModel& model = source.model(keyed.code);
    Stroker stroker(RandomStream(3, "trace_replay_test"), subject);
    record::Trace recorded;
    session::ModelForce first(model);
    static_cast<void>(
        session::VirtualExplorer().explore(first, source.plane(), stroker, {}, recorded));
    const record::Trace stored = record::decode_trace(record::encode_trace(recorded));

    device::ReplayDevice replay(motion_of(stored));
    session::ModelForce force(model);
    KeepingSink sink;
    const device::ServoReport report = device::run_servo_in_virtual_time(replay, force, sink, {});
    REQUIRE(report.end == device::ServoEnd::hand_stopped);
    REQUIRE(sink.forces_n.size() == stored.samples.size());
    double worst_n = 0.0;
    double strongest_n = 0.0;
    for (std::size_t i = 0; i < sink.forces_n.size(); ++i) {
      worst_n = std::max(worst_n, norm(sink.forces_n[i] - stored.samples[i].force_n));
      strongest_n = std::max(strongest_n, norm(sink.forces_n[i]));
    }
    // 0.5 um in each direction under 0.4 N/mm of wall and texture, and the trace's steps of force.
    CHECK(worst_n < 0.0015);
    CHECK(strongest_n > 0.5);
  }
}

}  // namespace
}  // namespace touchtrial
