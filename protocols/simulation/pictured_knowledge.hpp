/// \file What people expect to feel who know a study's pictures and none of its textures.
/// Source: docs/planning.md, "Without training".
#pragma once

#include "engine/perception/felt_features.hpp"
#include "protocols/design/study.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <map>
#include <string>

namespace touchtrial::simulation {

/// What each class's picture shows (engine::features_of_picture), by label.
using PicturedFeatures = std::map<std::string, engine::FeltFeatures>;

/// Reads the picture of each class that the answer screen shows: its first image.
/// \throws FileError if a picture cannot be read
[[nodiscard]] PicturedFeatures look_at_pictures(const design::Study& study);

/// Puts what is expected in place of what each stimulus feels like on average. Each feature of the
/// pictures is brought to the mean and standard deviation that it has over all felt stimuli, which
/// people get used to without knowing which is which. The deviations from pass to pass stay: they
/// tell how reliable a feature is.
/// \throws std::invalid_argument if a class has no picture
[[nodiscard]] FeltKnowledge expected_from_pictures(const FeltKnowledge& felt,
                                                   const PicturedFeatures& pictures);

}  // namespace touchtrial::simulation
