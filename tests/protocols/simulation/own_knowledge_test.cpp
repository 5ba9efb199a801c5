#include "protocols/simulation/own_knowledge.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace touchtrial {
namespace {

/// A tiny study of two methods, which makes two prototypes of each class.
struct LearntStudy {
  LearntStudy()
      : study({.comparison = true, .side_px = 60}),
        source(study.pack(), study.key().study.rendering),
        fields(study.key(), source) {
    subject.explore_s = 1.2;
    subject.training_passes = 4;
  }
  [[nodiscard]] std::shared_ptr<const simulation::FeltKnowledge> learn(int jobs = 2) const {
    return simulation::learn(fields, study.key().study, subject, 3, jobs);
  }

  TinyStudy study;
  session::StimulusSource source;
  simulation::LabelledFields fields;
  simulation::SubjectModel subject;
};

bool same_knowledge(const simulation::FeltKnowledge& one, const simulation::FeltKnowledge& other) {
  return one.label_of_prototype == other.label_of_prototype &&
         std::ranges::equal(one.examples, other.examples, [](const auto& a, const auto& b) {
           return a.label == b.label && a.features == b.features;
         });
}

/// The passes of a bank that somebody remembers of a prototype.
std::set<std::size_t> passes_of(const simulation::FeltKnowledge& own,
                                const simulation::FeltKnowledge& bank, std::size_t prototype) {
  const std::size_t own_passes = own.examples.size() / own.label_of_prototype.size();
  const std::size_t passes = bank.examples.size() / bank.label_of_prototype.size();
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < own_passes; ++i) {
    for (std::size_t pass = 0; pass < passes; ++pass) {
      const auto& example = own.examples[prototype * own_passes + i];
      if (example.features == bank.examples[prototype * passes + pass].features) found.insert(pass);
    }
  }
  return found;
}

TEST_CASE("a shared training is the one explorations of everybody, and nobody has a copy") {
  const LearntStudy study;
  const auto learnt = study.learn();
  const simulation::FeltKnowledge one_by_one =
      simulation::learn_by_feeling(study.fields, study.subject, 3.3, 3, 1);
  CHECK(same_knowledge(*learnt, one_by_one));
  CHECK(simulation::memory_of(learnt, study.subject, 3, 1) == learnt);
  CHECK(simulation::memory_of(learnt, study.subject, 3, 2) == learnt);
}

TEST_CASE("with trainings of their own people remember different passes, alike on all stimuli") {
  LearntStudy study;
  study.subject.training = simulation::Training::own;
  const auto bank = study.learn();
  CHECK(same_knowledge(*bank, *study.learn(1)));
  std::set<std::set<std::size_t>> all;
  std::vector<int> times(16, 0);
  for (int number = 1; number <= 40; ++number) {
    const auto own = simulation::memory_of(bank, study.subject, 3, number);
    CHECK(own->label_of_prototype == bank->label_of_prototype);
    const std::set<std::size_t> passes = passes_of(*own, *bank, 0);
    REQUIRE(passes.size() == 4);
    for (std::size_t prototype = 1; prototype < own->label_of_prototype.size(); ++prototype) {
      CHECK(passes_of(*own, *bank, prototype) == passes);
    }
    all.insert(passes);
    for (const std::size_t pass : passes) ++times[pass];
  }
  CHECK(all.size() > 30);
  // Each of 16 passes by a quarter of 40 people: 10, standard deviation 2.7.
  CHECK(*std::ranges::min_element(times) > 0);
  CHECK(*std::ranges::max_element(times) < 22);
  CHECK(same_knowledge(*simulation::memory_of(bank, study.subject, 3, 5),
                       *simulation::memory_of(bank, study.subject, 3, 5)));
}

TEST_CASE("the shared training's explorations are among those that people draw from") {
  LearntStudy study;
  const auto shared = study.learn();
  study.subject.training = simulation::Training::own;
  const auto bank = study.learn();
  CHECK(passes_of(*shared, *bank, 3) == std::set<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("memory shifts each prototype of each person once, by the noise of the subject file") {
  LearntStudy study;
  const auto learnt = study.learn();
  study.subject.memory_noise = 0.2;
  double squares = 0.0;
  int count = 0;
  for (int number = 1; number <= 20; ++number) {
    const auto own = simulation::memory_of(learnt, study.subject, 3, number);
    for (std::size_t i = 0; i < own->examples.size(); i += 4) {
      for (std::size_t f = 0; f < engine::kFeltFeatures; ++f) {
        const double error = own->examples[i].features[f] - learnt->examples[i].features[f];
        // All passes of a prototype have moved together.
        CHECK(own->examples[i + 3].features[f] - learnt->examples[i + 3].features[f] ==
              Approx(error).margin(1e-12));
        squares += error * error;
        ++count;
      }
    }
  }
  REQUIRE(count == 20 * 10 * engine::kFeltFeatures);
  CHECK(std::sqrt(squares / count) == Approx(0.2).epsilon(4.5 / std::sqrt(2.0 * count)));
}

}  // namespace
}  // namespace touchtrial
