#include "study/stimulus_field.hpp"

#include "core/random.hpp"
#include "engine/cited_textures.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::study {
namespace {

/// Increment this number whenever a change of the engine changes fields, so that packs are rebuilt.
constexpr std::string_view kComputation = "touchtrial field 3";

/// The rendering options that affect a field's bytes. Gains do not, because they are applied when
/// the field is felt.
std::string rendering_text(const engine::RenderingOptions& rendering) {
  nlohmann::json text{{"model", name_in(kModelNames, rendering.model)},
                      {"pitch_mm", rendering.pitch_mm},
                      {"filter_mm", rendering.filter_mm}};
  if (rendering.model == engine::ModelKind::paper) text["neighbourhood"] = rendering.neighbourhood;
  return text.dump();
}

/// The texture of a flat image: a constant level for luminance, zero for every other method.
touchtrial::Plane<double> flat_texture(const GreyImage& image,
                                       const engine::ExtractionOptions& method) {
  const double level = method.method == engine::Method::luminance
                           ? engine::luminance_texture<double>(image).at(0, 0)
                           : 0.0;
  return {image.height(), image.width(), level};
}

/// The field of a flat image. Neither control nor filter changes a constant level.
BuiltField flat_field(const GreyImage& image, const engine::ExtractionOptions& method,
                      engine::RenderingOptions rendering) {
  rendering.filter_mm = 0.0;
  return {engine::make_texture_field(flat_texture(image, method), rendering)};
}

void ensure_extracted(const GreyImage& image, const engine::ExtractionOptions& method,
                      std::optional<ExtractedTexture>& cache) {
  if (cache && cache->method == method) return;
  cache.reset();
  cache = ExtractedTexture{method, engine::extract_texture<double>(image, method)};
}

}  // namespace

Digest input_tag(const SecretKey& master, const GreyImage& image,
                 const engine::ExtractionOptions& method,
                 const engine::RenderingOptions& rendering) {
  FieldHasher hasher;
  hasher.add(kComputation).add(std::int64_t{image.height()}).add(std::int64_t{image.width()});
  hasher.add(ByteView(image.samples())).add(to_json(method).dump()).add(rendering_text(rendering));
  if (method.control != engine::Control::none) {
    hasher.add(static_cast<std::int64_t>(method.control_seed));
  }
  const Digest input = hasher.finish();
  return keyed_hash(derive_key(master, "input"), ByteView(input));
}

bool is_made_from(const engine::PackEntry& entry, const StudyKey& key, const GreyImage& image,
                  const StimulusIndex& stimulus) {
  return entry.code == key.code_of(stimulus) &&
         entry.input_tag ==
             input_tag(key.master, image, method_of(key.study, stimulus), key.study.rendering);
}

engine::ExtractionOptions method_of(const Study& study, const StimulusIndex& stimulus) {
  const auto& method = study.methods[static_cast<std::size_t>(stimulus.method)];
  engine::ExtractionOptions options = method;
  if (options.control == engine::Control::none) return options;
  const StudyClass& study_class = study.class_at(stimulus.class_index);
  if (study.is_practice_class(stimulus.class_index)) {
    options.control_seed =
        RandomStream(study.seed, "control of practice " + study_class.label).bits();
    return options;
  }
  const auto& image = study_class.images[static_cast<std::size_t>(stimulus.exemplar)];
  const Digest identity =
      FieldHasher().add(study_class.label).add(image.string()).add(method.label).finish();
  options.control_seed = RandomStream(study.seed, "control of " + to_hex(identity)).bits();
  return options;
}

engine::ExtractionOptions without_control(engine::ExtractionOptions method) {
  method.control = engine::Control::none;
  method.control_seed = 0;
  return method;
}

BuiltField build_field(const GreyImage& image, const engine::ExtractionOptions& method,
                       const engine::RenderingOptions& rendering,
                       std::optional<ExtractedTexture>& cache, bool keep) {
  if (is_flat(image)) return flat_field(image, method, rendering);
  ensure_extracted(image, without_control(method), cache);
  engine::Extraction<double> extraction;
  if (keep) {
    extraction = cache->extraction;
  } else {
    extraction = std::move(cache->extraction);
    cache.reset();
  }
  engine::apply_control(method, extraction.texture);
  return {engine::make_texture_field(extraction.texture, rendering), extraction.gap,
          extraction.steps, extraction.converged};
}

bool is_flat(engine::FieldView field) noexcept {
  const float level = field.heights.front();
  return std::ranges::all_of(field.heights, [level](float height) { return height == level; });
}

}  // namespace touchtrial::study
