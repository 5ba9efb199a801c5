/// \file What `device test` lets a person feel: a plain wall, and a texture made by the program.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::app {

/// Bark, extracted and rendered with the defaults of a study (adaptive method, model `paper`).
class TestTexture {
 public:
  /// \param side_px  of the square plane, at the default pitch; >= 16
  explicit TestTexture(int side_px);

  [[nodiscard]] PlaneGeometry plane() const noexcept { return field_.view().geometry; }
  [[nodiscard]] engine::RenderingModel texture() const noexcept;
  /// The same plane with nothing on it.
  [[nodiscard]] engine::RenderingModel wall() const noexcept;

 private:
  engine::RenderingOptions options_;
  engine::TextureField field_;
  engine::Gains gains_;
};

}  // namespace touchtrial::app
