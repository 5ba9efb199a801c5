/// \file Strength, steepness and spectrum of a field before gains: the models compute gains and
/// statistics from them. Private to engine/rendering. Source: docs/method.md, "Rendering".
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

/// Root mean square of the surface itself, without subtracting 128, over all pixels, grey levels.
[[nodiscard]] double height_rms(FieldView relief) noexcept;

/// Appends, for every interior pixel, scale * Frobenius norm of the in-plane Jacobian of F_T, by
/// central differences over the pitch: grey levels per pixel per mm. A field with a side below 3
/// has no interior. Single precision halves the memory and costs 6e-8 of the budget.
void append_tangential_stiffness(FieldView field, double scale, std::vector<float>& pool);

/// The same with the norm of the surface's gradient: grey levels per mm.
void append_normal_stiffness(FieldView field, double scale, std::vector<float>& pool);

/// Factors that equalise fields: with Equalise::rms, 1 / rms, and 0 for a flat field; else 1 each.
/// \param rms  the rms of each field; 0 means that the field is flat
/// \throws std::invalid_argument if an rms is not finite
[[nodiscard]] std::vector<double> equalising_factors(std::span<const double> rms,
                                                     Equalise equalise);

/// The factor by which an explicit gain multiplies equalising_factors: with Equalise::rms it keeps
/// the mean rms of the fields that are not flat.
[[nodiscard]] double explicit_factor(double gain, std::span<const double> rms, Equalise equalise);

/// The 99th percentile of a pool of stiffnesses, or its maximum where the percentile is below a
/// thousandth of that: then most of the pool is flat, or contains the traces that a filter or a
/// spline leaves far from any texture, and the percentile would limit nothing. Reorders the pool.
[[nodiscard]] double typical_stiffness(std::vector<float>& pool);

/// Percentile by linear interpolation between order statistics (NumPy's default); 0 if the pool is
/// empty. Reorders the pool.
/// \param share  0 .. 1
[[nodiscard]] double percentile(std::vector<float>& pool, double share);

/// For each limit, the share of the power of a vector field (both components, means removed) at
/// radial spatial frequencies above it; 0 for a constant field. The spectrum is that of the plane
/// repeated periodically. Thread-safe. Cost: two real Fourier transforms.
/// \param x,y  the components, of one shape, at least 1 x 1
/// \param limits_cycles_per_px  a frequency within rounding of a limit is not above it
[[nodiscard]] std::vector<double> power_shares_above(const Plane<double>& x, const Plane<double>& y,
                                                     std::span<const double> limits_cycles_per_px);

}  // namespace touchtrial::engine
