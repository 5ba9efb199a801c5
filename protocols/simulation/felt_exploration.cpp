#include "protocols/simulation/felt_exploration.hpp"

#include "protocols/session/exploration.hpp"

#include <cmath>

namespace touchtrial::simulation {
namespace {

constexpr double kMinStartMm = 10.0;
constexpr double kMaxStartMm = 20.0;

class SensingSink final : public device::SampleSink {
 public:
  explicit SensingSink(HandSense& sense) : sense_(sense) {}
  void record(const device::ServoSample& sample) noexcept override { sense_.feel(sample); }

 private:
  HandSense& sense_;
};

}  // namespace

HandSense::HandSense(const SubjectModel& subject)
    : feels_forces_(!subject.sense), sense_({.curve = subject.sense}) {}

void HandSense::begin(device::SimulatedHand& hand, const PlaneGeometry& plane) {
  sense_.reset(plane);
  if (!feels_forces_) hand.set_sense(*this);
}

void HandSense::feel(const device::ServoSample& sample) noexcept {
  if (feels_forces_) sense_.feel(sample.position_mm, sample.force_n);
}

void HandSense::feel(const Vec3& position_mm, const Vec3& force_n,
                     const Vec3& acceleration_m_s2) noexcept {
  sense_.feel(position_mm, force_n, acceleration_m_s2);
}

device::HandFactors hand_of_participant(const SubjectModel& subject, std::uint64_t seed,
                                        std::uint64_t number) {
  if (subject.hand_spread == 0.0) return {};
  RandomStream random(seed, "subject: hand", number);
  device::HandFactors hand;
  hand.stiffness = std::exp(subject.hand_spread * random.normal());
  hand.damping = std::exp(subject.hand_spread * random.normal());
  hand.mass = std::exp(subject.hand_spread * random.normal());
  return hand;
}

device::SimulatedHand make_exploring_hand(const SubjectModel& subject, const PlaneGeometry& plane,
                                          RandomStream& random,
                                          const device::HandFactors& factors) {
  device::HandOptions hand;
  hand.model = subject.hand;
  hand.factors = factors;
  hand.push_n = subject.push_n;
  hand.explore_s = subject.explore_s;
  hand.start_height_mm = random.uniform(kMinStartMm, kMaxStartMm);
  device::ExplorationOptions exploration;
  exploration.slowest_mm_s = subject.slowest_mm_s;
  exploration.fastest_mm_s = subject.fastest_mm_s;
  exploration.duration_s = subject.explore_s;
  return {hand, device::ExplorationPath(plane, exploration, random), subject.device};
}

engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                      const PlaneGeometry& plane, const SubjectModel& subject,
                                      const device::ServoOptions& options,
                                      device::SimulatedHand hand) {
  session::ModelForce force(model);
  HandSense sense(subject);
  sense.begin(hand, plane);
  SensingSink sink(sense);
  static_cast<void>(device::run_servo_in_virtual_time(hand, force, sink, options));
  return sense.features();
}

engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                      const PlaneGeometry& plane, const SubjectModel& subject,
                                      const device::ServoOptions& options, RandomStream random,
                                      const device::HandFactors& factors) {
  return feel_exploration(model, plane, subject, options,
                          make_exploring_hand(subject, plane, random, factors));
}

}  // namespace touchtrial::simulation
