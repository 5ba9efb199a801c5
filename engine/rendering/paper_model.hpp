/// \file Rendering model `paper`: wall by Hooke's law, plus c*(G - G_ref), plus tangential force.
/// Source: docs/method.md, "Rendering models" (paper Eqs. 9-13).
#pragma once

#include "core/vec.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::engine {

/// The force on the stylus from one texture. Evaluated by the servo a thousand times a second.
/// Plane frame, millimetres: x and y along the texture from its top-left corner, z out of the plane
/// towards the hand; depth = -z.
class PaperModel {
 public:
  /// Reads no sample: of a mapped field only the pages that the stylus touches come into memory.
  /// \param field  its samples must outlive the model; height_px * width_px of them
  /// \param options,gains  finite, in the ranges of their types
  PaperModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept;

  /// The elastic force k * depth + c * (G - G_ref) makes contact while it is positive (with
  /// reference_grey 0: and depth is). In contact F_N = elastic force - damping * v_z, and F_T =
  /// k_t * (force planes); both are bilinear between pixel centres, and constant across the outer
  /// half pixel. The whole is limited in norm to max_force_n, direction kept. Damping neither
  /// pulls (F_N <= 0 is no force of any kind) nor acts above the surface.
  /// Beyond the plane's edge: the flat wall, k * depth - damping * v_z.
  /// No contact: zero force; and the field is not read where no surface could reach the hand.
  /// A position or velocity that is not finite gives zero force. No allocation, lock or exception;
  /// any number of threads. Cost: about 20 ns.
  [[nodiscard]] Vec3 force_n(Vec3 position_mm, Vec3 velocity_mm_s) const noexcept;

 private:
  /// Whether no surface of this field could touch a hand that meets the wall with this force.
  [[nodiscard]] bool is_out_of_reach(double wall_n) const noexcept;

  FieldView field_;
  double stiffness_n_per_mm_;
  double damping_n_s_per_mm_;
  double reference_grey_;
  double max_force_n_;
  Gains gains_;
};

}  // namespace touchtrial::engine
