#include "analysis/measures/picture_set.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/metrics/ssim.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

struct ProcessedPicture {
  const LabelledPicture* picture;
  GreyImage texture;
  engine::TextureField field;
};

engine::GlcmStatistics mean_over_directions(const GreyImage& image) {
  engine::GlcmStatistics mean{};
  const engine::GlcmTable table = engine::glcm_statistics(image);
  const double share = 1.0 / static_cast<double>(table.size());
  for (const engine::GlcmStatistics& statistics : table) {
    mean.angular_second_moment += share * statistics.angular_second_moment;
    mean.energy += share * statistics.energy;
    mean.entropy += share * statistics.entropy;
    mean.contrast += share * statistics.contrast;
    mean.correlation += share * statistics.correlation;
  }
  return mean;
}

ProcessedPicture process_picture(const LabelledPicture& picture,
                                 const engine::ExtractionOptions& method,
                                 const engine::RenderingOptions& rendering) {
  const engine::Extraction<double> extraction =
      engine::extract_texture<double>(picture.image, method);
  return {&picture, engine::texture_picture(extraction.texture),
          engine::make_texture_field(extraction.texture, rendering)};
}

PictureMeasures measures_of(const ProcessedPicture& processed, engine::Gains gains) {
  PictureMeasures measures;
  measures.set = processed.picture->set;
  measures.label = processed.picture->label;
  measures.name = processed.picture->name;
  const Plane<double> greys = converted<double>(processed.picture->image);
  measures.mean = mean_of(greys);
  measures.deviation =
      standard_deviation(greys.samples(), measures.mean, static_cast<double>(greys.size()));
  measures.slope = engine::spectrum_slope(processed.picture->image);
  measures.original = mean_over_directions(processed.picture->image);
  measures.texture = mean_over_directions(processed.texture);
  const engine::FieldStatistics statistics =
      engine::field_statistics(processed.field.view(), gains);
  measures.force_rms_n = statistics.tangential_rms_n;
  measures.renderable_share = 1.0 - statistics.share_below_1_mm;
  return measures;
}

GreyImage corner_of(const GreyImage& image, int height, int width) {
  if (image.height() == height && image.width() == width) return image;
  GreyImage corner(height, width);
  for (int y = 0; y < height; ++y) {
    std::ranges::copy(image.row(y).first(static_cast<std::size_t>(width)), corner.row(y).begin());
  }
  return corner;
}

double similarity_of_pair(const GreyImage& a, const GreyImage& b) {
  const int height = std::min(a.height(), b.height());
  const int width = std::min(a.width(), b.width());
  return engine::ms_ssim<float>(corner_of(a, height, width), corner_of(b, height, width)).unit;
}

void add_pair(PairMean& mean, double value) {
  ++mean.pairs;
  mean.mean += (value - mean.mean) / mean.pairs;
}

using ProcessedSet = std::vector<const ProcessedPicture*>;

bool is_large_enough(const ProcessedSet& set) {
  return std::ranges::all_of(set, [](const ProcessedPicture* processed) {
    const GreyImage& image = processed->picture->image;
    return std::min(image.height(), image.width()) >= engine::kMsSsimSmallestSide;
  });
}

template <typename PairDone>
Similarity similarity_in(const ProcessedSet& set, const PairDone& pair_done) {
  Similarity similarity;
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool is_within_class = set[i]->picture->label == set[j]->picture->label;
      add_pair(is_within_class ? similarity.original_within : similarity.original_between,
               similarity_of_pair(set[i]->picture->image, set[j]->picture->image));
      add_pair(is_within_class ? similarity.texture_within : similarity.texture_between,
               similarity_of_pair(set[i]->texture, set[j]->texture));
      pair_done();
    }
  }
  return similarity;
}

std::vector<std::pair<std::string, ProcessedSet>> sets_of(
    const std::vector<ProcessedPicture>& all) {
  std::vector<std::pair<std::string, ProcessedSet>> sets;
  for (const ProcessedPicture& processed : all) {
    const auto has_name = [&](const auto& set) { return set.first == processed.picture->set; };
    auto set = std::ranges::find_if(sets, has_name);
    if (set == sets.end()) set = sets.insert(set, {processed.picture->set, {}});
    set->second.push_back(&processed);
  }
  return sets;
}

engine::Gains gains_of(const ProcessedSet& set, const engine::RenderingOptions& rendering) {
  std::vector<engine::FieldView> fields;
  for (const ProcessedPicture* processed : set) fields.push_back(processed->field.view());
  return engine::choose_gains(fields, rendering).per_field.front();
}

template <typename PairDone>
SetMeasures measures_of_set(const std::string& name, const ProcessedSet& set,
                            const PairDone& pair_done) {
  SetMeasures measures;
  measures.set = name;
  measures.pictures = static_cast<int>(set.size());
  std::set<std::string> labels;
  for (const ProcessedPicture* processed : set) labels.insert(processed->picture->label);
  measures.classes = static_cast<int>(labels.size());
  if (is_large_enough(set)) measures.similarity = similarity_in(set, pair_done);
  return measures;
}

int pairs_in(const std::vector<std::pair<std::string, ProcessedSet>>& sets) {
  int pairs = 0;
  for (const auto& [name, set] : sets) {
    const auto count = static_cast<int>(set.size());
    if (is_large_enough(set)) pairs += count * (count - 1) / 2;
  }
  return pairs;
}

}  // namespace

MeasuredPictures measure_pictures(std::span<const LabelledPicture> pictures,
                                  const engine::ExtractionOptions& method,
                                  engine::RenderingOptions rendering,
                                  const std::function<void(int finished, int total)>& progress) {
  if (pictures.empty()) throw std::invalid_argument("measure_pictures needs at least one picture");
  rendering.equalise = engine::Equalise::none;
  std::vector<ProcessedPicture> all;
  for (const LabelledPicture& picture : pictures)
    all.push_back(process_picture(picture, method, rendering));
  const auto sets = sets_of(all);
  const int steps = pairs_in(sets);
  int finished_pairs = 0;
  const auto pair_done = [&] {
    if (progress) progress(++finished_pairs, steps);
  };
  const engine::Gains gains = gains_of(sets.front().second, rendering);
  MeasuredPictures measured;
  measured.tangential_gain_n = gains.tangential_n;
  for (const ProcessedPicture& processed : all)
    measured.pictures.push_back(measures_of(processed, gains));
  for (const auto& [name, set] : sets) {
    measured.sets.push_back(measures_of_set(name, set, pair_done));
  }
  return measured;
}

}  // namespace touchtrial::analysis
