#include "protocols/simulation/own_knowledge.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/pictured_knowledge.hpp"
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
  CHECK(simulation::remembered(learnt, study.subject, 3, 1) == learnt);
  CHECK(simulation::remembered(learnt, study.subject, 3, 2) == learnt);
}

TEST_CASE("with trainings of their own people remember different passes, alike on all stimuli") {
  LearntStudy study;
  study.subject.training = simulation::Training::own;
  const auto bank = study.learn();
  CHECK(same_knowledge(*bank, *study.learn(1)));
  std::set<std::set<std::size_t>> all;
  std::vector<int> times(16, 0);
  for (int number = 1; number <= 40; ++number) {
    const auto own = simulation::remembered(bank, study.subject, 3, number);
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
  CHECK(same_knowledge(*simulation::remembered(bank, study.subject, 3, 5),
                       *simulation::remembered(bank, study.subject, 3, 5)));
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
    const auto own = simulation::remembered(learnt, study.subject, 3, number);
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

/// What each class's picture shows: any numbers.
simulation::PicturedFeatures any_pictures() {
  simulation::PicturedFeatures pictures;
  RandomStream random(5, "own_knowledge_test");
  for (const char* label : {"bark", "cloth", "pebbles", "straw", "brick"}) {
    for (double& feature : pictures[label]) feature = 3.0 + 2.0 * random.normal();
    pictures[label][7] = 1.0;  // alike in all pictures
  }
  return pictures;
}

/// Of one feature of the prototypes.
struct MeanAndDeviation {
  double mean = 0.0;
  double deviation = 0.0;
};

std::vector<double> prototype_means(const simulation::FeltKnowledge& known, std::size_t feature) {
  std::vector<double> means(known.label_of_prototype.size(), 0.0);
  for (const engine::FeltExample& example : known.examples) {
    means[static_cast<std::size_t>(example.label)] += example.features[feature] / 4.0;
  }
  return means;
}

MeanAndDeviation scale_of(const std::vector<double>& values) {
  MeanAndDeviation scale;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) scale.mean += value / n;
  for (const double value : values) scale.deviation += std::pow(value - scale.mean, 2) / n;
  scale.deviation = std::sqrt(scale.deviation);
  return scale;
}

TEST_CASE("what pictures make expect has the range of what is felt and the order of the pictures") {
  const LearntStudy study;
  const auto felt = study.learn();
  const simulation::PicturedFeatures pictures = any_pictures();
  const simulation::FeltKnowledge expected = simulation::expected_from_pictures(*felt, pictures);
  for (std::size_t f = 0; f < engine::kFeltFeatures; ++f) {
    const std::vector<double> means = prototype_means(expected, f);
    const MeanAndDeviation range = scale_of(prototype_means(*felt, f));
    CHECK(scale_of(means).mean == Approx(range.mean));
    CHECK(scale_of(means).deviation == Approx(f == 7 ? 0.0 : range.deviation).margin(1e-9));
    for (std::size_t one = 0; one < means.size(); ++one) {
      for (std::size_t other = 0; other < means.size(); ++other) {
        const double seen = pictures.at(expected.label_of_prototype[one])[f];
        const double beside = pictures.at(expected.label_of_prototype[other])[f];
        if (seen < beside) CHECK(means[one] <= means[other]);
        if (seen == beside) CHECK(means[one] == Approx(means[other]));
      }
    }
  }
  // From pass to pass, features vary as they are felt to.
  for (std::size_t f = 0; f < engine::kFeltFeatures; ++f) {
    CHECK(expected.examples[1].features[f] - expected.examples[0].features[f] ==
          Approx(felt->examples[1].features[f] - felt->examples[0].features[f]).margin(1e-9));
  }
}

TEST_CASE("a class without a picture cannot be expected") {
  const LearntStudy study;
  simulation::PicturedFeatures pictures = any_pictures();
  pictures.erase("straw");
  CHECK_THROWS_AS(simulation::expected_from_pictures(*study.learn(), pictures),
                  std::invalid_argument);
}

TEST_CASE("mapping noise is the same for all stimuli of a class, and differs between people") {
  LearntStudy study;
  const auto learnt = study.learn();
  study.subject.training = simulation::Training::none;
  CHECK(simulation::remembered(learnt, study.subject, 3, 1) == learnt);
  study.subject.mapping_noise = 0.5;
  const auto one = simulation::remembered(learnt, study.subject, 3, 1);
  const auto other = simulation::remembered(learnt, study.subject, 3, 2);
  const auto error_of = [&](const simulation::FeltKnowledge& known, std::size_t prototype) {
    return known.examples[4 * prototype].features[9] - learnt->examples[4 * prototype].features[9];
  };
  CHECK(error_of(*one, 0) == Approx(error_of(*one, 1)));  // the class's other method
  CHECK(error_of(*one, 0) != Approx(error_of(*one, 2)));
  CHECK(error_of(*one, 0) != Approx(error_of(*other, 0)));
}

TEST_CASE("without training the study's pictures must be there") {
  LearntStudy study;
  study.subject.training = simulation::Training::none;
  CHECK_THROWS_AS(study.learn(), FileError);
}

}  // namespace
}  // namespace touchtrial
