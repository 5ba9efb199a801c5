#include "protocols/simulation/pictured_knowledge.hpp"

#include "engine/image_file.hpp"
#include "engine/perception/picture_features.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace touchtrial::simulation {
namespace {

using engine::FeltFeatures;

/// Mean and standard deviation of each feature.
struct FeatureScale {
  FeltFeatures mean{};
  FeltFeatures deviation{};

  explicit FeatureScale(const std::vector<FeltFeatures>& all) {
    const auto count = static_cast<double>(all.size());
    for (std::size_t f = 0; f < mean.size(); ++f) {
      for (const FeltFeatures& one : all) mean[f] += one[f] / count;
      double squares = 0.0;
      for (const FeltFeatures& one : all) squares += (one[f] - mean[f]) * (one[f] - mean[f]);
      deviation[f] = std::sqrt(squares / count);
    }
  }
};

std::vector<FeltFeatures> means_by_prototype(const FeltKnowledge& felt) {
  std::vector<FeltFeatures> means(felt.label_of_prototype.size(), FeltFeatures{});
  const double passes =
      static_cast<double>(felt.examples.size()) / static_cast<double>(means.size());
  for (const engine::FeltExample& example : felt.examples) {
    FeltFeatures& mean = means[static_cast<std::size_t>(example.label)];
    for (std::size_t f = 0; f < mean.size(); ++f) mean[f] += example.features[f] / passes;
  }
  return means;
}

std::vector<FeltFeatures> values_of(const PicturedFeatures& pictures) {
  std::vector<FeltFeatures> values;
  for (const auto& [label, features] : pictures) values.push_back(features);
  return values;
}

}  // namespace

PicturedFeatures look_at_pictures(const design::Study& study) {
  PicturedFeatures pictures;
  for (const design::StudyClass& one : study.classes) {
    pictures[one.label] = engine::features_of_picture(
        engine::read_grey_image(study.folder / one.images.front()), study.rendering.pitch_mm);
  }
  return pictures;
}

FeltKnowledge expected_from_pictures(const FeltKnowledge& felt, const PicturedFeatures& pictures) {
  const std::vector<FeltFeatures> felt_means = means_by_prototype(felt);
  const FeatureScale seen(values_of(pictures));
  const FeatureScale range(felt_means);
  FeltKnowledge expected = felt;
  for (engine::FeltExample& example : expected.examples) {
    const auto prototype = static_cast<std::size_t>(example.label);
    const auto picture = pictures.find(felt.label_of_prototype[prototype]);
    if (picture == pictures.end()) {
      throw std::invalid_argument("expected_from_pictures: a class has no picture");
    }
    for (std::size_t f = 0; f < range.mean.size(); ++f) {
      const double above = picture->second[f] - seen.mean[f];
      const double standard = seen.deviation[f] > 0.0 ? above / seen.deviation[f] : 0.0;
      example.features[f] +=
          range.mean[f] + range.deviation[f] * standard - felt_means[prototype][f];
    }
  }
  return expected;
}

}  // namespace touchtrial::simulation
