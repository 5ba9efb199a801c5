/// \file A field of a pack as a picture.
#pragma once

#include "core/plane.hpp"
#include "engine/rendering/texture_field.hpp"

namespace touchtrial::analysis {

/// The field's surface at the centres of its pixels, mid-grey at its mean, black and white at 2.5
/// standard deviations: what is felt as higher is lighter. All mid-grey if the field is flat.
/// \return empty if the field is
[[nodiscard]] GreyImage field_picture(engine::FieldView field);

}  // namespace touchtrial::analysis
