/// \file What `device test` lets a person feel: a plain wall, and a texture made by the program.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial {

/// Bark, extracted and rendered with the defaults of a study (adaptive method, model `paper`).
class TestTexture {
 public:
  /// \param side_px  of the square plane, at the default pitch; >= 16
  explicit TestTexture(int side_px);

  [[nodiscard]] PlaneGeometry plane() const noexcept { return field_.view().geometry; }
  [[nodiscard]] RenderingModel texture() const noexcept;
  /// The same plane with nothing on it.
  [[nodiscard]] RenderingModel wall() const noexcept;

 private:
  RenderingOptions options_;
  TextureField field_;
  Gains gains_;
};

}  // namespace touchtrial
