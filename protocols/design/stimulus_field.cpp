#include "protocols/design/stimulus_field.hpp"

#include "core/random.hpp"
#include "engine/cited_textures.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::design {
namespace {

/// Raise this number with every change of the engine that changes fields; all packs are then
/// rebuilt.
constexpr std::string_view kComputation = "touchtrial field 3";

/// The rendering options that the field's bytes depend on. Gains are not among them, because they
/// are applied when the field is felt.
std::string rendering_text(const engine::RenderingOptions& rendering) {
  nlohmann::json text{{"model", name_in(kModelNames, rendering.model)},
                      {"pitch_mm", rendering.pitch_mm},
                      {"filter_mm", rendering.filter_mm}};
  if (rendering.model == engine::ModelKind::paper) text["neighbourhood"] = rendering.neighbourhood;
  return text.dump();
}

engine::TextureField rendered(Plane<double> texture, const engine::RenderingOptions& rendering,
                              engine::StageLog* log) {
  engine::StageTimer timer(log);
  engine::TextureField field = engine::make_texture_field(texture, rendering);
  const double sigma_px = to_px(rendering.filter_mm, rendering.pitch_mm);
  timer.done(rendering.model == engine::ModelKind::paper ? "filter" : "filter, spline",
             sigma_px > 0.0 ? "a Gaussian of " + number_text(sigma_px) + " px first"
                            : "unfiltered: there is nothing to filter, or filter_mm is 0",
             field.view().heights.size_bytes());
  if (log != nullptr) {
    log->skip("force planes", "forces follow from the heights at the stylus",
              2 * field.view().heights.size_bytes());
  }
  return field;
}

/// The texture of a flat image: a constant level for luminance, zero for every other method.
Plane<double> flat_texture(const GreyImage& image, const engine::ExtractionOptions& method) {
  const double level = method.method == engine::Method::luminance
                           ? engine::luminance_texture<double>(image).at(0, 0)
                           : 0.0;
  return {image.height(), image.width(), level};
}

/// The field of a flat image. Neither control nor filter changes a constant level.
BuiltField flat_field(const GreyImage& image, const engine::ExtractionOptions& method,
                      engine::RenderingOptions rendering, engine::StageLog* log) {
  if (log != nullptr) {
    const std::uint64_t plane = image.size() * sizeof(double);
    log->skip("sub-bands", "the image is flat", plane);
    log->skip("order map", "the image is flat", plane / 4);
    for (const char* stage : {"texture", "control", "filter"}) {
      log->skip(stage, "the image is flat", plane);
    }
  }
  rendering.filter_mm = 0.0;
  return {rendered(flat_texture(image, method), rendering, log)};
}

void take_texture(const GreyImage& image, const engine::ExtractionOptions& method,
                  std::optional<TakenTexture>& taken, engine::StageLog* log) {
  if (taken && taken->method == method) {
    if (log != nullptr) {
      log->reuse("texture", "taken for another stimulus of this image",
                 image.size() * sizeof(double));
    }
    return;
  }
  taken.reset();
  taken = TakenTexture{method, engine::extract_texture<double>(image, method, {}, log)};
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
  const StudyClass& shown = study.classes[static_cast<std::size_t>(stimulus.class_index)];
  const auto& image = shown.images[static_cast<std::size_t>(stimulus.exemplar)];
  const Digest identity =
      FieldHasher().add(shown.label).add(image.string()).add(method.label).finish();
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
                       std::optional<TakenTexture>& taken, bool keep, engine::StageLog* log) {
  if (is_flat(image)) return flat_field(image, method, rendering, log);
  take_texture(image, without_control(method), taken, log);
  engine::Extraction<double> extraction;
  if (keep) {
    extraction = taken->extraction;
  } else {
    extraction = std::move(taken->extraction);
    taken.reset();
  }
  if (method.control == engine::Control::none && log != nullptr) {
    log->skip("control", "none asked for", image.size() * sizeof(double));
  }
  engine::apply_control(method, extraction.texture, log);
  return {rendered(std::move(extraction.texture), rendering, log), extraction.gap, extraction.steps,
          extraction.converged};
}

bool is_flat(engine::FieldView field) noexcept {
  const float level = field.heights.front();
  return std::ranges::all_of(field.heights, [level](float height) { return height == level; });
}

}  // namespace touchtrial::design
