#include "protocols/session/felt_exploration.hpp"

#include "engine/perception/texture_sense.hpp"
#include "protocols/session/model_force.hpp"
#include "protocols/session/simulated_exploration.hpp"

namespace touchtrial::session {
namespace {

class SensingSink final : public device::SampleSink {
 public:
  explicit SensingSink(const PlaneGeometry& plane) : sense({.plane = plane}) {}

  void record(const device::ServoSample& sample) noexcept override {
    sense.feel(sample.position_mm, sample.force_n);
  }
  engine::TextureSense sense;
};

}  // namespace

engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                      const PlaneGeometry& plane, const SubjectModel& subject,
                                      const device::ServoOptions& options, RandomStream random) {
  device::SimulatedHand hand = make_exploring_hand(subject, plane, random);
  ModelForce force(model);
  SensingSink sink(plane);
  static_cast<void>(device::run_servo_in_virtual_time(hand, force, sink, options));
  return sink.sense.features();
}

}  // namespace touchtrial::session
