/// \file The work that a plane does on a hand which is led round a closed path. A model that does
/// work can give a hand energy, for ever. Source: docs/method.md, "Work round closed loops".
#pragma once

#include "engine/rendering/rendering_model.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// A circle in a plane of constant height, as a polygon.
/// \param centre_mm  its z is the height
/// \param corners  >= 3
[[nodiscard]] std::vector<Vec3> circle_path(Vec3 centre_mm, double radius_mm, int corners = 360);

/// Presses down at one point, slides straight to another at that depth, lifts, and goes back in the
/// air. \param top_mm,bottom_mm  heights (z) of the way in the air and of the slide
[[nodiscard]] std::vector<Vec3> press_slide_lift_path(Vec2 from_mm, Vec2 to_mm, double top_mm,
                                                      double bottom_mm);

/// Work of the model's force along the closed path through these corners and back to the first, in
/// mJ (N mm); above 0, the hand gains energy. Without velocity, from a new presentation on.
/// Simpson's rule: the error goes with step_mm to the fourth power where the force is smooth, and
/// to the second at a landing, where it has a kink: some 1e-6 mJ by default. \param step_mm longest
/// step, > 0 Thread-safe. Cost: two force evaluations a step.
[[nodiscard]] double loop_work_mj(const RenderingModel& model, std::span<const Vec3> corners_mm,
                                  double step_mm = 0.005);

}  // namespace touchtrial::engine
