/// \file The lateral force of a field at its pixel centres, whatever model it is for.
#pragma once

#include "engine/force_field.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::engine {

/// Before the norm limit.
struct LateralField {
  ForceField<double> force;  ///< grey levels per pixel, from bright to dark
  double n_per_grey = 0.0;   ///< newtons of one grey level per pixel
};

/// For `paper` the field's own planes; for `surface` minus the gradient of its spline, in newtons
/// at a load of kStatedLoadN.
/// \throws std::invalid_argument if the field is empty
/// Thread-safe.
[[nodiscard]] LateralField lateral_field(FieldView field, Gains gains);

}  // namespace touchtrial::engine
