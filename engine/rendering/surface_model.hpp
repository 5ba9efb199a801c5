/// \file Rendering model `surface`: the gradient of one potential, so that no path gains energy.
/// Source: docs/method.md, "Rendering".
#pragma once

#include "core/vec.hpp"
#include "engine/rendering/bristle.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::engine {

/// Width of the rim beyond the plane's edge in which the texture fades into the flat wall, mm. A
/// step there would be an infinite force, and energy for whoever crosses it to and fro.
inline constexpr double kRimMm = 2.0;

/// The force on the stylus from one texture, in the frame of PaperModel: z out of the plane towards
/// the hand, depth = -z.
class SurfaceModel {
 public:
  /// Reads no coefficient.
  /// \param field  its coefficients must outlive the model; height_px * width_px of them
  /// \param options,gains  finite, in the ranges of their types
  SurfaceModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept;

  /// With e = depth + alpha * h(x, y), U = k/2 * max(0, e)^2. Contact while e > 0; then the force
  /// is -grad U: k * e across the plane and -k * e * alpha * grad h along it. h is the spline
  /// through the field; beyond the edges it is mirrored and fades to 0 over kRimMm, where the flat
  /// wall begins. Damping takes damping * v_z from the normal force, down to nothing: it only loses
  /// energy. With friction > 0 the bristle adds up to friction * F_N against the stroke, with a
  /// stiffness (as Frobenius norm) of the whole stiffness budget. The total is limited in norm to
  /// max_force_n, direction kept.
  /// No contact: zero force, a released bristle; and the field is not read where no surface could
  /// reach the hand. A position or velocity that is not finite is no contact. No allocation, lock
  /// or exception; any number of threads, each with its own bristle. Cost: under twice
  /// PaperModel's. \param bristle  of this presentation; not used without friction
  [[nodiscard]] Vec3 force_n(Vec3 position_mm, Vec3 velocity_mm_s, Bristle& bristle) const noexcept;

 private:
  /// alpha * h and its gradient at a point of the plane.
  struct Relief {
    double height_mm = 0.0;
    Vec2 slope;
  };
  [[nodiscard]] Relief relief_at(double x_mm, double y_mm) const noexcept;
  [[nodiscard]] Vec3 contact_force_n(Vec3 position_mm, Vec3 velocity_mm_s,
                                     Bristle& bristle) const noexcept;

  FieldView field_;
  double stiffness_n_per_mm_;
  double damping_n_s_per_mm_;
  double friction_;
  double bristle_n_per_mm_;
  double max_force_n_;
  double mm_per_grey_;
  double reach_mm_;  ///< nothing is felt at this height above the plane or higher
};

}  // namespace touchtrial::engine
