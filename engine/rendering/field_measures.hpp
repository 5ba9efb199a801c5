/// \file Strength and steepness of a field before gains: what gains and figures are computed from.
/// Private to engine/rendering. Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// Root mean square of |F_T| over all pixels, grey levels per pixel. Exactly 0 only if every force
/// is zero; not finite if a sample is not.
[[nodiscard]] double tangential_rms(FieldView field) noexcept;

/// Root mean square of G - 128 over all pixels, grey levels.
[[nodiscard]] double normal_rms(FieldView field) noexcept;

/// Appends, for every interior pixel, scale * Frobenius norm of the in-plane Jacobian of F_T, by
/// central differences over the pitch: grey levels per pixel per mm. A field with a side below 3
/// has no interior. Single precision halves the pool and costs 6e-8 of the budget.
void append_tangential_stiffness(FieldView field, double scale, std::vector<float>& pool);

/// The same with the norm of the surface's gradient: grey levels per mm.
void append_normal_stiffness(FieldView field, double scale, std::vector<float>& pool);

/// Mean of the values that are not 0; 0 if there is none.
[[nodiscard]] double mean_of_nonzero(std::span<const double> values);

/// The 99th percentile, by which stiffness is judged. Where more than 99 % of the pool is flat, or
/// holds what a filter or a spline leaves far from any texture (under a thousandth of the maximum),
/// it would bound nothing, and the maximum takes its place. Reorders the pool.
[[nodiscard]] double typical_stiffness(std::vector<float>& pool);

/// Percentile by linear interpolation between order statistics (NumPy's default); 0 if the pool is
/// empty. Reorders the pool. \param share  0 .. 1
[[nodiscard]] double percentile(std::vector<float>& pool, double share);

}  // namespace touchtrial::engine
