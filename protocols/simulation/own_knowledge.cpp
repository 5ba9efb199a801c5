#include "protocols/simulation/own_knowledge.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace touchtrial::simulation {
namespace {

/// Two participants share a quarter of their passes on average.
constexpr int kPassesToDrawFrom = 4;

/// Draws the same passes for every stimulus, because a pass has the same path on all of them.
FeltKnowledge own_passes(const FeltKnowledge& learnt, int remembered, RandomStream random) {
  const std::size_t prototypes = learnt.label_of_prototype.size();
  const std::size_t passes = learnt.examples.size() / prototypes;
  std::vector<std::size_t> drawn(passes);
  std::iota(drawn.begin(), drawn.end(), std::size_t{0});
  shuffle(std::span(drawn), random);
  drawn.resize(std::min(passes, static_cast<std::size_t>(remembered)));
  FeltKnowledge own;
  own.label_of_prototype = learnt.label_of_prototype;
  for (std::size_t prototype = 0; prototype < prototypes; ++prototype) {
    for (const std::size_t pass : drawn) {
      own.examples.push_back(learnt.examples[prototype * passes + pass]);
    }
  }
  return own;
}

using Errors = std::array<double, engine::kFeltFeatures>;

Errors drawn_errors(double noise, RandomStream& random) {
  Errors errors{};
  for (double& error : errors) error = noise * random.normal();
  return errors;
}

void shift(engine::FeltExample& example, const Errors& errors) {
  for (std::size_t f = 0; f < errors.size(); ++f) example.features[f] += errors[f];
}

/// Adds memory errors, which are the same for all examples of a prototype.
void add_memory_errors(FeltKnowledge& known, double noise, RandomStream random) {
  std::vector<Errors> errors;
  for (std::size_t i = 0; i < known.label_of_prototype.size(); ++i) {
    errors.push_back(drawn_errors(noise, random));
  }
  for (engine::FeltExample& example : known.examples) {
    shift(example, errors[static_cast<std::size_t>(example.label)]);
  }
}

}  // namespace

std::shared_ptr<const FeltKnowledge> learn(const LabelledFields& fields, const study::Study& study,
                                           const SubjectModel& subject, std::uint64_t seed,
                                           int jobs) {
  SubjectModel felt = subject;
  if (subject.training == Training::own) felt.training_passes *= kPassesToDrawFrom;
  return std::make_shared<const FeltKnowledge>(
      learn_by_feeling(fields, felt, study.rendering.max_force_n, seed, jobs));
}

std::shared_ptr<const FeltKnowledge> remembered(const std::shared_ptr<const FeltKnowledge>& learnt,
                                                const SubjectModel& subject, std::uint64_t seed,
                                                int number) {
  const bool has_own = subject.training == Training::own;
  if (!has_own && subject.memory_noise == 0.0) return learnt;
  const auto index = static_cast<std::uint64_t>(number);
  FeltKnowledge known = has_own ? own_passes(*learnt, subject.training_passes,
                                             RandomStream(seed, "subject: own training", index))
                                : *learnt;
  if (subject.memory_noise > 0.0) {
    add_memory_errors(known, subject.memory_noise, RandomStream(seed, "subject: memory", index));
  }
  return std::make_shared<const FeltKnowledge>(std::move(known));
}

}  // namespace touchtrial::simulation
