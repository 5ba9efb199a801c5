/// \file How much energy a hand could gain from a study's textures, under either rendering model.
#pragma once

#include "engine/rendering/rendering_options.hpp"
#include "protocols/design/study.hpp"

#include <vector>

namespace touchtrial::design {

/// Magnitudes of the work along closed loops of one kind, mJ. Without friction, a loop that absorbs
/// energy in one direction releases it in the other, so the magnitude is what a hand could gain.
struct LoopWork {
  double median_mj = 0.0;
  double worst_mj = 0.0;
};

/// Loop work of one model on all stimuli of a study.
struct ModelLoopWork {
  engine::ModelKind model = engine::ModelKind::paper;
  LoopWork planar;             ///< circles at the depth of the stated load on a flat wall
  LoopWork press_slide_lift;   ///< down to that depth, straight across, up, back through the air
  int loops_of_each_kind = 0;  ///< over all stimuli
};

/// Builds the presented stimuli in memory under each model, with the gains that the study's budget
/// allows (without friction and explicit gains), and follows the same random loops of 1 to 10 mm on
/// each. The same study always gives the same numbers.
/// \throws StudyError if an image is missing
/// \throws FileError if an image cannot be read
[[nodiscard]] std::vector<ModelLoopWork> loop_work_of(const Study& study);

}  // namespace touchtrial::design
