/// \file The force of rendering model `paper` as docs/method.md has it, one equation after the other.
#pragma once

#include "core/vec.hpp"
#include "engine/force_field.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::reference {

class PaperForce {
 public:
  /// Computes all force planes in double precision.
  PaperForce(engine::FieldView field, const engine::RenderingOptions& options, engine::Gains gains);

  /// \param position_mm,velocity_mm_s  finite
  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s) const;

 private:
  /// A value at every pixel, interpolated bilinearly.
  [[nodiscard]] double at(const Plane<double>& values, double x_mm, double y_mm) const;

  PlaneGeometry geometry_;
  engine::RenderingOptions options_;
  engine::Gains gains_;
  Plane<double> heights_;
  engine::ForceField<double> force_;
};

}  // namespace touchtrial::reference
