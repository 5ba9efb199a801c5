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

/// The factor on training passes. Two participants share a quarter of their passes on average.
constexpr int kPassFactor = 4;

/// Draws the same passes for every stimulus, because a pass has the same path on all of them.
FeltKnowledge draw_passes(const FeltKnowledge& learnt, int count, RandomStream random) {
  const std::size_t prototypes = learnt.label_of_prototype.size();
  const std::size_t passes = learnt.examples.size() / prototypes;
  std::vector<std::size_t> drawn_passes(passes);
  std::iota(drawn_passes.begin(), drawn_passes.end(), std::size_t{0});
  shuffle(std::span(drawn_passes), random);
  drawn_passes.resize(std::min(passes, static_cast<std::size_t>(count)));
  FeltKnowledge memory;
  memory.label_of_prototype = learnt.label_of_prototype;
  for (std::size_t prototype = 0; prototype < prototypes; ++prototype) {
    for (const std::size_t pass : drawn_passes) {
      memory.examples.push_back(learnt.examples[prototype * passes + pass]);
    }
  }
  return memory;
}

using Errors = std::array<double, engine::kFeltFeatures>;

Errors draw_errors(double noise, RandomStream& random) {
  Errors errors{};
  for (double& error : errors) error = noise * random.normal();
  return errors;
}

void shift(engine::FeltExample& example, const Errors& errors) {
  for (std::size_t f = 0; f < errors.size(); ++f) example.features[f] += errors[f];
}

/// Adds memory errors, which are the same for all examples of a prototype.
void add_memory_errors(FeltKnowledge& knowledge, double noise, RandomStream random) {
  std::vector<Errors> errors;
  for (std::size_t i = 0; i < knowledge.label_of_prototype.size(); ++i) {
    errors.push_back(draw_errors(noise, random));
  }
  for (engine::FeltExample& example : knowledge.examples) {
    shift(example, errors[static_cast<std::size_t>(example.label)]);
  }
}

}  // namespace

std::shared_ptr<const FeltKnowledge> learn(const LabelledFields& fields, const study::Study& study,
                                           const SubjectModel& subject, std::uint64_t seed,
                                           int jobs) {
  SubjectModel trained = subject;
  if (subject.training == Training::own) trained.training_passes *= kPassFactor;
  return std::make_shared<const FeltKnowledge>(
      learn_by_feeling(fields, trained, study.rendering.max_force_n, seed, jobs));
}

std::shared_ptr<const FeltKnowledge> memory_of(const std::shared_ptr<const FeltKnowledge>& learnt,
                                               const SubjectModel& subject, std::uint64_t seed,
                                               int number) {
  const bool has_own = subject.training == Training::own;
  if (!has_own && subject.memory_noise == 0.0) return learnt;
  const auto index = static_cast<std::uint64_t>(number);
  FeltKnowledge knowledge = has_own
                                ? draw_passes(*learnt, subject.training_passes,
                                              RandomStream(seed, "subject: own training", index))
                                : *learnt;
  if (subject.memory_noise > 0.0) {
    add_memory_errors(knowledge, subject.memory_noise,
                      RandomStream(seed, "subject: memory", index));
  }
  return std::make_shared<const FeltKnowledge>(std::move(knowledge));
}

}  // namespace touchtrial::simulation
