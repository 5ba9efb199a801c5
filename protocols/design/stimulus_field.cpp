#include "protocols/design/stimulus_field.hpp"

#include "protocols/design/study_sections.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

/// To be raised with every change of the engine that changes fields: all packs are built anew then.
constexpr std::string_view kComputation = "touchtrial field 1";

/// The rendering options that the field's bytes depend on. Gains are not among them: they are
/// applied when the field is felt.
std::string rendering_text(const RenderingOptions& rendering) {
  return nlohmann::json{{"pitch_mm", rendering.pitch_mm},
                        {"filter_mm", rendering.filter_mm},
                        {"neighbourhood", rendering.neighbourhood}}
      .dump();
}

}  // namespace

Digest input_tag(const SecretKey& master, const GreyImage& image, const ExtractionOptions& method,
                 const RenderingOptions& rendering) {
  const Digest input = FieldHasher()
                           .add(kComputation)
                           .add(std::int64_t{image.height()})
                           .add(std::int64_t{image.width()})
                           .add(ByteView(image.samples()))
                           .add(to_json(method).dump())
                           .add(rendering_text(rendering))
                           .finish();
  return keyed_hash(derive_key(master, "input"), ByteView(input));
}

BuiltField build_field(const GreyImage& image, const ExtractionOptions& method,
                       const RenderingOptions& rendering) {
  const Extraction<double> extraction = extract_texture<double>(image, method);
  return {make_texture_field(extraction.texture, rendering), extraction.gap, extraction.steps,
          extraction.converged};
}

bool is_flat(FieldView field) noexcept {
  const float level = field.samples.front().surface;
  return std::ranges::all_of(field.samples, [level](const FieldSample& sample) {
    return sample.force_x == 0.0F && sample.force_y == 0.0F && sample.surface == level;
  });
}

}  // namespace touchtrial
