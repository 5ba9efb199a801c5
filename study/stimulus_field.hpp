/// \file Builds the field of a stimulus from its image, and checks a pack's field against the
/// image.
#pragma once

#include "core/cipher.hpp"
#include "engine/extraction.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/texture_field.hpp"
#include "study/study_key.hpp"

#include <optional>

namespace touchtrial::study {

/// The method of a stimulus, with its own seed for a control. The seed is derived from the
/// study's seed and from the stimulus's label, image and method. Exemplars and methods therefore
/// have different phases, and a stimulus keeps its phases when others are added or removed.
[[nodiscard]] engine::ExtractionOptions method_of(const Study& study,
                                                  const StimulusIndex& stimulus);

/// A keyed hash of everything that determines a field's bytes: pixels, method, model, pitch,
/// filter, neighbourhood (`paper`), and the version of this computation. A field with an equal tag
/// need not be rebuilt.
[[nodiscard]] Digest input_tag(const SecretKey& master, const GreyImage& image,
                               const engine::ExtractionOptions& method,
                               const engine::RenderingOptions& rendering);

/// Whether a field was made from this image by this program's computation, with the stimulus's
/// method and the rendering of the key's study.
/// \param entry  entry of the field in the pack that the key belongs to
/// \throws StudyError if the study does not present the stimulus
[[nodiscard]] bool is_made_from(const engine::PackEntry& entry, const StudyKey& key,
                                const GreyImage& image, const StimulusIndex& stimulus);

/// A field, and the solver's state at its end.
struct BuiltField {
  engine::TextureField field;
  double gap = 0.0;
  int steps = 0;
  bool converged = true;
};

/// Removes the control from a method.
[[nodiscard]] engine::ExtractionOptions without_control(engine::ExtractionOptions method);

/// A texture extracted from an image, reused by stimuli that differ only in their control.
struct ExtractedTexture {
  engine::ExtractionOptions method;  ///< without its control
  engine::Extraction<double> extraction;
};

/// Makes a stimulus's field.
/// \param cache  the last texture, reused if its method is this one and replaced otherwise; may be
///   empty. A flat image neither uses nor changes it.
/// \param keep  whether to keep the texture in `cache` because another stimulus needs it
[[nodiscard]] BuiltField build_field(const GreyImage& image,
                                     const engine::ExtractionOptions& method,
                                     const engine::RenderingOptions& rendering,
                                     std::optional<ExtractedTexture>& cache, bool keep);

/// Whether the field feels like a smooth wall without texture.
[[nodiscard]] bool is_flat(engine::FieldView field) noexcept;

}  // namespace touchtrial::study
