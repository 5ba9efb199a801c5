/// \file The potential whose gradient the rendering model `surface` gives, by its definition.
#pragma once

#include "core/vec.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::reference {

/// U = k/2 * max(0, e)^2 with e = depth + alpha * h, in mJ (N mm): what pressing to this point has
/// stored. h fades to 0 over the rim beyond the plane's edges. \param alpha_mm  per grey level
[[nodiscard]] double surface_potential_mj(engine::FieldView field, double stiffness_n_per_mm,
                                          double alpha_mm, Vec3 position_mm);

}  // namespace touchtrial::reference
