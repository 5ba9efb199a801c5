#include "protocols/session/exploration.hpp"

#include "protocols/session/model_force.hpp"

namespace touchtrial::session {
namespace {

/// Keeps the trace, and passes on to the participant what the device did.
class TrialSink final : public device::SampleSink {
 public:
  TrialSink(Participant& participant, TraceBuilder& builder)
      : participant_(participant), builder_(builder) {}

  void record(const device::ServoSample& sample) noexcept override {
    builder_.add(sample);
    participant_.feel(sample);
  }

 private:
  Participant& participant_;
  TraceBuilder& builder_;
};

}  // namespace

std::size_t most_samples(const device::ServoOptions& options) noexcept {
  return static_cast<std::size_t>(options.limit_ticks + options.fade_ticks);
}

Exploration VirtualExplorer::explore(const engine::RenderingModel& model,
                                     const PlaneGeometry& plane, Participant& participant,
                                     const device::ServoOptions& options, store::Trace& trace) {
  TraceBuilder builder(trace, options.rate_hz, most_samples(options));
  device::HapticDevice& device = participant.begin_exploring(plane);
  ModelForce force(model);
  TrialSink sink(participant, builder);
  Exploration done;
  done.servo = device::run_servo_in_virtual_time(device, force, sink, options);
  done.landed_at = builder.landed_at();
  done.lasted = time_of_tick(done.servo.ticks, options.rate_hz);
  return done;
}

}  // namespace touchtrial::session
