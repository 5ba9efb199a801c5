/// \file One stimulus from image to field. Private to protocols/design.
#pragma once

#include "core/cipher.hpp"
#include "engine/extraction.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial {

/// A keyed hash of everything that decides a field's bytes: pixels, method, pitch, filter,
/// neighbourhood, and the version of this computation. Equal tags: the field need not be built.
[[nodiscard]] Digest input_tag(const SecretKey& master, const GreyImage& image,
                               const ExtractionOptions& method, const RenderingOptions& rendering);

/// A field with what the solver said of it.
struct BuiltField {
  TextureField field;
  double gap = 0.0;
  int steps = 0;
  bool converged = true;
};

[[nodiscard]] BuiltField build_field(const GreyImage& image, const ExtractionOptions& method,
                                     const RenderingOptions& rendering);

/// Whether nothing can be felt in the field but a smooth wall.
[[nodiscard]] bool is_flat(FieldView field) noexcept;

}  // namespace touchtrial
