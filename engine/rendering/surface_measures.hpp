/// \file Strength and steepness of a spline surface: what gains and figures of the model `surface`
/// are computed from. Private to engine/rendering. Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <vector>

namespace touchtrial::engine {

/// The spline of a field at its pixel centres, in the samples of a field: `surface` is the height h
/// in grey levels (without 128), the force minus the gradient of h, grey levels per pixel.
/// Cost: some 5 ns a pixel.
[[nodiscard]] TextureField relief_of(FieldView field);

/// Root mean square of h over all pixels of a relief, grey levels.
[[nodiscard]] double height_rms(FieldView relief) noexcept;

/// Appends, for every interior pixel of a relief, the Frobenius norm of the in-plane Jacobian, in
/// N/mm: central differences over the pitch of the model's lateral force, at the height above the
/// plane at which the pixel in the middle meets a load of kStatedLoadN.
/// \param mm_per_grey  alpha
/// \param wall_n_per_mm  k; 0 leaves what is linear in alpha
void append_stiffness_at_load(FieldView relief, double mm_per_grey, double wall_n_per_mm,
                              std::vector<float>& pool);

}  // namespace touchtrial::engine
