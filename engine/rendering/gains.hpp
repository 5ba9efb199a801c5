/// \file Chooses gains for all stimuli of a study, as strong as the stiffness budget allows.
/// Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// The gains of a study's fields.
struct StudyGains {
  std::vector<Gains> per_field;  ///< one per field; all equal unless equalised
  bool over_budget = false;      ///< explicit gains exceed the budget
};

/// Model `paper`: without explicit gains, k_t (and c) are the largest gains for which the 99th
/// percentile of the in-plane Jacobian's Frobenius norm (and of the surface gradient's norm) stays
/// within the budget, in N/mm. The percentile is over the interior pixels of all fields and
/// interpolates linearly; if more than 99 % of them are flat, the maximum replaces it. Interior
/// pixels have four neighbours; derivatives are central differences over the pitch. With a
/// touchdown ramp the lateral force's Jacobian includes depth, at the load where it is largest, so
/// k_t is smaller.
///
/// With Equalise::rms the gain of each field is divided by its rms (of |F_T| for k_t, of G - 128
/// for c) before pooling, so that all stimuli have the same rms force.
///
/// Explicit gains are used unchanged, even above the budget. With Equalise::rms they determine the
/// mean of the fields' rms forces, which equalising keeps.
///
/// Model `surface`: likewise, alpha is the largest gain for which the 99th percentiles of the
/// in-plane Jacobian's norm and of the normal force's gradient stay within the budget. The Jacobian
/// is computed by central differences of the lateral force, at the height where the central pixel
/// has a load of kReferenceLoadN; the gradient by central differences of k * alpha * h, at any load
/// with contact. Equalising gives all stimuli the same rms lateral force at that load.
///
/// Flat fields are ignored. Equalised, they get gain 0, as do all fields if all are flat.
/// Thread-safe. Memory: eight bytes per pixel of all fields (`surface`: four), and the samples of
/// one field per core.
/// \throws std::invalid_argument if there is no field, a field has non-finite samples or another
///   model than `options`, the budget is not a finite number > 0, or an explicit gain is negative
///   or not finite
[[nodiscard]] StudyGains choose_gains(std::span<const FieldView> fields,
                                      const RenderingOptions& options);

}  // namespace touchtrial::engine
