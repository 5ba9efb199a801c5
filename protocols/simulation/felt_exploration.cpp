#include "protocols/simulation/felt_exploration.hpp"

#include "engine/perception/texture_sense.hpp"
#include "protocols/session/exploration.hpp"

namespace touchtrial::simulation {
namespace {

constexpr double kLowestStartMm = 10.0;
constexpr double kHighestStartMm = 20.0;

class SensingSink final : public device::SampleSink {
 public:
  explicit SensingSink(const PlaneGeometry& plane) : sense({.plane = plane}) {}

  void record(const device::ServoSample& sample) noexcept override {
    sense.feel(sample.position_mm, sample.force_n);
  }
  engine::TextureSense sense;
};

}  // namespace

device::SimulatedHand make_exploring_hand(const SubjectModel& subject, const PlaneGeometry& plane,
                                          RandomStream& random) {
  device::HandOptions hand;
  hand.push_n = subject.push_n;
  hand.explore_s = subject.explore_s;
  hand.start_height_mm = random.uniform(kLowestStartMm, kHighestStartMm);
  device::ExplorationOptions exploration;
  exploration.slowest_mm_s = subject.slowest_mm_s;
  exploration.fastest_mm_s = subject.fastest_mm_s;
  exploration.duration_s = subject.explore_s;
  return {hand, device::ExplorationPath(plane, exploration, random)};
}

engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                      const PlaneGeometry& plane, const SubjectModel& subject,
                                      const device::ServoOptions& options, RandomStream random) {
  device::SimulatedHand hand = make_exploring_hand(subject, plane, random);
  session::ModelForce force(model);
  SensingSink sink(plane);
  static_cast<void>(device::run_servo_in_virtual_time(hand, force, sink, options));
  return sink.sense.features();
}

}  // namespace touchtrial::simulation
