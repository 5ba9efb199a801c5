#include "protocols/session/felt_knowledge.hpp"

#include "core/random.hpp"
#include "device/servo/servo.hpp"
#include "engine/perception/texture_sense.hpp"
#include "protocols/session/job_arena.hpp"
#include "protocols/session/model_force.hpp"
#include "protocols/session/simulated_exploration.hpp"

#include <cmath>

#include <tbb/parallel_for.h>

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

std::vector<double> feel_once(const RenderingModel& model, const PlaneGeometry& plane,
                              const SubjectModel& subject, double max_force_n,
                              RandomStream random) {
  SimulatedHand hand = make_exploring_hand(subject, plane, random);
  ModelForce force(model);
  SensingSink sink(plane);
  const auto ticks = static_cast<std::int64_t>(std::ceil(subject.explore_s * kServoRateHz)) + 1;
  const ServoOptions options{
      .limit_ticks = ticks, .fade_ticks = 0, .limits = {.max_force_n = max_force_n}};
  // Virtual time and the simulated hand have no faults; a force that is not finite ends the pass,
  // and what was felt until then is what is remembered.
  static_cast<void>(run_servo_in_virtual_time(hand, force, sink, options));
  const FeltFeatures features = sink.sense.features();
  return {features.begin(), features.end()};
}

}  // namespace

FeltKnowledge learn_by_feeling(const LabelledFields& fields, const SubjectModel& subject,
                               double max_force_n, std::uint64_t seed, int jobs) {
  FeltKnowledge knowledge;
  for (const LabelledField& field : fields.all()) {
    knowledge.label_of_prototype.push_back(field.label);
  }
  const auto passes = static_cast<std::size_t>(subject.training_passes);
  knowledge.examples.resize(fields.all().size() * passes);
  const auto feel_example = [&](std::size_t i) {
    const std::size_t prototype = i / passes;
    // The same strokes on every field: what sets prototypes apart is what they are like, and not
    // where they happened to be stroked. Fields without a difference are learnt as equals.
    knowledge.examples[i] = {
        static_cast<int>(prototype),
        feel_once(*fields.all()[prototype].model, fields.plane(), subject, max_force_n,
                  RandomStream(seed, "subject: training pass", i % passes))};
  };
  JobArena(jobs).run(
      [&] { tbb::parallel_for(std::size_t{0}, knowledge.examples.size(), feel_example); });
  return knowledge;
}

}  // namespace touchtrial
