#include "protocols/session/felt_exploration.hpp"

#include "engine/perception/texture_sense.hpp"
#include "protocols/session/model_force.hpp"
#include "protocols/session/simulated_exploration.hpp"

namespace touchtrial {
namespace {

class SensingSink final : public SampleSink {
 public:
  explicit SensingSink(const PlaneGeometry& plane) : sense({.plane = plane}) {}

  void record(const ServoSample& sample) noexcept override {
    sense.feel(sample.position_mm, sample.force_n);
  }
  TextureSense sense;
};

}  // namespace

FeltFeatures feel_exploration(const RenderingModel& model, const PlaneGeometry& plane,
                              const SubjectModel& subject, const ServoOptions& options,
                              RandomStream random) {
  SimulatedHand hand = make_exploring_hand(subject, plane, random);
  ModelForce force(model);
  SensingSink sink(plane);
  static_cast<void>(run_servo_in_virtual_time(hand, force, sink, options));
  return sink.sense.features();
}

}  // namespace touchtrial
