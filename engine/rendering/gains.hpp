/// \file One set of gains for all stimuli of a study, as strong as the stiffness budget allows.
/// Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// The gains of every field, in the order given.
struct StudyGains {
  std::vector<Gains> of_field;  ///< all equal unless the stimuli are equalised
  bool over_budget = false;     ///< explicit gains exceed the budget: worth a warning
};

/// Model `paper`. Without explicit gains, k_t and c are the largest for which the 99th percentile,
/// pooled over the interior pixels of all fields, of the in-plane Jacobian's Frobenius norm (and of
/// the surface gradient's norm) stays within the budget, in N/mm. Interior pixels have all four
/// neighbours; derivatives are central differences over the pitch; percentiles interpolate
/// linearly. Should more than 99 % of the pool be flat, its maximum takes the percentile's place.
///
/// With Equalise::rms the gain of each field is divided by the field's own rms (of |F_T| for k_t,
/// of G - 128 for c) before pooling, so that all stimuli get the same rms force.
///
/// Explicit gains are taken as they are; with Equalise::rms they set the mean over the fields of
/// the rms force, which equalising then leaves as it was. They are never cut to the budget.
///
/// Model `surface`. Likewise, alpha is the largest for which the 99th percentile of the in-plane
/// Jacobian's norm, and that of the normal force's gradient, stay within the budget. The first is
/// of central differences, over the pitch, of the model's lateral force at the height at which the
/// pixel in the middle meets a load of kStatedLoadN; the second of those of k * alpha * h, the same
/// at any load that keeps contact. Equalised is the rms lateral force at that load.
///
/// Flat fields do not count; equalised they get gain 0, as all do if all are flat.
/// \throws std::invalid_argument if there is no field, a field has samples that are not finite, or
///   the budget is not a finite number > 0, an explicit gain is not one >= 0, or a field is of
///   another model than the options'
/// Thread-safe. Memory: four bytes a pixel of all fields together.
[[nodiscard]] StudyGains choose_gains(std::span<const FieldView> fields,
                                      const RenderingOptions& options);

}  // namespace touchtrial::engine
