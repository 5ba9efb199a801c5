/// \file The work that a plane does on a hand led round a closed path. A model that does such work
/// can give a hand energy without end. Source: docs/method.md, "Work round closed loops".
#pragma once

#include "engine/rendering/rendering_model.hpp"

#include <span>
#include <vector>

namespace touchtrial::reference {

/// A circle at a constant height, as a polygon.
/// \param centre_mm  its z is the height
/// \param corners  >= 3
[[nodiscard]] std::vector<Vec3> circle_path(Vec3 centre_mm, double radius_mm, int corners = 360);

/// Presses down at one point, slides straight to another at that depth, lifts, and returns in the
/// air.
/// \param top_mm,bottom_mm  heights (z) of the return and of the slide
[[nodiscard]] std::vector<Vec3> press_slide_lift_path(Vec2 from_mm, Vec2 to_mm, double top_mm,
                                                      double bottom_mm);

/// Work of the model's force along the closed path through these corners and back to the first, in
/// mJ (N mm); above 0, the hand gains energy. At velocity zero, from the start of a presentation.
/// Simpson's rule: the error shrinks with the fourth power of step_mm where the force is smooth,
/// and with the second at a landing, where the force has a kink: some 1e-6 mJ by default.
/// Thread-safe. Cost: two force evaluations a step.
/// \param step_mm  longest step, > 0
[[nodiscard]] double loop_work_mj(const engine::RenderingModel& model,
                                  std::span<const Vec3> corners_mm, double step_mm = 0.005);

}  // namespace touchtrial::reference
