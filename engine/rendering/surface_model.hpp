/// \file Rendering model `surface`: the gradient of a potential, so that closed paths gain no
/// energy, plus friction. Source: docs/method.md, "Rendering".
#pragma once

#include "core/vec.hpp"
#include "engine/rendering/patch.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::engine {

/// The bristle model of friction: a spring from the stylus to an anchor on the plane, which slips
/// beyond a maximum force. Stores the friction state of one presentation. Forces depend on the
/// path, not on speed. Passive: it stores energy from the hand, and slipping dissipates it.
class Bristle {
 public:
  /// The friction on a stylus that has moved to a point of the plane. The first point after a
  /// release is the new anchor. No allocation, lock or exception.
  /// \param position_mm  finite
  /// \param limit_n  mu * F_N, >= 0: the bristle slips at this force
  /// \param stiffness_n_per_mm  of the bristle, > 0
  /// \return force with norm <= limit_n, within rounding
  [[nodiscard]] Vec2 friction_n(Vec2 position_mm, double limit_n,
                                double stiffness_n_per_mm) noexcept {
    if (!is_anchored_) anchor_mm_ = position_mm;
    is_anchored_ = true;
    Vec2 stretch_mm = position_mm - anchor_mm_;
    const double spring_n = stiffness_n_per_mm * norm(stretch_mm);
    if (spring_n > limit_n) {
      stretch_mm = (limit_n / spring_n) * stretch_mm;
      anchor_mm_ = position_mm - stretch_mm;
    }
    return -stiffness_n_per_mm * stretch_mm;
  }

  /// Call when the stylus leaves the plane.
  void release() noexcept { is_anchored_ = false; }

 private:
  Vec2 anchor_mm_;
  bool is_anchored_ = false;
};

/// Width of the rim around the plane in which the texture fades into the flat wall, mm. A step
/// there would cause an infinite force and feed energy to a hand that crosses it repeatedly.
inline constexpr double kRimMm = 2.0;

/// The force on the stylus from one texture, in the frame of PaperModel: z out of the plane towards
/// the hand, depth = -z.
class SurfaceModel {
 public:
  /// Reads no coefficients.
  /// \param field  its heights must outlive the model
  /// \param options,gains  finite, in the ranges of their types
  /// \throws Error if Highway's library cannot be loaded
  SurfaceModel(FieldView field, const RenderingOptions& options, Gains gains);

  /// With e = depth + alpha * h(x, y), the potential is U = k/2 * max(0, e)^2. Contact lasts while
  /// e > 0; then the force is -grad U: k * e normal to the plane and -k * e * alpha * grad h along
  /// it. h is the spline through the field; beyond the edges it is mirrored and fades to the flat
  /// wall over kRimMm. Damping subtracts damping * v_z from the normal force, but never below 0, so
  /// it only dissipates energy. With friction > 0 the bristle adds up to friction * F_N against the
  /// stroke, with a stiffness (Frobenius norm) equal to the stiffness budget. The norm of the total
  /// is limited to max_force_n; its direction is kept.
  ///
  /// Without contact the force is zero and the bristle is released. The field is not read above its
  /// highest point. A position or velocity that is not finite means no contact.
  ///
  /// Real-time safe: no allocation, lock or exception. Thread-safe with one bristle per thread.
  /// Cost: less than twice the cost of PaperModel.
  /// \param bristle  of this presentation; unused without friction
  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s,
                             Bristle& bristle) const noexcept;

 private:
  /// alpha * h and its gradient at a point of the plane.
  struct Relief {
    double height_mm = 0.0;
    Vec2 slope;
  };
  [[nodiscard]] Relief relief_at(double x_mm, double y_mm) const noexcept;
  /// The same for points without a patch, near and beyond the edges.
  [[nodiscard]] Relief relief_at_edge(double x_mm, double y_mm) const noexcept;

  FieldView field_;
  double stiffness_n_per_mm_;
  double damping_n_s_per_mm_;
  double friction_;
  double bristle_n_per_mm_;
  double max_force_n_;
  double mm_per_grey_;
  double slope_per_grey_;  ///< mm_per_grey_ / pitch
  Patches patches_;        ///< of the coefficients
  double reach_mm_;        ///< no force at or beyond this height above the plane
};

}  // namespace touchtrial::engine
