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

/// The centre of a practice picture, from which its field is made.
/// \throws std::invalid_argument if the picture has fewer pixels than the plane
[[nodiscard]] GreyImage middle_of(const GreyImage& picture, const PlaneGeometry& plane);

/// Gains of the practice textures. If the stiffness budget sets the gains, each texture gets the
/// lower of the study's weakest gains and its own gains within the budget. Equalised textures
/// always get the latter; explicit gains apply unchanged.
/// \param fields  of practice
/// \param of_study  gains of the study's own fields
[[nodiscard]] std::vector<engine::Gains> practice_gains(std::span<const engine::FieldView> fields,
                                                        std::span<const engine::Gains> of_study,
                                                        const engine::RenderingOptions& rendering);

/// The minimum of each gain.
[[nodiscard]] engine::Gains weakest_of(std::span<const engine::Gains> gains);

}  // namespace touchtrial::study
