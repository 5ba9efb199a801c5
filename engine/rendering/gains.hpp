/// \file Gains for all stimuli of a study together, as strong as the stiffness budget allows.
/// Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// The gains of a study's fields.
struct StudyGains {
  std::vector<Gains> of_field;  ///< in the order of the fields; all equal unless equalised
  bool over_budget = false;     ///< explicit gains exceed the budget: worth a warning
};

/// Model `paper`: without explicit gains, k_t and c are the largest for which the 99th percentile,
/// pooled over the interior pixels of all fields, of the in-plane Jacobian's Frobenius norm (and of
/// the surface gradient's norm) stays within the budget, in N/mm. Interior pixels have all four
/// neighbours; derivatives are central differences over the pitch; percentiles interpolate
/// linearly. Where more than 99 % of the pool is flat, its maximum replaces the percentile. With a
/// touchdown ramp the lateral force's Jacobian is that along the plane and in depth, at the load at
/// which it is largest, so that k_t is smaller.
///
/// With Equalise::rms the gain of each field is divided by the field's own rms (of |F_T| for k_t,
/// of G - 128 for c) before pooling, so that all stimuli get the same rms force.
///
/// Explicit gains are used as they are, even above the budget. With Equalise::rms they set the mean
/// of the fields' rms forces, and equalising keeps that mean.
///
/// Model `surface`: likewise, alpha is the largest for which the 99th percentile of the in-plane
/// Jacobian's norm, and that of the normal force's gradient, stay within the budget. The Jacobian
/// comes from central differences, over the pitch, of the model's lateral force at the height at
/// which the pixel in the middle meets a load of kStatedLoadN; the gradient from those of
/// k * alpha * h, which holds at any load that keeps contact. Equalising makes the rms lateral
/// force at that load the same.
///
/// Flat fields do not count. Equalised, they get gain 0; so do all fields if all are flat.
/// Thread-safe. Memory: eight bytes a pixel of all fields together (`surface`: four), and the
/// samples of one field for each core.
/// \throws std::invalid_argument if there is no field, a field has samples that are not finite, the
///   budget is not a finite number > 0, an explicit gain is not a finite number >= 0, or a field is
///   of another model than the options'
[[nodiscard]] StudyGains choose_gains(std::span<const FieldView> fields,
                                      const RenderingOptions& options);

}  // namespace touchtrial::engine
