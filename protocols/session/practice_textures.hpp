/// \file What is felt in practice: textures that are not in the study.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::session {

struct PracticeRound {
  std::vector<std::string> labels;                    ///< by position
  std::vector<const engine::RenderingModel*> models;  ///< by position
  std::vector<int> order;                             ///< positions to present, one after the other
};

/// Of one participant. The models refer to fields that must outlive this.
struct PracticeTextures {
  PlaneGeometry plane;
  /// From 1; the same whenever it is asked.
  std::function<PracticeRound(int round)> round;
};

}  // namespace touchtrial::session
