#include "protocols/simulation/felt_knowledge.hpp"

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "device/servo/servo.hpp"
#include "protocols/simulation/felt_exploration.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::simulation {
namespace {

/// A training pass has no time limit: it lasts as long as the subject explores.
device::ServoOptions training_options(const SubjectModel& subject, double max_force_n) {
  const auto ticks =
      static_cast<std::int64_t>(std::ceil(subject.explore_s * device::kServoRateHz)) + 1;
  return {.limit_ticks = ticks, .fade_ticks = 0, .limits = {.max_force_n = max_force_n}};
}

}  // namespace

LabelledFields::LabelledFields(const study::StudyCodes& key, const session::StimulusSource& source)
    : plane_(source.plane()), trials_(key.study.trials) {
  for (const study::KeyedStimulus& keyed : key.stimuli) {
    static_cast<void>(source.model(keyed.code));
    fields_.push_back(
        {key.study.classes[keyed.stimulus.class_index].label, keyed.stimulus, &source, keyed.code});
  }
  // Sorted by stimulus, not by code, because training must not depend on the random codes.
  std::ranges::sort(fields_, {}, &LabelledField::stimulus);
}

double LabelledFields::draw_gain_db(RandomStream random) const {
  return trials_.centre_gain_db() + study::draw_rove_db(trials_.rove_db, random);
}

FeltKnowledge learn_by_feeling(const LabelledFields& fields, const SubjectModel& subject,
                               double max_force_n, std::uint64_t seed, int jobs) {
  FeltKnowledge knowledge;
  for (const LabelledField& field : fields.all()) {
    knowledge.label_of_prototype.push_back(field.label);
  }
  const auto passes = static_cast<std::size_t>(subject.training_passes);
  knowledge.examples.resize(fields.all().size() * passes);
  const device::ServoOptions options = training_options(subject, max_force_n);
  // The strokes are the same on every field, so that prototypes differ only by texture, and equal
  // fields have equal prototypes.
  const auto feel_pass = [&](std::size_t pass) {
    RandomStream random(seed, "subject: training pass", pass);
    device::SimulatedHand hand = make_exploring_hand(subject, fields.plane(), random);
    hand.precompute();
    const double gain_db = fields.draw_gain_db({seed, "subject: training gain", pass});
    for (std::size_t prototype = 0; prototype < fields.all().size(); ++prototype) {
      const engine::FeltFeatures felt = feel_exploration(fields.all()[prototype].model(gain_db),
                                                         fields.plane(), subject, options, hand);
      knowledge.examples[prototype * passes + pass] = {static_cast<int>(prototype),
                                                       {felt.begin(), felt.end()}};
    }
  };
  in_parallel(jobs, passes, feel_pass);
  return knowledge;
}

}  // namespace touchtrial::simulation
