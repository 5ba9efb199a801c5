/// \file Fields of the practice textures, which are not stimuli of the study. They have the size of
/// the study's plane, so that the first trial feels familiar.
#pragma once

#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"
#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::study {

/// The centre of a practice picture, with the size of the plane.
/// \throws std::invalid_argument if the picture has fewer pixels than the plane
[[nodiscard]] GreyImage middle_of(const GreyImage& picture, const PlaneGeometry& plane);

/// Gains of the practice textures. If the stiffness budget sets the gains, each texture gets the
/// lower of the study's weakest gains and its own gains within the budget. Equalised textures get
/// their own gains, and explicit gains apply unchanged.
/// \param fields  practice fields
/// \param study_gains  gains of the study's fields
[[nodiscard]] std::vector<engine::Gains> practice_gains(std::span<const engine::FieldView> fields,
                                                        std::span<const engine::Gains> study_gains,
                                                        const engine::RenderingOptions& rendering);

/// The minimum of each gain.
[[nodiscard]] engine::Gains weakest_of(std::span<const engine::Gains> gains);

}  // namespace touchtrial::study
