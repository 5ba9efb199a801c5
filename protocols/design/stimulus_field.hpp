/// \file One stimulus from image to field, and whether a field of a pack was made so.
#pragma once

#include "core/cipher.hpp"
#include "engine/extraction.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/texture_field.hpp"
#include "engine/stage_log.hpp"
#include "protocols/design/study_key.hpp"

#include <optional>

namespace touchtrial::design {

/// A stimulus' method with the seed of its control, which is its own: derived from the study's seed
/// and from what the stimulus is, so that exemplars and methods differ, and that a stimulus keeps
/// its phases when others come or go.
[[nodiscard]] engine::ExtractionOptions method_of(const Study& study,
                                                  const StimulusIndex& stimulus);

/// A keyed hash of everything that decides a field's bytes: pixels, method, model, pitch, filter,
/// neighbourhood (`paper`), and the version of this computation. Equal tags: the field need not be
/// built.
[[nodiscard]] Digest input_tag(const SecretKey& master, const GreyImage& image,
                               const engine::ExtractionOptions& method,
                               const engine::RenderingOptions& rendering);

/// Whether a field was made from this image by the stimulus's method and the study's rendering, as
/// the key's study has them and by the computation of this program.
/// \param entry  the field's, in the pack that the key belongs to
/// \throws StudyError if the study does not present the stimulus
[[nodiscard]] bool is_made_from(const engine::PackEntry& entry, const StudyKey& key,
                                const GreyImage& image, const StimulusIndex& stimulus);

/// A field with what the solver said of it.
struct BuiltField {
  engine::TextureField field;
  double gap = 0.0;
  int steps = 0;
  bool converged = true;
};

/// The same method without a control.
[[nodiscard]] engine::ExtractionOptions without_control(engine::ExtractionOptions method);

/// A texture that has been taken from an image, for stimuli of the same image that differ in their
/// control only.
struct TakenTexture {
  engine::ExtractionOptions method;  ///< without its control
  engine::Extraction<double> extraction;
};

/// \param taken  used if it is of this method, replaced if not; nothing may have been taken yet. A
///   flat image needs none, and changes nothing of it.
/// \param keep  whether the texture is to be left there: another stimulus needs it
/// \param log  takes the stages, if there is one
[[nodiscard]] BuiltField build_field(const GreyImage& image,
                                     const engine::ExtractionOptions& method,
                                     const engine::RenderingOptions& rendering,
                                     std::optional<TakenTexture>& taken, bool keep,
                                     engine::StageLog* log);

/// Whether nothing can be felt in the field but a smooth wall.
[[nodiscard]] bool is_flat(engine::FieldView field) noexcept;

}  // namespace touchtrial::design
