#include "protocols/session/trace_replay.hpp"

#include "device/replay/replay_device.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/model_force.hpp"
#include "protocols/session/prompt_participant.hpp"
#include "protocols/session/simulated_exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace touchtrial {
namespace {

/// Brings one simulated hand.
class Stroker final : public PromptParticipant {
 public:
  void see_pictures(const std::vector<std::string>&) override {}
  [[nodiscard]] HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    SubjectModel subject;
    subject.explore_s = 2.0;
    RandomStream random(3, "trace_replay_test");
    return hand_.emplace(make_exploring_hand(subject, plane, random));
  }
  void feel(const ServoSample&) noexcept override {}
  [[nodiscard]] ParticipantAnswer answer() override { return {}; }

 private:
  std::optional<SimulatedHand> hand_;
};

class KeepingSink final : public SampleSink {
 public:
  void record(const ServoSample& sample) noexcept override { forces_n.push_back(sample.force_n); }
  std::vector<Vec3> forces_n;
};

TEST_CASE("a stored trial, replayed through its model, calls forth the same forces") {
  const TinyStudy study;
  const StimulusSource source(study.pack(), study.key().study.rendering);
  for (const KeyedStimulus& keyed : study.key().stimuli) {
    const RenderingModel& model = source.model(keyed.code);
    Stroker stroker;
    Trace recorded;
    static_cast<void>(VirtualExplorer().explore(model, source.plane(), stroker, {}, recorded));
    const Trace stored = decode_trace(encode_trace(recorded));

    ReplayDevice replay(std::make_unique<RecordedMotion>(motion_of(stored)));
    ModelForce force(model);
    KeepingSink sink;
    const ServoReport report = run_servo_in_virtual_time(replay, force, sink, {});
    REQUIRE(report.end == ServoEnd::hand_stopped);
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

TEST_CASE("a trace without samples cannot be replayed") {
  CHECK_THROWS_AS(motion_of(Trace()), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
