#include "protocols/session/exploration.hpp"

#include "protocols/session/model_force.hpp"

namespace touchtrial {
namespace {

/// Keeps the trace, and passes on to the participant what the device did.
class TrialSink final : public SampleSink {
 public:
  TrialSink(Participant& participant, Trace& trace) : participant_(participant), trace_(trace) {}

  void record(const ServoSample& sample) noexcept override {
    if (!landed_at && sample.position_mm.z <= kLandingHeightMm) {
      landed_at = static_cast<std::int64_t>(trace_.samples.size()) * kServoTick;
    }
    trace_.samples.push_back({sample.position_mm, sample.force_n});
    participant_.feel(sample);
  }

  std::optional<std::chrono::nanoseconds> landed_at;

 private:
  Participant& participant_;
  Trace& trace_;
};

}  // namespace

Exploration explore(const RenderingModel& model, const PlaneGeometry& plane,
                    Participant& participant, const ServoOptions& options, Trace& trace) {
  trace.rate_hz = kServoRateHz;
  trace.samples.clear();
  // Room for every tick there can be: the loop itself never asks for memory.
  trace.samples.reserve(static_cast<std::size_t>(options.limit_ticks + options.fade_ticks));
  HapticDevice& device = participant.begin_exploring(plane);
  ModelForce force(model);
  TrialSink sink(participant, trace);
  Exploration exploration;
  exploration.servo = run_servo_in_virtual_time(device, force, sink, options);
  exploration.landed_at = sink.landed_at;
  return exploration;
}

}  // namespace touchtrial
