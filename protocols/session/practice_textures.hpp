/// \file What is felt in practice: textures that are not in the study.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial {

/// Of one participant. The models refer to fields that must outlive this.
struct PracticeTextures {
  std::vector<std::string> labels;            ///< by position
  std::vector<const RenderingModel*> models;  ///< by position
  PlaneGeometry plane;
  /// Positions to present in a round, from 1; the same whenever it is asked.
  std::function<std::vector<int>(int round)> order;
};

}  // namespace touchtrial
