/// \file The texture for tests of devices and servos, and a plain wall.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::app {

/// The default picture "bark", extracted and rendered with the defaults of a study (adaptive
/// method, model `paper`).
class TestTexture {
 public:
  /// \param side_px  side of the square plane, at the default pitch; >= 16
  /// \param max_stiffness_n_per_mm  the device's limit for wall and texture; 0: unknown
  explicit TestTexture(int side_px, double max_stiffness_n_per_mm = 0.0);

  [[nodiscard]] PlaneGeometry plane() const noexcept { return field_.view().geometry; }
  /// Models refer to this object, which must outlive them.
  [[nodiscard]] engine::RenderingModel texture() const;
  /// The plane without a texture.
  [[nodiscard]] engine::RenderingModel wall() const;

 private:
  engine::RenderingOptions options_;
  engine::TextureField field_;
  engine::Gains gains_;
};

}  // namespace touchtrial::app
