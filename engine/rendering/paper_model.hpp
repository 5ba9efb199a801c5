/// \file Rendering model `paper`: a wall by Hooke's law, plus c * (G - G_ref), plus the tangential
/// force. Source: docs/method.md, "Rendering" (paper Eqs. 9-13).
#pragma once

#include "core/vec.hpp"
#include "engine/rendering/patch.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::engine {

/// The force on the stylus from one texture, evaluated by the servo at 1 kHz.
/// Plane frame, millimetres: x and y along the texture from its top-left corner, z out of the plane
/// towards the hand; depth = -z.
class PaperModel {
 public:
  /// Reads no samples, so that only touched pages of a mapped field are loaded.
  /// \param field  its heights must outlive the model
  /// \param options,gains  finite, in the ranges of their types
  /// \throws Error if Highway's library cannot be loaded
  PaperModel(FieldView field, const RenderingOptions& options, Gains gains);

  /// Contact lasts while the elastic force k * depth + c * (G - G_ref) is positive; with
  /// reference_grey 0, depth must be positive too. In contact F_N = elastic force - damping * v_z
  /// and F_T = k_t * tangential_force(heights), both bilinear between pixel centres and constant
  /// across the outer half pixel; G = 128 + T. Forces are computed from the heights around the
  /// stylus. Below a load of touchdown_ramp_n F_T is multiplied by load / touchdown_ramp_n; the
  /// load is the smaller of elastic force and F_N. The norm of the total is limited to max_force_n;
  /// its direction is kept.
  ///
  /// Damping never pulls (no force if F_N <= 0) and never acts above the surface. Beyond the
  /// plane's edge is the flat wall, k * depth - damping * v_z. Without contact the force is zero.
  /// The field is not read above its highest point. A position or velocity that is not finite gives
  /// zero force.
  ///
  /// Real-time safe: no allocation, lock or exception. Thread-safe. Cost: 20 to 40 ns; with wider
  /// neighbourhoods about 4 n^2 ns.
  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s) const noexcept;

 private:
  /// Whether a stylus with this wall force is above every point of the field.
  [[nodiscard]] bool is_out_of_reach(double wall_n) const noexcept;

  FieldView field_;
  Patches patches_;
  double stiffness_n_per_mm_;
  double damping_n_s_per_mm_;
  double reference_height_;  ///< G_ref - 128
  double touchdown_ramp_n_;
  double max_force_n_;
  Gains gains_;
};

}  // namespace touchtrial::engine
