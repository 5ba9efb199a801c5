/// \file The gain of the model `surface`. Private to engine/rendering; see gains.hpp.
#pragma once

#include "engine/rendering/gains.hpp"

namespace touchtrial::engine {

/// choose_gains for fields that are all splines. Fields are sampled anew for each try of alpha,
/// which costs time in place of memory: about six tries.
/// \throws std::invalid_argument if a field has coefficients that are not finite
[[nodiscard]] StudyGains choose_surface_gains(std::span<const FieldView> fields,
                                              const RenderingOptions& options);

}  // namespace touchtrial::engine
