/// \file The tangential force by Eqs. 10-12 as they are printed: a magnitude and a direction for
/// each pair of pixels.
#pragma once

#include "core/plane.hpp"
#include "engine/force_field.hpp"

namespace touchtrial::reference {

[[nodiscard]] engine::ForceField<double> tangential_force(const Plane<double>& surface,
                                                          int neighbourhood);

}  // namespace touchtrial::reference
